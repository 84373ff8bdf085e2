// SPDX-License-Identifier: BSD-3-Clause
import assert from "node:assert/strict";
import { readFile, writeFile } from "node:fs/promises";
import { after, before, test } from "node:test";
import { keepPicture, needlessScrolls, overflows, stage, whySkipped } from "./made_up.mjs";
import { comparison, consistency, detectors, lackPart, paper, kHostile, suite } from "./suite_fixtures.mjs";

const skip = whySkipped();
let pages;
before(async () => { if (!skip) pages = await stage(); });
after(async () => { await pages?.close(); });

const cell = (page, row, estimator) =>
  page.locator(`[id="matrix"] tr[data-row="${row}"] td[data-estimator="${estimator}"]`);
const values = (page, estimator) => page.locator(`#matrix td[data-estimator="${estimator}"]`)
  .evaluateAll((cells) => cells.map((each) => each.dataset.value ?? null));

test("the matrix shows the suite's own numbers", { skip }, async () => {
  const data = suite();
  const { page, troubles, ready } = await pages.show(data);
  assert.equal(ready, "true");
  for (const scenario of data.suite.scenarios) {
    for (const [name, each] of Object.entries(scenario.estimators)) {
      const shown = await cell(page, scenario.name, name).getAttribute("data-value");
      const median = each.scores.ate_m.median;
      assert.equal(shown === null ? null : Number(shown), median);
    }
  }
  await page.locator("#matrix").getByLabel("Statistic").selectOption("worst");
  assert.equal(Number(await cell(page, "severity_2", "a").getAttribute("data-value")), data.suite.scenarios[1].estimators.a.scores.ate_m.worst);
  await page.locator("#matrix").getByLabel("Score").selectOption("m_list_percent.all");
  assert.equal(Number(await cell(page, "alone", "a").getAttribute("data-value")), data.suite.scenarios[3].estimators.a.scores["m_list_percent.all"].worst);
  assert.deepEqual(troubles, []);
});

test("a benchmark leads with its own score, whatever other scores order", { skip }, async () => {
  const data = suite({ names: ["day"] });
  const key = "control_points.score";
  data.score_list = [{ key, title: key, unit: "of 100", better: "larger" }, ...data.score_list];
  data.headline = [key, ...data.headline];
  const [day] = data.suite.scenarios;
  day.estimators.a.scores[key] = { median: 40, worst: 40, count: 3 };
  day.estimators.b.scores[key] = { median: 60, worst: 60, count: 3 };
  data.benchmark = {
    title: "A data set", score: key, unit: "of 100", score_text: "points of control points", better: "larger",
    notes: ["cite: someone", "day: truth: day_gt.txt"],
    sequences: [
      { name: "day", truth: "/data/day_gt.txt", truth_text: "day_gt.txt", lack: "", ours: { a: 40, b: 60 }, published: { LOAM: 50 } },
      { name: kHostile, truth: "", truth_text: "", lack: "no truth: looked for it", ours: { a: null, b: null }, published: {} },
    ],
  };
  const { page, troubles, ready } = await pages.show(data);
  assert.equal(ready, "true");
  assert.match(await page.innerText("[data-verdict]"), /control_points\.score \[of 100\] on day: b 60\.000, a 40\.000\./);
  const rows = await page.locator("#benchmark tbody tr").allInnerTexts();
  assert.match(rows[0], /day\s+40\.000\s+60\.000\s+50\.000\s+day_gt\.txt/);
  assert.match(rows[1], /not scored: no truth: looked for it/);
  assert.match(await page.innerText("#benchmark"), /larger is better[^]*cite: someone/);
  assert.equal(await page.locator("main section, section").first().getAttribute("id"), "benchmark");
  assert.equal(Number(await cell(page, "day", "a").getAttribute("data-value")), 40);
  assert.match(await cell(page, "day", "b").getAttribute("class"), /best/);
  assert.deepEqual(troubles, []);
});

