// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { after, before, test } from "node:test";
import { keepPicture, overflows, stage, whySkipped } from "./made_up.mjs";
import { kHostile, tuning } from "./suite_fixtures.mjs";

const skip = whySkipped();
let pages;
before(async () => { if (!skip) pages = await stage(); });
after(async () => { await pages?.close(); });

test("best values and indices are those of the analysis", { skip }, async () => {
  const data = tuning();
  const { page, troubles, ready } = await pages.show(data);
  assert.equal(ready, "true");
  const { best, sensitivity } = data.estimators[0].analyses[0];
  assert.equal(Number(await page.locator("[data-best]").getAttribute("data-best")), best.objective);
  const eta = page.locator('#best tr[data-row="degeneracy.eta"]');
  assert.match(await eta.innerText(), /6\.00\s*4\.00 to 6\.00/);
  const rows = page.locator("#sensitivity .sobol-row");
  assert.equal(Number(await rows.nth(0).getAttribute("data-total")), sensitivity.total[0]);
  assert.match(await rows.nth(0).innerText(), /95\.0 % \[90\.0, 98\.0\], first order 88\.0 %/);
  assert.match(await rows.nth(1).innerText(), /negligible/);
  assert.deepEqual(troubles, []);
});

test("the held-out verdict leads, and says when there is none", { skip }, async () => {
  const data = { ...tuning(), source: "tune" };
  data.estimators[0].analyses[0].held_out = { verdict: "do not use", text: "do not use them: 8.7 % worse on 8 held-out sequences",
    sequences: 8, gain: -0.087, gain_interval: [-0.12, -0.05], p: 0.01 };
  const { page, troubles } = await pages.show(data);
  const first = page.locator("#best p").first();
  assert.equal(await first.getAttribute("data-verdict"), "do not use");
  assert.match(await first.innerText(), /^Tuned values: degeneracy\.eta 6\.00 instead of 3\.00\. Verdict: do not use them: 8\.7 % worse/);
  data.estimators[0].analyses[0].held_out = null;
  const other = await pages.show(data);
  assert.match(await other.page.locator("#best p").first().innerText(), /Verdict: not validated/);
  const sweep = await pages.show(tuning());
  assert.equal(await sweep.page.locator("#best [data-verdict]").count(), 0);
  assert.match(await sweep.page.locator("#best p").first().innerText(), /^Best values: degeneracy\.eta 6\.00 instead of 3\.00/);
  assert.deepEqual(troubles, []);
});

test("the least of points that are not resolved is not called best", { skip }, async () => {
  const data = tuning();
  data.estimators[0].analyses[0].standing = "least, not resolved";
  const { page } = await pages.show(data);
  assert.match(await page.locator("#best p").first().innerText(), /^Least objective, not resolved: degeneracy\.eta 6\.00/);
});

test("an interrupted tuning has no tuned values", { skip }, async () => {
  const { page } = await pages.show({ ...tuning(), source: "tune", interrupted: true });
  const first = page.locator("#best p").first();
  assert.equal(await first.getAttribute("data-verdict"), "undecided");
  assert.match(await first.innerText(), /^Interrupted\. Best so far/);
  assert.doesNotMatch(await page.locator("#best").innerText(), /Tuned values/);
});

test("a Pareto front has the verdict on the front, whatever its first objective says", { skip }, async () => {
  const data = { ...tuning(), source: "tune", front: "do not use them: none of the 3 points of the front is better than the defaults" };
  data.estimators[0].analyses[0].held_out = { verdict: "use", text: "use them: 30 % better", sequences: 8, gain: 0.3, gain_interval: [0.2, 0.4], p: 0.01 };
  const { page, troubles } = await pages.show(data);
  const first = page.locator("#best p").first();
  assert.equal(await first.getAttribute("data-verdict"), "do not use");
  assert.match(await first.innerText(), /^Pareto front\. Verdict: do not use them/);
  assert.doesNotMatch(await page.locator("#best").innerText(), /use them: 30 %/);
  assert.deepEqual(troubles, []);
});

