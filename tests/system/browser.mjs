// Common parts of tests in a headless Chromium: the program, the browser, a temporary folder.
// Arguments: VOBENCH MODULES [...]     MODULES has node_modules, and beside it are the scenes
// Exit:  77 where there is no Chromium.
import { existsSync, mkdtempSync, rmSync } from "node:fs";
import { createRequire } from "node:module";
import { tmpdir } from "node:os";
import { delimiter, join, resolve } from "node:path";

export const [program, modules] = process.argv.slice(2, 4).map((path) => resolve(path));
const load = createRequire(resolve(modules, "package.json"));
const { chromium } = load("playwright-core");
export const axe = load.resolve("axe-core/axe.min.js");
export const scenes = resolve(modules, "../scenes"); // with small textures
export const here = mkdtempSync(join(tmpdir(), "vobench-report-page-"));
process.on("exit", () => rmSync(here, { recursive: true, force: true }));

const flags = [
  "--no-sandbox",
  "--disable-gpu",
  "--disable-quic",
  "--no-first-run",
  "--disable-background-networking",
  "--disable-component-update",
  "--disable-sync",
];

// Runs `check` with a new browser.
export async function withBrowser(check) {
  const executablePath = ["chromium", "chromium-browser", "google-chrome"]
    .flatMap((name) => process.env.PATH.split(delimiter).map((folder) => join(folder, name)))
    .find((path) => existsSync(path));
  if (!executablePath) {
    console.log("skipped: there is no Chromium on PATH (Debian's package is chromium)");
    process.exit(77);
  }
  const browser = await chromium.launch({ executablePath, args: flags });
  try {
    await check(browser);
  } finally {
    await browser.close();
  }
}