test("what was set and who failed stand at the head", { skip }, async () => {
  const data = suite();
  data.suite.settings = ["lidar.columns=90"];
  data.suite.failures = [{ scenario: "severity_3", seed: 2, estimator: "mine", message: "boom\nsecond line" }];
  const { page } = await pages.show(data);
  assert.equal(await page.innerText("[data-settings]"), "Set on top of the scenario: lidar.columns=90");
  assert.match(await page.innerText("[data-failures]"), /One failure: mine\./);
  assert.match(await page.innerText("#failures"), /severity_3, seed 2, mine: boom$/);
});

test("a diverged run is stated in words, not by colour alone", { skip }, async () => {
  const { page } = await pages.show(suite());
  assert.match(await cell(page, "severity_3", "b").innerText(), /✕ 3 of 3 diverged/);
  assert.doesNotMatch(await cell(page, "severity_3", "a").innerText(), /diverged/);
  await page.getByLabel("only with diverged runs").check();
  assert.equal(await page.locator("#matrix tbody tr").count(), 1);
});

test("a gap, a late start and a failure to run are named wherever runs are", { skip }, async () => {
  const data = suite({ names: ["one"] });
  const [one] = data.suite.scenarios;
  one.estimators.b = { ...one.estimators.b, successes: 0, success_rate: 0 };
  for (const seed of [1, 2, 3]) lackPart(data, seed, "b", { diverged_at_s: 10, diverged_reason: "gap", ate_m: 0.01 });
  data.suite.failures = [{ scenario: "one", seed: 2, estimator: "broken, b", message: "no such file" }];
  const { page, troubles } = await pages.show(data);
  assert.match(await cell(page, "one", "b").innerText(), /✕ 3 of 3: gap/);
  assert.match(await page.innerText("[data-verdict]"), /b has a gap on 3 of 3 seeds/);
  assert.match(await page.locator('#seeds tr[data-row="b"]').innerText(), /✕ 3 of 3: gap/);
  assert.match(await page.locator('#seeds tr[data-row="broken"]').innerText(), /failed on 1 of 3 seeds/);
  assert.match(await page.locator('#runs [data-run="one, seed 1"]').innerText(), /✕ gap at 10 s/);
  assert.match(await page.locator('#runs [data-run="one, seed 2"]').innerText(), /broken[^]*✕ failed/);
  assert.deepEqual(troubles, []);
});

test("one that failed to run on a seed is best of nothing, and the headline says so", { skip }, async () => {
  const data = suite({ names: ["one"] });
  const [one] = data.suite.scenarios;
  lackPart(data, 2, "a");
  one.estimators.a = { ...one.estimators.a, successes: 2, success_rate: 2 / 3 };
  data.suite.failures = [{ scenario: "one", seed: 2, estimator: "a", message: "killed" }];
  const { page, troubles } = await pages.show(data);
  assert.match(await cell(page, "one", "a").innerText(), /✕ 1 of 3: failed/);
  assert.match(await page.innerText("[data-verdict]"), /a failed to run on 1 of 3 seeds/);
  assert.match(await page.locator('#seeds tr[data-row="a"]').innerText(), /2 of 3.*failed on 1 of 3 seeds/);
  assert.equal(await page.locator('#seeds tr[data-row="a"] .best').count(), 0);
  assert.deepEqual(troubles, []);
});