test("indices that a fit does not support are not resolved", { skip }, async () => {
  const data = tuning();
  Object.assign(data.estimators[0].analyses[0].sensitivity, { of_grid: false, has_indices: false, resolved: false, fit: { terms: 4, error: 0.3, explained: 0.65 } });
  const { page } = await pages.show(data);
  assert.equal(await page.locator("#sensitivity .sobol-row").count(), 0);
  assert.match(await page.locator("#sensitivity").innerText(), /Not resolved.*90\.0 %[^]*65\.0 %/);
});

test("an effect below the scatter of seeds, defaults that nothing beats and parameters without effect are said", { skip }, async () => {
  const data = tuning();
  const analysis = data.estimators[0].analyses[0];
  Object.assign(analysis.sensitivity, { resolved: false, negligible: [false, false] });
  analysis.effect = "The objective lies between 1 and 1.002 at the 12 points (0.16 %): not resolved, since seeds scatter as much (p = 0.65).";
  Object.assign(analysis.best, { is_default: true, without_effect: [false, true], values: [3, 12.6], distance: [0, 0], text: "no point is better than the defaults: ..." });
  const { page } = await pages.show(data);
  assert.match(await page.locator("#best p").first().innerText(), /^Keep the defaults: no point is better than the defaults/);
  assert.match(await page.locator("#best table").innerText(), /no effect/);
  assert.match(await page.locator("#sensitivity").innerText(), /Not resolved\. The objective lies between 1 and 1\.002/);
});

test("markers are measurements alone, a fit is a thin line without markers", { skip }, async () => {
  const data = tuning();
  const x = Float32Array.from({ length: 25 }, (_, i) => i / 4);
  const y = x.map(() => 0.5);
  data.estimators[0].analyses[0].curves[0].fit = { x, value: y, low: y.map((each) => each - 0.1), high: y.map((each) => each + 0.1) };
  const { page } = await pages.show(data);
  const chart = page.locator("#curves figure.chart").first();
  assert.equal(await chart.locator("g.marks > circle, g.marks > path").count(), 4);
  assert.equal(await chart.locator("g.line:not([stroke-width]) > path").count(), 1, "of one pixel");
  assert.equal(await chart.locator("g.line > path").count(), 1, "the markers are not joined beside a fit");
  assert.equal(await chart.locator("g.band > path").count(), 1, "the fit has the area of its interval");
  assert.match(await page.locator("#curves .held").first().innerText(), /kappa = 10 \(default 12\.6\)/);
});

test("each parameter has a curve with intervals, or every point by scenario", { skip }, async () => {
  const { page, troubles } = await pages.show(tuning());
  const charts = page.locator("#curves figure.chart");
  assert.equal(await charts.count(), 2);
  assert.equal(await charts.nth(0).locator("g.bars > line").count(), 4);
  await page.locator("#curves").getByLabel("Show").selectOption("cloud");
  assert.equal(await charts.nth(0).locator("g.marks").count(), 2);
  assert.equal(await charts.nth(0).locator("g.cross > path").count(), 1);
  await page.locator(".toolbar").first().getByLabel("Score").selectOption("m_end_m");
  assert.match(await page.locator("#best").innerText(), /for m_end_m only the points/);
  assert.equal(await charts.nth(0).locator("g.marks").count(), 2);
  assert.deepEqual(troubles, []);
});

test("the map has a cell per pair of values and can be turned", { skip }, async () => {
  const { page } = await pages.show(tuning());
  const cells = page.locator("#map g.cells > rect");
  assert.equal(await cells.count(), 12);
  assert.match(await page.locator('#map [aria-label="x-axis label"]').textContent(), /eta/);
  await page.locator("#map").getByLabel("x axis").selectOption("1");
  assert.equal(await cells.count(), 12);
  assert.match(await page.locator('#map [aria-label="x-axis label"]').textContent(), /kappa/);
  assert.ok((await page.locator('#map [aria-label="y-axis tick label"] text').allTextContents()).includes("4"));
  await page.locator("#map svg[role=img]").focus();
  await page.keyboard.press("ArrowRight");
  assert.match(await page.locator("#map .readout").innerText(), /objective: ate_m \[m\] 0\.400 at degeneracy\.kappa 1\.00, degeneracy\.eta 6\.00/);
});

