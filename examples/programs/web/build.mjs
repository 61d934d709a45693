// SPDX-License-Identifier: MPL-2.0
// Bundles the pages: build.mjs <folder of sources> <folder to write to>. Run by scripts/web_assets where the npm packages are.
import { mkdirSync, readFileSync, renameSync, writeFileSync } from "node:fs";
import { join } from "node:path";
import { build } from "esbuild";

const [sources, target] = process.argv.slice(2);
const pages = { display: ["three"], monitor: ["jsroot"] };

async function bundle(entry) {
  const result = await build({
    entryPoints: [join(sources, entry)], bundle: true, minify: true, write: false, format: "iife", target: "es2022", logLevel: "warning",
    legalComments: "inline", nodePaths: [join(process.cwd(), "node_modules")], external: ["node:*"],
    alias: { "jsroot-modules": join(process.cwd(), "node_modules/jsroot/modules") },  // the parts of it that draw histograms: a tenth of the whole
  });
  return result.outputFiles[0].text;
}

mkdirSync(target, { recursive: true });
for (const [page, packages] of Object.entries(pages)) {
  // "</script" may stand in a string of the code; there "\/" is the same.
  const code = (await bundle(`${page}.js`)).replaceAll("</script", "<\\/script");
  const style = (await bundle(`${page}.css`)) || "";
  const licences = packages.map((name) => `${name}\n\n${readFileSync(join("node_modules", name, "LICENSE"), "utf8")}`.replaceAll("--", "- -")).join("\n");
  const html = readFileSync(join(sources, `${page}.html`), "utf8")
    .replace("<!--STYLE-->", () => `<style>\n${style}</style>`)
    .replace("<!--SCRIPT-->", () => `<!-- This page contains:\n${licences}\n-->\n<script>\n${code}</script>`);
  const file = join(target, `${page}.html`);
  writeFileSync(`${file}.partial`, html);
  renameSync(`${file}.partial`, file);
  console.log(`${file}: ${(html.length / 1e6).toFixed(2)} MB`);
}