test("one that ended early on a seed is best of nothing, and keeps no length in the headline", { skip }, async () => {
  const data = suite({ names: ["one"] });
  const [one] = data.suite.scenarios;
  lackPart(data, 2, "a", { diverged_at_s: 3, diverged_reason: "ends_early", ate_m: 1e-5 });
  one.estimators.a = { ...one.estimators.a, successes: 2, success_rate: 2 / 3 };
  const { page, troubles } = await pages.show(data);
  const legend = /part: over the parts of the runs that have poses alone/;
  assert.match(await page.locator('#seeds tr[data-row="a"]').innerText(), /0\.0123 \(0\.0246\) part/);
  assert.doesNotMatch(await page.locator('#seeds tr[data-row="b"]').innerText(), /part/);
  assert.match(await page.locator("#seeds .caption").innerText(), legend);
  assert.match(await cell(page, "one", "a").innerText(), /0\.0123 part/);
  assert.match(await page.locator("#matrix > div > .soft, #matrix .soft").first().innerText(), legend);
  const bars = (seed) => page.locator(`#runs [data-run="one, seed ${seed}"] [data-estimator="a"]`).innerText();
  assert.match(await bars(2), / part/);
  assert.doesNotMatch(await bars(1), / part/);
  assert.match(await page.innerText("#runs"), legend);
  await cell(page, "one", "a").locator("button").click();
  const details = page.locator(".cell-details");
  assert.match(await details.locator('tr[data-row="2"]').innerText(), /part/);
  assert.doesNotMatch(await details.locator('tr[data-row="1"]').innerText(), /part/);
  await page.locator("#matrix .toolbar select").first().selectOption("success rate");
  assert.doesNotMatch(await cell(page, "one", "a").innerText(), /part/, "a rate counts every run");
  assert.match(await page.innerText("[data-verdict]"), /a ends early on 1 of 3 seeds/);
  assert.equal(await page.locator('#seeds tr[data-row="a"] .best').count(), 0);
  assert.equal(await page.locator('#matrix td[data-estimator="a"].best').count(), 0);
  assert.deepEqual(troubles, []);
});

test("of whole estimates no legend speaks of parts, and of one estimator none of the best", { skip }, async () => {
  const data = suite({ names: ["one"] });
  const whole = await pages.show(data);
  assert.doesNotMatch(await whole.page.innerText("body"), /part: over/);
  assert.match(await whole.page.locator("#seeds .caption").innerText(), /Bold: best/);
  assert.doesNotMatch(await whole.page.locator("#seeds .caption").innerText(), /✕/);
  const [one] = data.suite.scenarios;
  delete one.estimators.b;
  for (const run of data.runs) delete run.estimators.b;
  const alone = await pages.show(data);
  assert.doesNotMatch(await alone.page.locator("#seeds .caption").innerText(), /Bold/);
});

test("the level of a family marks estimates that lack a part and levels that are as mild", { skip }, async () => {
  const data = suite();
  const [family] = data.suite.families;
  family.estimators.b.points[1].partial = true;
  family.alike_levels = [2];
  const { page, troubles } = await pages.show(data);
  await page.locator("#families summary").click();
  assert.match(await page.locator('#families tr[data-row="2"]').innerText(), /0\.100 part/);
  assert.match(await page.locator("#families .caption").innerText(), /part: over the parts/);
  assert.match(await page.innerText("#families"), /Not told apart from the mildest: 2\./);
  assert.deepEqual(troubles, []);
});

test("what failed on an invalid run is no failure of an estimator", { skip }, async () => {
  const data = suite({ names: ["one"] });
  const run = data.runs.find((each) => each.seed === 2);
  run.invalid = "the robot fell at 1.2 s";
  run.estimators = {};
  data.suite.scenarios[0].invalid = [{ seed: 2, reason: run.invalid }];
  data.suite.failures = [{ scenario: "one", seed: 2, estimator: "mine", message: "no scans" }];
  const { page, troubles } = await pages.show(data);
  assert.equal(await page.locator("[data-failures]").count(), 0);
  assert.doesNotMatch(await page.innerText("body"), /failed on every run/);
  assert.match(await page.innerText("#failures"), /one, seed 2, mine \(on an invalid run\): no scans/);
  assert.deepEqual(troubles, []);
});

