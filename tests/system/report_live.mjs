// A report while its run runs (--view): the page grows, and says when the program has ended. live_view_test.cpp has that
// the results are the same without it, tests/unit/bench/live_server_test.cpp who is answered and who is not.
// Usage: node report_live.mjs VOBENCH MODULES [RATE]     RATE of the frames of one second in Hz: enough to see it grow
// Exit:  0 all good, 1 something is not, 77 no Chromium here.
import assert from "node:assert/strict";
import { spawn } from "node:child_process";
import { once } from "node:events";
import { join } from "node:path";

import { here, program, scenes, withBrowser } from "./browser.mjs";

await withBrowser(async (browser) => {
  const rate = process.argv[4] ?? 2400;
  const words = [
    "run",
    join(scenes, "tiny.yaml"),
    "--system",
    "rb2pf,rbpf",
    "--set",
    `time.rate=${rate} Hz`,
    "--set",
    "sensor.exposure=0.2 ms",
  ];
  const running = spawn(program, [...words, "-o", "viewed", "--view"], {
    cwd: here,
    stdio: ["ignore", "ignore", "pipe"],
  });
  const ended = once(running, "exit");
  let said = "";
  running.stderr.setEncoding("utf8");
  running.stderr.on("data", (text) => (said += text));
  while (!/View: \S+\/\n/.test(said)) {
    assert.equal(running.exitCode, null, said);
    await new Promise((done) => setTimeout(done, 20));
  }
  const address = said.match(/View: (\S+)/)[1];
  assert.equal((await fetch(address.replace(/.{3}\/$/, "000/"))).status, 404);
  assert.equal((await fetch(address, { method: "POST", body: "x" })).status, 405);

  const context = await browser.newContext({ viewport: { width: 1280, height: 900 } });
  const page = await context.newPage();
  const complaints = [];
  page.on("pageerror", (error) => complaints.push(String(error)));
  await page.goto(address);
  const seen = () =>
    page
      .evaluate(() => {
        window.vobench?.drawAll(); // those below the screen, too
        const id = window.vobench?.figures.find((figure) => figure.title === "Position error")?.id;
        const drawn = document.querySelector(`#${id} .frame svg svg path`)?.getAttribute("d") ?? "";
        return [drawn.match(/[ML]/g)?.length ?? 0, document.querySelector("#frames img")?.alt];
      })
      .catch(() => []); // while it loads anew
  const counts = new Set(),
    pictures = new Set();
  while (running.exitCode === null) {
    const [count, picture] = await seen();
    if (count) counts.add(count);
    if (picture) pictures.add(picture);
    await new Promise((done) => setTimeout(done, 200));
  }
  const [status] = await ended;
  assert.equal(status, 0, said);
  assert.ok(pictures.size >= 2, `the page had the pictures ${[...pictures]}`);
  assert.match([...pictures].at(-1), /Frame at [\d.]+ s, picture, with features of RB.-PF: [1-9]\d* matched/);
  assert.equal(await page.locator("#frames input[type=range]").isVisible(), false); // of one frame
  assert.ok(counts.size >= 2, `the page had ${[...counts]} points`);
  await page.locator("#live", { hasText: "The program has ended" }).waitFor({ timeout: 20_000 });
  assert.deepEqual(complaints, []);
  await context.close();

  console.log(`saw ${counts.size} states`);
});
