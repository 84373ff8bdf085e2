// SPDX-License-Identifier: BSD-3-Clause
// Builds the pages: `npm run build -- --out DIR` writes DIR/run.html (of a run), DIR/study.html (of
// suites, sweeps and tunings) and DIR/watch.html (of `aims watch`), each with its script and style.
// The first two have two marks left, each exactly once, for `aims page` to replace:
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

/** The template with script and style of an entry, both safe inside their own elements. */
async function bundled(entry, banner) {
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
  return template
    .replace("@@SCRIPT_HASH@@", () => `sha256-${hash}`)
    .replace("@@STYLE@@", () => style)
    .replace("@@SCRIPT@@", () => script);
}

const template = await readFile(path.join(here, "src/template.html"), "utf8");
const pages = {
  run: await bundled("src/run_page.ts", "/* aims page; three.js (MIT), uPlot (MIT) */"),
  study: await bundled("src/study_page.ts", "/* aims page; Observable Plot, D3 (ISC) */"),
};
for (const [name, page] of Object.entries(pages)) {
  for (const mark of ["__AIMS_TITLE__", "__AIMS_DATA__"]) {
    if (page.split(mark).length !== 2) throw new Error(`${name}.html: expected ${mark} exactly once`);
  }
}
// The page of `aims watch` has no data; it asks the program that serves it.
pages.watch = (await bundled("src/watch/watch.ts", "/* aims watch; uPlot (MIT) */"))
  .replace("default-src 'none'", "default-src 'none'; connect-src 'self'")
  .replace("__AIMS_TITLE__", "aims watch")
  .replace("__AIMS_DATA__", "");

await mkdir(out, { recursive: true });
const sizes = [];
for (const [name, page] of Object.entries(pages)) {
  await writeFile(path.join(out, `${name}.html`), page);
  sizes.push(`${name}.html ${Math.round(page.length / 1024)} KB`);
}
console.log(`${out}: ${sizes.join(", ")}`);