test("the headline over seeds names an error in height", { skip }, async () => {
  const data = suite({ names: ["one"] });
  const { b } = data.suite.scenarios[0].estimators;
  Object.assign(b, { successes: 0, success_rate: 0 });
  b.scores["m_list_percent.all"] = { median: 0.5, worst: 0.6, count: 3 };
  b.scores["drift_m.rmse.vertical"] = { median: 2, worst: 3, count: 3 };
  b.scores["drift_m.rmse.longitudinal"] = { median: 0.1, worst: 0.2, count: 3 };
  b.scores.max_error_z_m = { median: 4, worst: 7, count: 3 };
  for (const run of data.runs) run.estimators.b.success = false;
  const { page, troubles } = await pages.show(data);
  assert.match(await page.innerText("[data-verdict]"), /b fails on 3 of 3 seeds, up to 7\.0 m off in height, its length by 0\.5/);
  assert.deepEqual(troubles, []);
});

test("each run has a small chart, the worst first, that links to its page", { skip }, async () => {
  const data = suite();
  const { page, troubles } = await pages.show(data);
  const charts = page.locator("#runs .small");
  assert.equal(await charts.count(), data.runs.length);
  const order = await charts.evaluateAll((list) => list.map((each) => each.dataset.run));
  // b diverges on severity_3; of its seeds the third has the largest errors of a, yet b's are alike.
  assert.deepEqual(new Set(order.slice(0, 3)), new Set([1, 2, 3].map((seed) => `severity_3, seed ${seed}`)));
  assert.match(await charts.first().innerText(), /b[^]*0\.500[^]*✕ at 13 s/);
  const linked = data.runs.filter((run) => run.href).map((run) => `${run.scenario}, seed ${run.seed}`);
  assert.deepEqual(new Set(await page.locator("#runs .small a").allInnerTexts()), new Set(linked));
  const link = page.locator('#runs [data-run="severity_1, seed 1"] a');
  assert.equal(await link.getAttribute("href"), "runs/severity_1/seed-1/page.html");
  const widths = await page.locator('#runs [data-run="alone, seed 1"] .small-bar')
    .evaluateAll((bars) => bars.map((bar) => bar.getBoundingClientRect().width));
  assert.ok(widths[1] > widths[0], "0.5 m is longer than 0.01 m");
  await page.locator("#runs").getByLabel("Score").selectOption("m_end_m");
  assert.match(await page.locator("#runs .soft").first().innerText(), /^M_end \[m\]/);
  assert.deepEqual(troubles, []);
});

test("of many runs the worst are shown until all are asked for", { skip }, async () => {
  const data = suite();
  data.runs = Array.from({ length: 60 }, (_, i) => ({ ...data.runs[0], seed: i, href: null,
    estimators: { a: { success: true, diverged_at_s: null, diverged_reason: "", ate_m: 0.01 * ((7 * i) % 60), m_end_m: 0 } } }));
  const { page } = await pages.show(data);
  const charts = page.locator("#runs .small");
  assert.equal(await charts.count(), 24);
  assert.match(await charts.first().innerText(), /0\.590/);
  await page.getByRole("button", { name: "Show all 60 runs" }).click();
  assert.equal(await charts.count(), 60);
});

test("invalid runs are stated above all, and are no runs of a cell", { skip }, async () => {
  const data = suite();
  const reason = "the robot fell at 1.2 s";
  data.suite.scenarios[0].invalid = [{ seed: 2, reason }];
  data.suite.scenarios[3].invalid = [1, 2, 3].map((seed) => ({ seed, reason }));
  data.suite.scenarios[3].estimators = {};
  for (const run of data.runs) {
    if (run.scenario === "alone" || (run.scenario === "severity_1" && run.seed === 2)) run.invalid = reason;
  }
  const { page, troubles } = await pages.show(data);
  assert.match(await page.locator(".banner").innerText(), /4 of 12 runs are invalid[^]*severity_1, seed 2: the robot fell at 1.2 s/);
  assert.match(await page.locator('#matrix tr[data-row="alone"]').innerText(), /no valid run/);
  await cell(page, "severity_1", "a").locator("button").click();
  assert.match(await page.locator(".cell-details").innerText(), /✕ invalid run: the robot fell at 1.2 s/);
  assert.deepEqual(troubles, []);
});

test("a suite without invalid runs has no banner, and shows its expectations", { skip }, async () => {
  const { page } = await pages.show(suite());
  assert.equal(await page.locator(".banner").count(), 0);
  assert.match(await page.locator("#expectations").innerText(), /3 of 4 are met/);
});

