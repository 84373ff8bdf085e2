// SPDX-License-Identifier: BSD-3-Clause
// The page of a run in a real browser. What is tested, by the environment:
//   AIMS_PAGE_TEMPLATES  folder of the built run.html: pages are made up with it (test/fixtures.mjs)
//   AIMS_PAGES      folder with run/page.html, run/scores.json and others, of real runs
//   AIMS_PAGE_MODULES    node_modules with playwright-core
//   AIMS_PAGE_ARTIFACTS  where screenshots and made-up pages are kept
import assert from "node:assert/strict";
import { existsSync } from "node:fs";
import { readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { after, before, describe, test } from "node:test";
import { hasChromium, kChromium, launch, open, settle } from "./browser.mjs";
import { kCases, writeFixtures } from "./fixtures.mjs";
import { assertHolds, assertRunPage, cursorOf, kArtifacts } from "./run_checks.mjs";

const template = process.env.AIMS_PAGE_TEMPLATES && path.join(process.env.AIMS_PAGE_TEMPLATES, "run.html");
const pages = process.env.AIMS_PAGES;
const skip = hasChromium() ? false : `no ${kChromium}`;

describe(
  "made-up runs",
  { skip: skip || (template ? false : "AIMS_PAGE_TEMPLATES is not set") },
  () => {
    let browser;
    let files;
    before(async () => {
      files = await writeFixtures(template, path.join(kArtifacts, "pages"));
      browser = await launch();
    });
    after(() => browser?.close());
    test("a run is drawn, and its cursor, zoom, estimators and tables work", async () => {
      await assertRunPage(
        browser,
        files.run,
        "made-up-run",
        JSON.parse(JSON.stringify(kCases.run().scores)),
      );
    });
    for (const name of ["hostile", "not-numbers", "one-scan", "empty"]) {
      test(`a run of ${name} gives a correct page`, () =>
        assertHolds(browser, files[name], `made-up-${name}`));
    }
    test("hostile names are shown as they are", async () => {
      const { page, context } = await open(browser, files.hostile);
      const names = await page
        .locator("input[name=estimator]")
        .evaluateAll((list) => list.map((input) => input.dataset.estimator));
      assert.deepEqual(
        names,
        kCases.hostile().estimators.map((item) => item.name),
      );
      assert.equal(await page.textContent("h1"), kCases.hostile().title);
      await context.close();
    });
    test("the verdict names why a run is invalid, and expectations that do not hold", async () => {
      const { page, context } = await open(browser, files.failed);
      const verdict = page.locator("[data-verdict]");
      assert.equal(await verdict.getAttribute("data-verdict"), "bad");
      const text = await verdict.innerText();
      assert.match(text, /Invalid run: the robot fell at 3\.2 s\./);
      assert.match(text, /1 of 2 expectations do not hold: lio ate_m is 0\.400, expected at most 0\.100\./);
      assert.deepEqual(
        await page.locator('[data-table="paper"] tbody td[data-label="Success"]').allInnerTexts(),
        Array(4).fill("invalid run"),
      );
      assert.deepEqual(await page.locator("[data-failures] li").allInnerTexts(), ["mine: boom <b>"]);
      assert.doesNotMatch(await page.innerText(".page-head"), /interrupted/);
      assert.match(await page.innerText('[data-table="paper"]'), /degraded; healthy for 98\.9 s while wrong/);
      assert.match(await page.innerText("#details"), /From the truth: /);
      assert.doesNotMatch(await page.innerText("#results"), /From the truth: /);
      await context.close();
      const held = await open(browser, files.run);
      assert.match(await held.page.innerText("[data-verdict]"), /^lio and aims keep .* within [^]*3 of 4 estimators succeeded\. tfs diverged 181 s after the start\./);
      await held.context.close();
    });
    test("scores of an estimate that ends early are marked, and a legend says so", async () => {
      const legend = /part: over the parts of the runs that have poses alone/;
      const { page, context } = await open(browser, files.part);
      for (const table of ["paper", "errors"]) {
        const place = page.locator(`[data-table="${table}"]`);
        assert.match(await place.locator('tr[data-row="lio"]').innerText(), /\d part\b/, table);
        assert.doesNotMatch(await place.locator('tr[data-row="aims"]').innerText(), /part\b/, table);
        assert.match(await place.locator(".caption").innerText(), legend, table);
      }
      assert.doesNotMatch(await page.innerText('[data-table="times"]'), /part\b/);
      await context.close();
      const whole = await open(browser, files.run);
      assert.doesNotMatch(await whole.page.innerText("body"), legend);
      await whole.context.close();
    });
    test("six thousand samples of five estimators answer a key within a few frames", async () => {
      const { page, context, troubles } = await open(browser, files.large);
      await page.locator(".strips").focus();
      const before = await cursorOf(page);
      for (let i = 0; i < 5; ++i) await page.keyboard.press("Shift+ArrowRight");
      await settle(page);
      assert.ok((await cursorOf(page)) > before);
      assert.deepEqual(troubles, []);
      await context.close();
    });
    test("a page whose data are cut says so", async () => {
      const text = await readFile(files.run, "utf8");
      const cut = path.join(kArtifacts, "pages", "cut.html");
      await writeFile(cut, text.replace(/(<script id="aims-data"[^>]*>.{4000})[^<]*/s, "$1"));
      const { page, context, ready } = await open(browser, cut);
      assert.equal(ready, "failed");
      assert.match(await page.textContent("[role=alert]"), /cannot be shown/);
      await context.close();
    });
  },
);

describe("real runs", { skip: skip || (pages ? false : "AIMS_PAGES is not set") }, () => {
  let browser;
  before(async () => {
    browser = await launch();
  });
  after(() => browser?.close());
  const file = (name) => path.join(pages ?? "", name, "page.html");
  test("the page of a run agrees with its scores.json", async () => {
    const scores = JSON.parse(await readFile(path.join(pages, "run", "scores.json"), "utf8"));
    await assertRunPage(browser, file("run"), "run", scores);
  });
  for (const name of ["hostile", "bare"]) {
    test(
      `the page of the run ${name} holds`,
      { skip: pages && !existsSync(file(name)) ? `no ${file(name)}` : false },
      () => assertHolds(browser, file(name), name),
    );
  }
});
