// SPDX-License-Identifier: BSD-3-Clause
// Opens pages of made-up studies with the built template, and leaves pictures of them where asked.
import { existsSync } from "node:fs";
import { mkdir, mkdtemp, readFile, rm, writeFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { hasChromium, launch, open } from "./browser.mjs";
import { fillTemplate } from "./pack.mjs";

const kTemplate = path.join(process.env.AIMS_PAGE_TEMPLATES ?? "", "study.html");
const kArtifacts = process.env.AIMS_PAGE_ARTIFACTS ?? "";

/** Why pages cannot be opened here; false when they can. */
export function whySkipped() {
  if (!hasChromium()) return "no Chromium";
  return existsSync(kTemplate) ? false : "AIMS_PAGE_TEMPLATES holds no study.html";
}

/** A browser and a folder for a file of tests. */
export async function stage() {
  const folder = await mkdtemp(path.join(os.tmpdir(), "aims-page-"));
  const browser = await launch({ webgl: false });
  const template = await readFile(kTemplate, "utf8");
  let count = 0;
  return {
    /** The opened page of a payload; see browser.mjs. */
    async show(payload, options) {
      const file = path.join(folder, `${++count}.html`);
      await writeFile(file, fillTemplate(template, payload));
      return open(browser, file, options);
    },
    async close() {
      await browser.close();
      await rm(folder, { recursive: true });
    },
  };
}

/** Keeps a picture of the page, where the environment names a folder for them. */
export async function keepPicture(page, name) {
  if (!kArtifacts) return;
  await mkdir(kArtifacts, { recursive: true });
  await page.screenshot({ path: path.join(kArtifacts, `${name}.png`), fullPage: true });
}

/** Tables that their frame scrolls although they fit into it: "caption: width in width". */
export function needlessScrolls(page) {
  return page.evaluate(() =>
    [...document.querySelectorAll(".table-frame")].flatMap((frame) => {
      const table = frame.querySelector("table")?.getBoundingClientRect();
      const fits = table && table.width <= frame.clientWidth + 0.5;
      const scrolls = frame.scrollWidth > frame.clientWidth;
      return fits && scrolls
        ? [`${frame.ariaLabel}: ${frame.scrollWidth} in ${frame.clientWidth}`]
        : [];
    }),
  );
}

/** Whether the page is wider than its window. */
export function overflows(page) {
  return page.evaluate(() => document.documentElement.scrollWidth > innerWidth);
}