test("maps and points: each family has its map, every point its objective", { skip }, async () => {
  const data = tuning();
  const [first] = data.estimators[0].analyses[0].maps;
  data.estimators[0].analyses[0].maps.push({ ...first, family: "garage", measured: { ...first.measured, value: first.measured.value.map(() => 0.25) } });
  const { page, troubles } = await pages.show(data);
  await page.locator("#map").getByLabel("Scenarios").selectOption("garage");
  assert.deepEqual(new Set(await page.locator("#map g.number text").allTextContents()), new Set(["0.250"]));
  await page.locator("#curves").getByLabel("Show").selectOption("points");
  const charts = page.locator("#curves figure.chart");
  assert.equal(await charts.nth(0).locator('g.marks[aria-description="points"] > circle').count(), 12);
  assert.equal(await charts.nth(0).locator('g.marks[aria-description="best point"] > path').count(), 1);
  assert.deepEqual(troubles, []);
});

test("the points sort, the least objective first and in bold, which is the best point", { skip }, async () => {
  const { page } = await pages.show(tuning());
  const rows = page.locator("#points tbody tr");
  assert.equal(await rows.count(), 13);
  const scores = (await page.locator("#points tbody tr td:nth-child(2)").evaluateAll((cells) =>
    cells.map((each) => each.dataset.value))).map(Number);
  assert.deepEqual(scores, [...scores].sort((a, b) => a - b));
  assert.equal(await page.locator("#points td.best").count(), 1);
  assert.equal(Number(await page.locator("#points td.best").getAttribute("data-value")).toFixed(3), "0.400");
  assert.match(await rows.first().innerText(), /, best/);
  await page.locator("#points").getByRole("button", { name: /degeneracy.kappa/ }).click();
  assert.equal(await rows.first().locator("td").nth(3).getAttribute("data-value"), "1");
  await page.locator("#points").getByLabel("Scenario").selectOption("1");
  assert.match(await page.locator("#points .caption").innerText(), /over garage/);
});

test("hostile names, nothing done and one scenario give a page", { skip }, async () => {
  const hostile = await pages.show({ ...tuning({ parameter: kHostile, scenarios: [kHostile] }), title: kHostile }, { width: 390 });
  assert.equal(hostile.ready, "true");
  assert.equal(await hostile.page.evaluate(() => window.broken), undefined);
  assert.equal(await hostile.page.locator("img").count(), 0);
  assert.equal(await overflows(hostile.page), false);
  const none = await pages.show({ ...tuning(), estimators: [], sequences: [] });
  assert.match(await none.page.locator("body").innerText(), /No job is done yet/);
  const bare = tuning();
  Object.assign(bare.estimators[0].analyses[0], { best: null, why_no_best: "none of 0 points", sensitivity: null, curves: [], maps: [] });
  bare.estimators[0].rows.scores.fill(NaN);
  const third = await pages.show(bare);
  assert.equal(third.ready, "true");
  assert.match(await third.page.locator("#best").innerText(), /No best point: none of 0 points/);
  assert.deepEqual([...hostile.troubles, ...none.troubles, ...third.troubles], []);
});

test("it fits 1280 and 390 pixels, light and dark", { skip }, async () => {
  for (const [width, dark] of [[1280, false], [390, true]]) {
    const { page, troubles, context } = await pages.show(tuning(), { width, dark });
    assert.equal(await overflows(page), false, `${width}`);
    await keepPicture(page, `tuning-${width}-${dark ? "dark" : "light"}`);
    assert.deepEqual(troubles, []);
    await context.close();
  }
});