test("rows sort by an estimator, those without a value last", { skip }, async () => {
  const { page } = await pages.show(suite());
  await page.locator("#matrix thead button").filter({ hasText: /^b$/ }).click();
  await page.locator("#matrix thead button").filter({ hasText: /^b$/ }).click();
  const shown = await values(page, "b");
  assert.equal(shown.pop(), null);
  assert.deepEqual(shown.map(Number), [...shown.map(Number)].sort((x, y) => y - x));
});

test("a cell opens its runs, and runs link to their pages", { skip }, async () => {
  const { page } = await pages.show(suite());
  await cell(page, "severity_3", "b").locator("button").click();
  const shown = page.locator(".cell-details");
  assert.match(await shown.innerText(), /✕ diverged at 12.5 s: error_limit/);
  assert.equal(await shown.locator("a").first().getAttribute("href"), "runs/severity_3/seed-1/page.html");
  assert.equal(await page.locator('#matrix tr[data-row="alone"] .runs-links a').count(), 1);
});

test("every score has the unit of the list, and is best at the end that the list says", { skip }, async () => {
  const data = suite({ names: ["alone"] });
  const units = {
    "time_per_scan_ms.mean": "ms", "path_error_deg_per_m.all": "deg/m", "drift_m.rmse.tilt_rad": "rad", "optimized.ate_m": "m",
    "weak_axis.all.nees": "", coverage: "",
  };
  const { a, b } = data.suite.scenarios[0].estimators;
  for (const [own, value] of [[a, 1], [b, 2]])
    for (const key of Object.keys(units)) own.scores[key] = { median: value, worst: value, count: 3 };
  const { page, troubles } = await pages.show(data);
  const best = (name) => page.locator(`#matrix td.best[data-estimator="${name}"]`).count();
  for (const [key, marked] of [["time_per_scan_ms.mean", [1, 0]], ["coverage", [0, 1]], ["weak_axis.all.nees", [0, 0]]]) {
    await page.locator("#matrix").getByLabel("Score").selectOption(key);
    assert.deepEqual([await best("a"), await best("b")], marked, key);
  }
  await cell(page, "alone", "a").locator("button").click();
  await page.locator(".cell-details summary").click();
  for (const [key, unit] of Object.entries(units))
    assert.equal(await page.locator(`.cell-details tr[data-row="${key}"] td`).first().innerText(), unit, key);
  assert.deepEqual(troubles, []);
});

test("arrow keys move in the matrix and Enter opens a cell", { skip }, async () => {
  const { page } = await pages.show(suite());
  await cell(page, "severity_1", "a").locator("button").focus();
  for (const key of ["ArrowDown", "ArrowRight", "Enter"]) await page.keyboard.press(key);
  assert.match(await page.locator(".cell-details h3").innerText(), /^severity_2, b$/);
  assert.equal(await page.locator('#matrix button.cell[tabindex="0"]').count(), 1);
});

test("the severity has a line per estimator, with intervals, over level and truth", { skip }, async () => {
  const { page, troubles } = await pages.show(suite());
  const chart = page.locator("#families figure.chart");
  const bars = chart.locator('g.bars[aria-description="a"] > line');
  assert.equal(await chart.locator("g.line > path").count(), 2);
  assert.equal(await bars.count(), 3);
  assert.equal(await chart.locator("g.cross > path").count(), 1);
  await chart.locator("svg[role=img]").focus();
  await page.keyboard.press("ArrowRight");
  assert.match(await chart.locator(".readout").innerText(), /^a: ATE yaw \[m\] 0\.0123 \[0\.00984, 0\.0160\] at severity \[step\] 1/);
  await page.locator("#families select").nth(2).selectOption("truth");
  assert.equal(await bars.count(), 2);
  await chart.getByRole("button", { name: "b", exact: true }).click();
  assert.equal(await chart.locator("g.line > path").count(), 1);
  assert.deepEqual(troubles, []);
});

