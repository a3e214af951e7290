// Report in a real browser: every figure has its data; reading, zooming, hiding, saving, sorting and copying work;
// no network access; accessibility (axe); at 1280 and 400 pixels, in light and dark, in print and without scripts.
// Usage: node report_page.mjs VOBENCH MODULES [SHOTS]     MODULES has node_modules; SHOTS is a folder for pictures
// Exit:  0 for success, 1 for a failure, 77 without Chromium.
import assert from "node:assert/strict";
import { execFileSync } from "node:child_process";
import { readFileSync, statSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { pathToFileURL } from "node:url";

import { axe, here, program, scenes, withBrowser } from "./browser.mjs";

const shots = process.argv[4];

function makePages() {
  const run = (...words) => execFileSync(program, words, { cwd: here, stdio: ["ignore", "ignore", "inherit"] });
  run("run", join(scenes, "tiny.yaml"), "-o", "images", "--runs", "2", "--system", "rb2pf,rbpf");
  run("run", join(scenes, "points.yaml"), "-o", "points", "--runs", "10", "--verdict", "--set", "time.duration=1 s");
  writeFileSync(
    join(here, "noise.yaml"),
    `scenarios: [{file: ${join(scenes, "points.yaml")}, set: {time.duration: 1 s}}]
vary: [{name: noise, key: world.points.measurement.noise, values: [0.5 px, 2 px, 8 px]}]
systems: [rb2pf, rbpf]
seeds: 1..3
curves: [{along: noise, of: [ate_m, nees_pose_per_dof], break_at: {error: 2 cm}}]
`,
  );
  run("campaign", "noise.yaml", "-o", "campaign");
  return ["images", "points", "campaign"].map((name) => ({ name, file: join(here, name, "report.html") }));
}

// Opens a page and draws all its figures; collects its errors, warnings and network requests.
async function open(browser, file, options) {
  const context = await browser.newContext({
    viewport: { width: options.width, height: 900 },
    hasTouch: options.width < 1000,
    colorScheme: options.scheme ?? "light",
    javaScriptEnabled: options.scripts ?? true,
  });
  const page = await context.newPage();
  const complaints = [];
  page.on("console", (message) => ["error", "warning"].includes(message.type()) && complaints.push(message.text()));
  page.on("pageerror", (error) => complaints.push(String(error)));
  page.on(
    "request",
    (request) => /^(file|data|blob):/.test(request.url()) || complaints.push(`asks for ${request.url()}`),
  );
  await page.goto(pathToFileURL(file).href);
  if (options.scripts ?? true) {
    await page.evaluate(() => window.vobench.drawAll());
    await page.waitForTimeout(300);
  }
  return { context, page, complaints };
}

// Every figure has all its numbers in its drawing, marks on its axes, and texts that are neither cut nor overlapping.
async function checkFigures(page, name) {
  const figures = await page.evaluate(() =>
    window.vobench.figures.map((figure) => {
      const frame = document.querySelector(`#${figure.id} .frame`);
      const svg = frame?.querySelector("svg");
      if (!svg) return { title: figure.title, drawn: false };
      const drawable = (y) => !Number.isNaN(y) && !(figure.y.logarithmic && y <= 0);
      const finite = (series) =>
        series.x.filter((x, i) => Number.isFinite(x) && drawable(series.y[i]) && drawable(series.high?.[i] ?? 1))
          .length;
      const marksAt = { line: /[ML]/g, dots: /M/g, band: /[ML]/g, bars: /Z/g, interval: /M/g };
      const groups = [...svg.querySelectorAll("svg > g")].map((group) => ({
        draw: group.getAttribute("class"),
        marks: group.querySelector("path").getAttribute("d").match(marksAt[group.getAttribute("class")])?.length ?? 0,
        bad: /NaN|Infinity/.test(group.innerHTML),
      }));
      const texts = [...svg.querySelectorAll("text")];
      const all = svg.getBoundingClientRect();
      const boxes = texts.map((text) => text.getBoundingClientRect());
      const cut = ({ left, right, top, bottom }) =>
        left < all.left || right > all.right || top < all.top || bottom > all.bottom;
      const meet = (a, b) => a !== b && a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
      return {
        title: figure.title,
        drawn: true,
        space: figure.kind === "space",
        wanted: figure.series.map((series) => ({
          draw: series.draw,
          marks: finite(series) * (series.draw === "band" ? 2 : 1),
          bad: false,
        })),
        groups,
        marks: texts.filter((text) => /\d/.test(text.textContent)).length,
        cut: texts.filter((_, i) => cut(boxes[i])).map((text) => text.textContent),
        hit: texts.filter((_, i) => boxes.some((box) => meet(box, boxes[i]))).map((text) => text.textContent),
        label: frame.getAttribute("aria-label"),
        wide: all.width,
      };
    }),
  );
  assert.ok(figures.length >= 3, `${name}: only ${figures.length} figures`);
  for (const figure of figures) {
    assert.ok(figure.drawn, `${name}: ${figure.title} is not drawn`);
    assert.ok(figure.wanted.length > 0, `${name}: ${figure.title} has no series`);
    assert.ok(
      figure.wanted.every((series) => series.marks > 0),
      `${name}: ${figure.title} has an empty series`,
    );
    assert.deepEqual(figure.groups, figure.wanted, `${name}: ${figure.title}`);
    if (!figure.space) assert.ok(figure.marks >= 3, `${name}: ${figure.title} has ${figure.marks} marks`);
    assert.deepEqual(figure.cut, [], `${name}: words are cut in ${figure.title}`);
    assert.deepEqual(figure.hit, [], `${name}: words overlap in ${figure.title}`);
    assert.ok(figure.label.includes(figure.title), `${name}: ${figure.title} has no name`);
    assert.ok(figure.wide > 200, `${name}: ${figure.title} is ${figure.wide} px wide`);
  }
  return figures.length;
}

const fits = (page) => page.evaluate(() => document.documentElement.scrollWidth <= window.innerWidth);
const idOf = (page, title) =>
  page.evaluate((t) => window.vobench.figures.find((figure) => figure.title === t).id, title);
const rangesOf = async (page, title) =>
  page.evaluate((id) => window.vobench.charts.get(id).ranges(), await idOf(page, title));
// The numbers written at the axes, and how the last series is drawn.
const numbersOf = async (page, title) => page.locator(`#${await idOf(page, title)} .frame text`).allTextContents();
const lastPath = async (page, title) => {
  const paths = page.locator(`#${await idOf(page, title)} .frame svg svg path`);
  return paths.last().getAttribute("d");
};

async function checkReadingAndZoom(page) {
  const frame = page.locator(`#${await idOf(page, "Position error")} .frame`);
  await frame.scrollIntoViewIfNeeded();
  const box = await frame.boundingBox();
  // The last point, read at the right end of the frame.
  await page.mouse.move(box.x + box.width - 13, box.y + 60);
  const said = await frame.locator(".readout").innerText();
  const last = await page.evaluate(() => {
    const figure = window.vobench.figures.find((f) => f.title === "Position error");
    const line = figure.series.find((series) => !series.faint);
    return String(Number(line.y[line.y.length - 1].toPrecision(6)));
  });
  assert.ok(said.includes(last), `read '${said}', expected ${last}`);

  const before = await rangesOf(page, "Position error");
  const numbers = await numbersOf(page, "Position error");
  const other = await rangesOf(page, "NIS of RB-PF");
  const path = await lastPath(page, "NIS of RB-PF");
  await page.mouse.move(box.x + 120, box.y + 50);
  await page.mouse.down();
  await page.mouse.move(box.x + 200, box.y + 150, { steps: 4 });
  await page.mouse.up();
  const zoomed = await rangesOf(page, "Position error");
  const inside = (range, all) => range[0] > all[0] && range[1] < all[1];
  assert.ok(inside(zoomed.x, before.x) && inside(zoomed.y, before.y), "dragging does not zoom");
  assert.notDeepEqual(await numbersOf(page, "Position error"), numbers, "the axes stay as they were");
  const followed = await rangesOf(page, "NIS of RB-PF");
  assert.deepEqual(followed.x, zoomed.x, "time is not zoomed together");
  assert.deepEqual(followed.y, other.y);
  assert.notEqual(await lastPath(page, "NIS of RB-PF"), path, "the other chart is not drawn anew");
  await page.mouse.dblclick(box.x + 150, box.y + 100);
  assert.deepEqual(await rangesOf(page, "Position error"), before, "a double click does not show all");
  assert.deepEqual(await numbersOf(page, "Position error"), numbers);
  assert.deepEqual(await rangesOf(page, "NIS of RB-PF"), other);
  assert.equal(await lastPath(page, "NIS of RB-PF"), path);

  await frame.focus();
  await page.keyboard.press("ArrowRight");
  await page.keyboard.press("ArrowRight");
  assert.match(await page.locator("#status").innerText(), /^time .* s, .*RB²-PF/);
  await page.keyboard.press("+");
  const closer = await rangesOf(page, "Position error");
  assert.ok(inside(closer.x, before.x), "the keyboard does not zoom");
  await page.keyboard.press("0");
  assert.deepEqual(await rangesOf(page, "Position error"), before);
}

async function checkTurning(page) {
  const title = "In space";
  const frame = page.locator(`#${await idOf(page, title)} .frame`);
  await frame.scrollIntoViewIfNeeded();
  const box = await frame.boundingBox();
  const before = await lastPath(page, title);
  await page.mouse.move(box.x + 100, box.y + 100);
  await page.mouse.down();
  await page.mouse.move(box.x + 180, box.y + 130, { steps: 3 });
  await page.mouse.up();
  const turned = await lastPath(page, title);
  assert.notEqual(turned, before, "dragging does not turn");
  await page.mouse.dblclick(box.x + 100, box.y + 100);
  assert.equal(await lastPath(page, title), before);
  await frame.focus();
  await page.keyboard.press("ArrowUp");
  assert.notEqual(await lastPath(page, title), before, "the keyboard does not turn");
  await page.keyboard.press("0");
  assert.equal(await lastPath(page, title), before);
}

async function checkHiding(page) {
  const count = () =>
    page.evaluate(() =>
      [...document.querySelectorAll(".frame > svg")].map((svg) => svg.querySelectorAll("svg > g").length),
    );
  const before = await count();
  const button = page.locator(`#${await idOf(page, "Position error")} .legend button`, { hasText: "RB-PF" });
  await button.click();
  assert.equal(await button.getAttribute("aria-pressed"), "false");
  const hidden = await count();
  assert.ok(hidden.filter((n, i) => n < before[i]).length > 5, "a system is not hidden on the whole page");
  await button.click();
  assert.deepEqual(await count(), before);
}

// A tap shows a reading, which stays until something else is tapped.
async function checkTouch(page) {
  const frame = page.locator(`#${await idOf(page, "Position error")} .frame`);
  await frame.tap({ position: { x: 200, y: 80 } });
  assert.match(await frame.locator(".readout").innerText(), /^time .* s\n.*RB²-PF/);
  await page.locator("h1").tap();
  assert.ok(await frame.locator(".readout").isHidden(), "what was read stays");
}

// A saved drawing is self-contained: well-formed, with colours instead of the page's variables.
async function checkSaving(page) {
  const button = page.getByRole("button", { name: "Save Position error as SVG" });
  const [download] = await Promise.all([page.waitForEvent("download"), button.click()]);
  assert.equal(download.suggestedFilename(), "position_error.svg");
  const text = readFileSync(await download.path(), "utf8");
  const faults = await page.evaluate(
    (svg) => new DOMParser().parseFromString(svg, "image/svg+xml").querySelectorAll("parsererror").length,
    text,
  );
  assert.equal(faults, 0);
  assert.match(text, /^<svg [^>]*width="\d+".*stroke="#0072b2"/s);
  assert.doesNotMatch(text, /var\(/);
}

async function checkTable(page) {
  const table = page.locator(".table", { has: page.locator("th", { hasText: "ATE [cm]" }) }).first();
  const column = async () => (await table.locator("tbody td:nth-child(3)").allInnerTexts()).map(Number);
  const head = table.locator("thead th", { hasText: /^ATE \[cm\]/ }).locator("button");
  await head.click();
  const rising = await column();
  assert.deepEqual(
    rising,
    [...rising].sort((a, b) => a - b),
  );
  await head.click();
  assert.deepEqual(await column(), [...rising].reverse());
  const first = (await table.locator("tbody tr").first().locator("th, td").allInnerTexts()).map((text) => text.trim());
  for (const [format, expected] of [
    ["CSV", first.join(",")],
    ["Markdown", `| ${first.join(" | ")} |`],
    ["LaTeX", first.map((text) => text.replace("²", "\\textsuperscript{2}").replace("–", "--")).join(" & ")],
  ]) {
    await table.getByRole("button", { name: format, exact: true }).click();
    const copied = await page.evaluate(() => navigator.clipboard.readText());
    assert.ok(copied.includes(expected), `${format}: '${copied.slice(0, 300)}' does not have '${expected}'`);
  }
}

async function checkFrames(page) {
  const holder = page.locator("#frames");
  const slider = holder.locator("input[type=range]");
  await slider.focus();
  const source = () => holder.locator("img").getAttribute("src");
  const before = await source();
  await page.keyboard.press("End");
  assert.notEqual(await source(), before, "the slider shows no other frame");
  const shapes = () => holder.locator("svg .matched").count();
  assert.ok((await shapes()) > 3, "no matched feature is drawn");
  assert.ok((await holder.locator("svg .matched ellipse").count()) > 3, "no innovation ellipse is drawn");
  await holder.getByRole("button", { name: "matched", exact: true }).click();
  assert.equal(await shapes(), 0);
  await holder.getByRole("button", { name: "matched", exact: true }).click();
  const picture = await source();
  await holder.getByRole("button", { name: "true depth" }).click();
  assert.notEqual(await source(), picture, "depth is not shown");
  assert.match(await holder.locator("figcaption").innerText(), /Depth from [\d.]+ m/);
  await page.keyboard.press("Home");
  await slider.focus();
  await page.keyboard.press("Home");
  await holder.getByRole("button", { name: "true flow" }).click();
  assert.match(await holder.locator("figcaption").innerText(), /full colour is [\d.]+ px/);
  await holder.getByRole("button", { name: "picture", exact: true }).click();
  const whole = await page.evaluate(() =>
    [...document.querySelectorAll("#frames img")].every((image) => image.complete && image.naturalWidth > 0),
  );
  assert.ok(whole, "a picture cannot be shown");
}

async function checkAccessible(page, name) {
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.addScriptTag({ path: axe });
  const { violations } = await page.evaluate(() => window.axe.run(document, { resultTypes: ["violations"] }));
  assert.deepEqual(
    violations.map((v) => `${v.id}: ${v.nodes[0].html.slice(0, 200)} (${v.nodes[0].failureSummary})`),
    [],
    name,
  );
}

async function checkPrint(page, name) {
  const pdf = await page.pdf({ format: "A4", path: join(here, `${name}.pdf`) });
  assert.ok(pdf.length > 30_000, `${name}: a PDF of ${pdf.length} bytes`);
}

async function shoot(page, name) {
  if (!shots) return;
  await page.evaluate(() => window.scrollTo(0, 0));
  await page.waitForTimeout(200);
  await page.screenshot({ path: join(shots, `${name}.png`), fullPage: true });
}

async function checkPage(browser, { name, file }) {
  assert.ok(statSync(file).size < 3_000_000, `${name} has ${statSync(file).size} bytes`);
  for (const options of [{ width: 1280 }, { width: 400 }, { width: 1280, scheme: "dark" }]) {
    const label = `${name}, ${options.width} px, ${options.scheme ?? "light"}`;
    const { context, page, complaints } = await open(browser, file, options);
    const figures = await checkFigures(page, label);
    assert.ok(await fits(page), `${label}: it must be scrolled sideways`);
    await shoot(page, `${name}_${options.width}_${options.scheme ?? "light"}`);
    if (options.width === 1280 && !options.scheme && name === "images") {
      await context.grantPermissions(["clipboard-read", "clipboard-write"]);
      await checkReadingAndZoom(page);
      await checkTurning(page);
      await checkHiding(page);
      await checkSaving(page);
      await checkTable(page);
      await checkFrames(page);
    }
    if (options.width === 400 && name === "images") await checkTouch(page);
    if (options.scheme === "dark") {
      const dark = await page.evaluate(() =>
        getComputedStyle(document.body)
          .backgroundColor.match(/\d+/g)
          .every((c) => Number(c) < 50),
      );
      assert.ok(dark, `${label}: it is not dark`);
    }
    if (options.width === 1280 && !options.scheme) await checkPrint(page, name);
    assert.deepEqual(complaints, [], label);
    await context.close();
    console.log(`${label}: ${figures} figures`);
  }
  // The page's own policy forbids what the test adds to it.
  const context = await browser.newContext({ viewport: { width: 1280, height: 900 }, bypassCSP: true });
  const page = await context.newPage();
  await page.goto(pathToFileURL(file).href);
  await page.evaluate(() => window.vobench.drawAll());
  for (const scheme of ["light", "dark"]) {
    await page.emulateMedia({ colorScheme: scheme });
    await checkAccessible(page, `${name}, ${scheme}`);
  }
  await context.close();
}

async function checkPolicy(browser, { file }) {
  const { context, page } = await open(browser, file, { width: 1280 });
  const refused = await page.evaluate(
    () =>
      new Promise((resolve) => {
        document.addEventListener("securitypolicyviolation", (event) => resolve(event.violatedDirective));
        fetch("http://127.0.0.1:9/").catch(() => {});
        setTimeout(() => resolve("nothing"), 3000);
      }),
  );
  assert.match(refused, /connect-src|default-src/);
  await context.close();
}

async function checkWithoutScripts(browser, { file }) {
  const { context, page } = await open(browser, file, { width: 1280, scripts: false });
  assert.ok(await page.locator("table").first().isVisible());
  assert.ok(await page.locator(".tile").first().isVisible());
  assert.ok(await page.getByText("Diagrams need scripts").isVisible());
  assert.equal(await page.locator(".figure:visible").count(), 0);
  await context.close();
}

await withBrowser(async (browser) => {
  const pages = makePages();
  for (const page of pages) await checkPage(browser, page);
  await checkPolicy(browser, pages[0]);
  await checkWithoutScripts(browser, pages[0]);
});
console.log("the report is as it should be");
