// Bundles src/main.ts and the licence texts of what is in the bundle into one script.
// Usage: node build.mjs OUTPUT      in a folder with node_modules (npm ci)
import { build } from "esbuild";
import { readFileSync, writeFileSync } from "node:fs";
import { join } from "node:path";

const output = process.argv[2];
const result = await build({
  entryPoints: ["src/main.ts"],
  bundle: true,
  minify: true,
  format: "iife",
  target: "es2020",
  charset: "utf8",
  legalComments: "none", // whole licences instead, below
  metafile: true,
  write: false,
  logLevel: "warning",
});

const packages = new Set();
for (const input of Object.keys(result.metafile.inputs)) {
  const found = input.match(/^node_modules\/((?:@[^/]+\/)?[^/]+)\//);
  if (found) packages.add(found[1]);
}
const notices = [...packages].sort().map((name) => {
  const folder = join("node_modules", name);
  const { version, license } = JSON.parse(readFileSync(join(folder, "package.json"), "utf8"));
  const texts = ["LICENSE", "LICENSE.txt", "LICENSE.md", "NOTICE"].flatMap((file) => {
    try {
      return [readFileSync(join(folder, file), "utf8").trim()];
    } catch {
      return [];
    }
  });
  if (texts.length === 0) throw new Error(`${name} has no licence text`);
  return `${name} ${version} (${license})\n\n${texts.join("\n\n")}`;
});
const notice = `/*! Parts of this script are other people's work:\n\n${notices.join("\n\n----\n\n")}\n*/\n`;
writeFileSync(output, notice.replaceAll("</script", "<\\/script") + result.outputFiles[0].text);