test("a chart is saved as an SVG file that needs nothing of the page", { skip }, async () => {
  const { page, troubles } = await pages.show({ ...suite({ names: ["a", "b"] }), roc: detectors() }, { dark: true });
  for (const [place, texts] of [["#families", [">a</text>", ">b</text>", "ATE yaw [m]", "severity [step]"]], ["#roc", ["detection rate", "AUC 0.732"]]]) {
    const [download] = await Promise.all([page.waitForEvent("download"), page.locator(`${place} button.save`).click()]);
    assert.match(download.suggestedFilename(), /^[\w.-]+\.svg$/);
    const text = await readFile(await download.path(), "utf8");
    for (const each of texts) assert.ok(text.includes(each), each);
    assert.doesNotMatch(text, /var\(|color-mix|oklab|class=|<style/);
    assert.match(text, /^<svg xmlns="http:\/\/www\.w3\.org\/2000\/svg"[^>]* viewBox="0 0 \d/);
    assert.ok(text.includes('fill="#ffffff"') && text.includes('stroke="#2a24de"'), "the light colours");
    // It is a picture of its own.
    const size = await page.evaluate(async (source) => {
      const image = new Image();
      image.src = `data:image/svg+xml;base64,${btoa(unescape(encodeURIComponent(source)))}`;
      await image.decode();
      return [image.naturalWidth, image.naturalHeight];
    }, text);
    assert.ok(size[0] > 200 && size[1] > 200, `${size}`);
    if (process.env.AIMS_PAGE_ARTIFACTS) await writeFile(`${process.env.AIMS_PAGE_ARTIFACTS}/${download.suggestedFilename()}`, text);
  }
  assert.equal(await page.evaluate(() => document.documentElement.dataset.theme), "dark", "the page keeps its theme");
  assert.deepEqual(troubles, []);
});

test("ROC curves come with the areas under them", { skip }, async () => {
  const { page, troubles } = await pages.show({ ...suite(), roc: detectors() });
  assert.equal(await page.locator("#roc g.line > path").count(), 2);
  assert.equal(await page.locator('#roc tr[data-row="D"] td').first().getAttribute("data-value"), "0.7321");
  await page.locator("#roc").getByLabel("Degenerate below").selectOption("n10");
  assert.match(await page.locator("#roc .nothing").innerText(), /no curve/);
  assert.deepEqual(troubles, []);
});

test("consistency has NEES within its bounds, root mean squares and one run over time", { skip }, async () => {
  const { page, troubles } = await pages.show({ ...suite(), consistency: consistency() });
  const charts = page.locator("#consistency figure.chart");
  assert.equal(await charts.count(), 3);
  assert.match(await page.locator('#consistency tr[data-row="severity_1/a"]').innerText(), /3\s+1\.10\s*0\.600 to 1\.70\s+95\.0 %/);
  assert.equal(await charts.nth(0).locator("g.band > path").count(), 1);
  assert.equal(await charts.nth(0).locator("g.line > path").count(), 1, "bounds have no line");
  assert.equal(await charts.nth(1).locator("g.line > path").count(), 4);
  await charts.nth(2).locator("svg[role=img]").focus();
  await page.keyboard.press("ArrowRight");
  assert.match(await charts.nth(2).locator(".readout").innerText(), /^size of the error, seed 7: error along the weak axis \[m\] 0\.0100+ at/);
  await page.locator("#consistency select").selectOption("1");
  assert.equal(await charts.nth(1).locator("g.line > path").count(), 3, "no stated deviation");
  assert.deepEqual(troubles, []);
});

test("the paper's figures stand beside ours", { skip }, async () => {
  const { page, troubles } = await pages.show({ ...suite(), paper: paper() });
  const row = page.locator('#paper tr[data-row="loam"]');
  assert.match(await row.innerText(), /LOAM\s+0\/2\s+16\.32\s+– \(–\)/);
  assert.match(await page.locator('#paper tr[data-row="aims"]').innerText(), /0\.16\s+0\.01 \(0\.02\)/);
  assert.match(await page.locator('#paper tr[data-row="aims_d"]').innerText(), /^aims_d\s+–\s+2\/2\s+–\s+0\.00/);
  assert.match(await page.locator('#paper tr[data-row="m_end_m"]').innerText(), /−1\.00\s*−1\.00 to 0\.333/);
  assert.equal(await page.locator("#paper figure").count(), 1);
  assert.deepEqual(troubles, []);
});

test("before and after shows significant changes first", { skip }, async () => {
  const { page } = await pages.show({ ...suite(), compare: comparison() });
  const rows = page.locator("#compare tbody tr");
  assert.equal(await rows.count(), 2);
  assert.match(await rows.nth(0).innerText(), /▲ better/);
  assert.match(await rows.nth(0).innerText(), /−0\.130 to −0\.0900/);
  assert.match(await rows.nth(1).innerText(), /▼ worse/);
  await page.locator("#compare").getByLabel("Verdict").selectOption("all");
  assert.equal(await rows.count(), 3);
  assert.match(await page.locator("#compare").innerText(), /Only in new: 1/);
});

test("one scenario over its seeds leads with a sentence, its table and box plots", { skip }, async () => {
  const data = suite();
  const only = data.suite.scenarios.find((each) => each.name === "severity_3");
  Object.assign(data.suite, { scenarios: [only], families: [] });
  only.estimators.b.scores.m_end_m = { median: 30, worst: 40, count: 3 };
  data.runs = data.runs.filter((run) => run.scenario === "severity_3");
  const { page, troubles } = await pages.show({ ...data, title: "severity_3, seeds 1–3" });
  assert.match(await page.locator("[data-verdict]").innerText(), /^a keeps .*; b fails\. Over 3 seeds\./);
  assert.equal(await page.locator("#seeds g.quartiles > rect").count(), 2);
  assert.equal(await page.locator('#seeds g.dots[aria-description="a"] > circle').count(), 3);
  assert.equal(await page.locator('#seeds g.failed[aria-description="b"] > path').count(), 3, "seeds without success are crosses");
  // 0.01, 0.02 and 0.03 on a logarithmic axis: the quartiles lie half-way between neighbours.
  const middles = (of) => page.locator(`#seeds ${of}`).evaluateAll((all) => all.map((each) => {
    const { left, right } = each.getBoundingClientRect();
    return (left + right) / 2;
  }).sort((a, b) => a - b));
  const [low, , high] = await middles('g.dots[aria-description="a"] > circle');
  const box = await page.locator('#seeds g.quartiles[aria-description="a"] > rect').boundingBox();
  const at = (value) => low + ((high - low) * Math.log(value / 0.01)) / Math.log(3);
  assert.ok(Math.abs(box.x - at(0.015)) < 1.5 && Math.abs(box.x + box.width - at(0.025)) < 1.5, `${box.x}, ${box.width}`);
  await page.locator("#seeds svg[role=img]").focus();
  await page.keyboard.press("ArrowRight");
  assert.match(await page.locator("#seeds .readout").innerText(), /^a, seed 1: 0\.0100$/);
  assert.match(await page.locator('#seeds tr[data-row="b"]').innerText(), /✕/, "a median over no success is marked");
  assert.doesNotMatch(await page.locator('#seeds tr[data-row="a"]').innerText(), /✕/);
  assert.deepEqual(troubles, []);
});

test("an estimator that failed on every seed has a row and is counted apart", { skip }, async () => {
  const data = suite();
  const only = data.suite.scenarios.find((each) => each.name === "severity_3");
  const failures = only.seeds.map((seed) => ({ scenario: "severity_3", seed, estimator: "broken", message: "no such file" }));
  Object.assign(data.suite, { scenarios: [only], families: [], failures });
  data.runs = data.runs.filter((run) => run.scenario === "severity_3");
  const { page, troubles } = await pages.show(data);
  assert.match(await page.locator('#seeds tr[data-row="broken"]').innerText(), /failed on 3 of 3 seeds/);
  assert.match(await page.locator("body").innerText(), /estimators\s+2, and 1 that failed on every run/);
  assert.deepEqual(troubles, []);
});

test("successes have their interval, pairs of estimators a sign test over seeds", { skip }, async () => {
  const { page, troubles } = await pages.show(suite());
  await page.locator("#seeds").getByLabel("Scenario").selectOption("severity_3");
  assert.match(await page.locator('#seeds tr[data-row="a"]').innerText(), /3 of 3 \(44–100 %\)/);
  assert.match(await page.locator('#seeds tr[data-row="b"]').innerText(), /0 of 3 \(0–56 %\)/);
  assert.match(await page.locator('#pairs tr[data-row="a/b"]').innerText(), /^a, b\s+12\s+6\s+4\s+0\s+3, 0\s+0\.250\s+0\s+0\s+0, 0\s+1\.00$/);
  assert.deepEqual(troubles, []);
});

test("on a phone a matrix of four estimators needs no scrolling", { skip }, async () => {
  const data = suite();
  for (const { estimators } of data.suite.scenarios) Object.assign(estimators, { lio: estimators.a, leg: estimators.b });
  data.runs.forEach((run) => { run.href = null; });
  const { page } = await pages.show(data, { width: 420 });
  const [shown, inside] = await page.locator("#matrix .table-frame").evaluate((frame) => [frame.clientWidth, frame.scrollWidth]);
  assert.ok(inside <= shown + 1, `${inside} px in ${shown} px`);
});

test("hostile names stay names", { skip }, async () => {
  const names = [kHostile, "__proto__", "constructor", "x".repeat(300)];
  const data = { ...suite({ first: kHostile, names }), roc: detectors(kHostile), consistency: consistency(kHostile), paper: paper(kHostile, []), compare: comparison(kHostile), title: kHostile, notes: [kHostile] };
  data.suite.families[0].name = kHostile;
  const { page, troubles, ready } = await pages.show(data, { width: 390 });
  assert.equal(ready, "true");
  assert.equal(await page.evaluate(() => window.broken), undefined);
  assert.equal(await page.locator("#matrix tbody th").first().innerText(), kHostile);
  assert.equal(await page.locator("img").count(), 0);
  assert.equal(await overflows(page), false);
  assert.deepEqual(troubles, []);
});

test("an empty suite, one scenario and values that are none give a page", { skip }, async () => {
  const empty = suite();
  Object.assign(empty.suite, { scenarios: [], families: [], complete: false });
  empty.runs = [];
  const first = await pages.show(empty);
  assert.equal(first.ready, "true");
  assert.match(await first.page.locator("body").innerText(), /No scenario of this suite has a finished run yet/);
  const one = suite({ names: ["only"] });
  one.suite.families = [];
  for (const each of Object.values(one.suite.scenarios[0].estimators)) {
    for (const score of Object.values(each.scores)) Object.assign(score, { median: NaN, worst: NaN, median_low: NaN, median_high: NaN });
  }
  const second = await pages.show(one);
  assert.equal(second.ready, "true");
  assert.equal(await second.page.locator("#matrix tbody tr").count(), 1);
  assert.equal(await cell(second.page, "only", "a").locator(".value").innerText(), "–");
  assert.deepEqual([...first.troubles, ...second.troubles], []);
});

test("it fits 1280 and 390 pixels, light and dark", { skip }, async () => {
  for (const [width, dark] of [[1280, false], [1280, true], [390, false], [390, true]]) {
    const { page, troubles, context } = await pages.show({ ...suite(), roc: detectors(), consistency: consistency(), paper: paper(), compare: comparison() }, { width, dark });
    assert.equal(await overflows(page), false, `${width}`);
    assert.deepEqual(await needlessScrolls(page), []);
    await keepPicture(page, `suite-${width}-${dark ? "dark" : "light"}`);
    assert.deepEqual(troubles, []);
    await context.close();
  }
});
