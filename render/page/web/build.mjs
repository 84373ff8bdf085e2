// SPDX-License-Identifier: BSD-3-Clause
// Builds the page: `npm run build -- --out DIR` writes DIR/page.js, DIR/page.css and DIR/page.html,
// and DIR/watch.html, the page of `aims watch`.
// page.html has both inlined and two marks left, each exactly once, for `aims page` to replace:
// __AIMS_TITLE__ (escaped for HTML) and __AIMS_DATA__ (base64). Same sources, same bytes.
// --modules DIR: the node_modules to build with, where they do not lie beside this file.
import { createHash } from "node:crypto";
import { mkdir, readFile, writeFile } from "node:fs/promises";
import { createRequire } from "node:module";
import path from "node:path";
import { fileURLToPath } from "node:url";
import { parseArgs } from "node:util";

const here = path.dirname(fileURLToPath(import.meta.url));
const { values } = parseArgs({
  options: {
    out: { type: "string", default: path.join(here, "dist") },
    modules: { type: "string", default: path.join(here, "node_modules") },
  },
});
const out = path.resolve(values.out);
const modules = path.resolve(values.modules);
const { build } = createRequire(path.join(modules, "any.js"))("esbuild");

/** Script and style of an entry, safe inside their own elements, and the template with both. */
async function bundle(entry, banner, replaced) {
  const result = await build({
    absWorkingDir: here,
    entryPoints: { page: entry },
    outdir: out,
    nodePaths: [modules],
    bundle: true,
    minify: true,
    write: false,
    format: "iife",
    target: "es2022",
    charset: "ascii",
    legalComments: "none",
    banner: { js: banner },
    logLevel: "warning",
  });
  const textOf = (name) => result.outputFiles.find((file) => file.path.endsWith(name)).text.trim();
  const script = textOf(".js")
    .replace(/<\/script/gi, "<\\/script")
    .replace(/<!--/g, "<\\!--");
  const style = textOf(".css").replace(/<\/style/gi, "<\\/style");
  const hash = createHash("sha256").update(script, "utf8").digest("base64");
  let page = template
    .replace("@@SCRIPT_HASH@@", () => `sha256-${hash}`)
    .replace("@@STYLE@@", () => style)
    .replace("@@SCRIPT@@", () => script);
  for (const [mark, text] of replaced) page = page.replace(mark, () => text);
  return { script, style, page };
}

const template = await readFile(path.join(here, "src/template.html"), "utf8");
const { script, style, page } = await bundle("src/main.ts", "/* aims page; three.js (MIT), uPlot (MIT) */", []);
for (const mark of ["__AIMS_TITLE__", "__AIMS_DATA__"]) {
  if (page.split(mark).length !== 2) throw new Error(`page.html: expected ${mark} exactly once`);
}
// The page of `aims watch` has no data; it asks the program that serves it.
const watch = await bundle("src/watch/watch.ts", "/* aims watch; uPlot (MIT) */", [
  ["default-src 'none'", "default-src 'none'; connect-src 'self'"],
  ["__AIMS_TITLE__", "aims watch"],
  ["__AIMS_DATA__", ""],
]);

await mkdir(out, { recursive: true });
await writeFile(path.join(out, "page.js"), script);
await writeFile(path.join(out, "page.css"), style);
await writeFile(path.join(out, "watch.html"), watch.page);
await writeFile(path.join(out, "page.html"), page);
const kilobytes = (text) => `${Math.round(text.length / 1024)} KB`;
console.log(
  `${out}: page.js ${kilobytes(script)}, page.css ${kilobytes(style)}, ` +
    `page.html ${kilobytes(page)}, watch.html ${kilobytes(watch.page)}`,
);
