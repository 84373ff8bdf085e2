// SPDX-License-Identifier: BSD-3-Clause
// The sentence of the result, errors over distance, the plan and the address, without a browser.
import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = path.resolve(process.env.AIMS_PAGE_MODULES ?? path.join(here, "../node_modules"));
let folder;
let page;

before(async () => {
  folder = await mkdtemp(path.join(os.tmpdir(), "aims-findings-"));
  const outfile = path.join(folder, "page.mjs");
  const { build } = createRequire(path.join(modules, "any.js"))("esbuild");
  const sources = ["findings", "run/errors", "run/findings_of", "run/layers", "run/plan", "run/series", "run/state_url", "run/camera3d", "run/results", "outcome"];
  await build({
    stdin: {
      contents: sources.map((name) => `export * from "./src/${name}";`).join("\n"),
      resolveDir: path.join(here, ".."),
    },
    nodePaths: [modules],
    bundle: true,
    format: "esm",
    logLevel: "error",
    loader: { ".css": "empty" },
    outfile,
  });
  page = await import(pathToFileURL(outfile).href);
});
after(() => rm(folder, { recursive: true }));

/** 100 m along x at 1 m/s; estimates are given by x, y at each second. */
function walk(estimates, returns = () => 500) {
  const t = Float32Array.from({ length: 101 }, (_, i) => i);
  return {
    scenario: { corridor: true },
    truth: { t, p: Float32Array.from([...t].flatMap((x) => [x, 0, 0])), q: null },
    localizability: { t, equivalent_returns: t.map(returns), degenerate: {} },
    estimators: Object.entries(estimates).map(([name, at], colour_index) => ({
      name, colour_index, diverged_at: null, series: { t, p: Float32Array.from([...t].flatMap((x) => [...at(x), 0])), q: null },
    })),
    scores: {
      estimators: Object.fromEntries(Object.entries(estimates).map(([name, at]) => {
        const percent = Math.hypot(...at(100)) - 100;
        return [name, {
          success: Math.abs(percent) < 5, m_list_percent: { all: Math.abs(percent) }, m_list_signed_percent: { "a-b": percent },
          health: { worst: "healthy" },
        }];
      })),
    },
  };
}

test("a turned estimate has no error once its heading is fitted", () => {
  const turned = walk({ a: (x) => [x * Math.cos(0.1), x * Math.sin(0.1)] });
  const path = page.truePath(turned);
  assert.equal(path.travelled[100], 100);
  const fitted = page.errorTrack(path, turned.estimators[0], "heading");
  assert.ok(Math.abs(fitted.turn + 0.1) < 1e-6, `${fitted.turn}`);
  assert.ok(Math.max(...fitted.error) < 1e-4);
  const raw = page.errorTrack(path, turned.estimators[0], "start");
  assert.ok(Math.abs(raw.error[100] - 2 * 100 * Math.sin(0.05)) < 1e-4, `${raw.error[100]}`);
});

test("a loss begins where the error stays", () => {
  const data = walk({ a: (x) => [x < 60 ? x : 60 + 0.4 * (x - 60), 0] });
  const loss = page.lossOf(page.errorTrack(page.truePath(data), data.estimators[0], "start"));
  assert.ok(Math.abs(loss.from - 61) <= 1, `${loss.from}`);
  assert.ok(Math.abs(loss.most - 24) < 1e-3);
  const back = walk({ a: (x) => [x, x > 40 && x < 50 ? 3 : 0] });
  assert.equal(page.lossOf(page.errorTrack(page.truePath(back), back.estimators[0], "start")), null);
});

test("an error of the scale is there throughout, whatever its size and however long it stays below the limit", () => {
  for (const [scale, side] of [[0.97, "3.0 % short"], [1.02, "2.0 % too long"], [1.04, "4.0 % too long"]]) {
    const data = walk({ a: (x) => [scale * x, 0] });
    const { list, route } = page.findingsOf(data);
    assert.match(page.finding(list, route), new RegExp(`a is ${side} throughout`));
  }
});

test("a loss in a part is not throughout", () => {
  const data = walk({ a: (x) => [x < 10 ? 0.7 * x : x - 3, 0], b: (x) => [(x < 20 ? 0.6 : 1) * x - (x < 20 ? 0 : 8), 0] });
  const { list, route } = page.findingsOf(data);
  assert.doesNotMatch(page.finding(list, route), /throughout/);
  const noisy = walk({ a: (x) => [0.98 * x, 0.05 * Math.sin(97 * x)] });
  assert.match(page.finding(...Object.values(page.findingsOf(noisy))), /a is 2\.0 % short throughout/);
});

test("over seeds, failed runs and parts of runs are named and leave the successes", () => {
  const each = { name: "z", success: true, percent: 0.001, worst: 0.002, signed: null, ate: 0.01, loss: null, aside: null, returns: null, healthy: false };
  const route = { corridor: true, length: Infinity };
  assert.equal(page.finding([{ ...each, fails: "1 of 6 seeds", missing: "failed to run on 1 of 6 seeds" }], route),
    "z keeps the corridor's length within 0.0010 % in the median and 0.0020 % at worst; z failed to run on 1 of 6 seeds.");
  const part = { ...each, name: "m", percent: null, ate: null, fails: "1 of 6 seeds", missing: "has a gap on 1 of 6 seeds", successes: 5 };
  assert.equal(page.finding([part], route), "m has a gap on 1 of 6 seeds and succeeds on 5.");
  assert.equal(page.finding([part, { ...each, percent: 2, worst: 3, fails: null }], route),
    "No estimator with poses of every run keeps the corridor's length within 1 %; z is 2.0 % off in the median; m has a gap on 1 of 6 seeds and succeeds on 5.");
  assert.match(page.finding([{ ...each, percent: 3, worst: 3, fails: "1 of 6 seeds", missing: "failed to run on 1 of 6 seeds" }], route),
    /z is 3\.0 % off in the median and failed to run on 1 of 6 seeds\.$/);
  assert.match(page.finding([{ ...part, success: false, missing: "failed to run on 5 of 6 seeds" }], route),
    /^No estimator succeeds on more than half of the seeds; m failed to run on 5 of 6 seeds\.$/);
  const off = { ...each, name: "o", success: false, percent: 19, worst: 20, fails: "3 of 3 seeds" };
  assert.match(page.finding([off], route), /o fails on 3 of 3 seeds, its length 19 % off in the median/);
});

test("a gap breaks the curve, is named as such, and is no loss", () => {
  const data = walk({ a: (x) => [x > 40 && x < 52 ? NaN : x, 0] });
  data.scores.estimators.a = { ...data.scores.estimators.a, success: false, diverged_reason: "gap" };
  const track = page.errorTrack(page.truePath(data), data.estimators[0], "start");
  assert.ok(Number.isNaN(track.error[45]) && track.error[60] < 1e-6);
  assert.ok(page.thin(track, 3).some((i) => Number.isNaN(track.error[i])));
  assert.equal(page.lossOf(track), null);
  assert.equal(page.missingText(data, "a"), "has no poses for 12 s, from 40 s on");
  const sparse = walk({ a: (x) => [x % 5 === 0 ? x : NaN, 0] });
  sparse.scores.estimators.a = { ...sparse.scores.estimators.a, partial: true };
  assert.equal(page.missingText(sparse, "a"), "has a pose every 5.0 s only");
  const { list, route } = page.findingsOf(data);
  assert.match(page.finding(list, route), /a has no poses for 12 s, from 40 s on\.$/);
  data.scores.estimators.a.diverged_reason = "error_limit";
  assert.equal(page.missingText(data, "a"), null);
});

test("a cursor in a gap has no value", () => {
  const track = { times: Float32Array.of(0, 1, 5, 9, 10), values: Float32Array.of(1, 2, NaN, 3, 4) };
  const at = (seconds) => page.valueAt(track, seconds);
  assert.deepEqual([at(0.4), at(1), at(1.5), at(5), at(8.9), at(9), at(9.4)], [1, 2, NaN, NaN, NaN, 3, 3]);
});

test("a break reaches over the stamps of other curves", () => {
  const [t, a, b] = page.align([
    { times: Float32Array.of(0, 1, 5, 9, 10), values: Float32Array.of(1, 1, NaN, 2, 2) },
    { times: Float32Array.of(0.5, 3, 7), values: Float32Array.of(4, 4, 4) },
  ]);
  assert.deepEqual([...t], [0, 0.5, 1, 3, 5, 7, 9, 10]);
  assert.deepEqual(a, [1, undefined, 1, null, null, null, 2, 2]);
  assert.deepEqual(b, [undefined, 4, undefined, 4, undefined, 4, undefined, undefined]);
});

test("the sentence names who keeps the length, who loses it where, and who does not notice", () => {
  const data = walk({
    good: (x) => [1.0002 * x, 0],
    lost: (x) => [x < 60 ? x : 60 + 0.4 * (x - 60), 0],
    short: (x) => [0.87 * x, 0],
  }, (x) => (x > 55 ? 3 : 500));
  const { list, route } = page.findingsOf(data);
  assert.match(
    page.finding(list, route),
    /^good keeps the corridor's length within 0\.02\d* %; lost loses 24 m from 6[01] s on \(after 6[01] m\), where the walls constrain nothing along the way, and calls itself healthy; short is 13 % short throughout, and calls itself healthy\.$/,
  );
});

test("those that fail are named while they are few", () => {
  const good = { name: "good", success: true, percent: 0.1, worst: null, signed: null, ate: 0.1, loss: null, aside: null, returns: null, healthy: true };
  const bad = (name) => ({ ...good, name, success: false, percent: 50, ate: 9 });
  const route = { corridor: true, length: 100 };
  assert.match(page.finding([good, bad("a"), bad("b"), bad("c")], route), /c fails, too\.$/);
  assert.match(page.finding([good, ..."abcd".split("").map(bad)], route), /c and d fail, too\.$/);
  assert.match(page.finding([good, ..."abcdef".split("").map(bad)], route), /4 more fail, too\.$/);
});

test("only those without success fail; of the others it is said what they miss", () => {
  const route = { corridor: true, length: 100 };
  const one = (name, percent, success) =>
    ({ name, success, percent, worst: null, signed: -1, ate: 0.1, loss: null, aside: null, returns: null, healthy: false });
  assert.equal(page.finding([one("own", 2, true)], route),
    "No estimator keeps the corridor's length within 1 %; own is 2.0 % short throughout.");
  assert.equal(page.finding([one("good", 0.1, true), one("a", 30, false), one("b", 20, false), one("c", 10, false), one("bad", 3.9, true)], route),
    "good keeps the corridor's length within 0.10 %; a is 30 % short throughout; b is 20 % short throughout; c fails, too; bad succeeds, more than 1 % off.");
  assert.equal(page.finding([one("p", 4, true), one("q", 3, true), one("r", 2, true)], route),
    "No estimator keeps the corridor's length within 1 %; p is 4.0 % short throughout; q is 3.0 % short throughout; r succeeds, more than 1 % off.");
  assert.match(page.finding([one("a", 0.5, false), one("b", 2, true)], route), /^No estimator that succeeds keeps the corridor's length within 1 %;/);
});

test("a mark names why an estimate is no success", () => {
  assert.equal(page.failureMark("error_limit", 12.6), "✕ at 13 s");
  assert.equal(page.failureMark("gap", 10), "✕ gap at 10 s");
  assert.equal(page.failureMark("ends_early", 10), "✕ ends at 10 s");
  assert.equal(page.failureMark("starts_late", 0), "✕ starts late", "not at the time that it lacks");
  assert.equal(page.failureMark("no_poses", null), "✕ no poses");
  assert.equal(page.failureMark("toString", null), "✕ diverged");
  assert.equal(page.failureCount(["error_limit", "error_limit"], 2, 4), "2 of 4 diverged");
  assert.equal(page.failureCount(["gap", "gap"], 2, 2), "2 of 2: gap");
  assert.equal(page.failureCount(["gap", "error_limit"], 2, 2), "2 of 2: 1 gap, 1 diverged");
});

test("an M_end that is much larger than the ATE of the best is explained", () => {
  const row = (name, ate_yaw_m, m_end_m, success = true) => ({ name, scores: { ate_yaw_m, m_end_m, success } });
  assert.match(page.endNote([row("a", 0.02, 0.4), row("b", 0.1, 0.1)]), /M_end of a is much larger than its ATE yaw, since the first pose .* mounting yaw/);
  assert.equal(page.endNote([row("a", 0.02, 0.05)]), "");
  assert.equal(page.endNote([row("a", 0.02, 0.4, false)]), "");
  assert.equal(page.endNote([]), "");
});

test("an estimate that leaves the plan is named, though it comes back", () => {
  const extent = { min: [0, -1], max: [80, 1] };
  const line = (...p) => ({ track: { p, error: p.filter((_, i) => i % 3 === 0) } });
  assert.ok(page.isBeyond(extent, line(1, 0, 0, 90, 0, 0, 2, 0, 0)));
  assert.ok(!page.isBeyond(extent, line(1, 0, 0, NaN, NaN, NaN, 2, 0, 0)));
});

test("a failure in height or sideways is named, though the length is right", () => {
  const route = { corridor: true, length: 100 };
  const one = { success: false, worst: null, signed: -0.96, ate: 3, loss: null, returns: null, healthy: false };
  const falling = { ...one, name: "falling", percent: 0.96, aside: { direction: "height", most: 8.8 } };
  assert.equal(page.finding([falling], route),
    "No estimator succeeds; falling is up to 8.8 m off in height, its length by 0.96 %.");
  const turned = { ...one, name: "turned", percent: null, aside: { direction: "sideways", most: 3.1 } };
  assert.equal(page.finding([turned], route),
    "No estimator stays near the truth from its start on; turned is up to 3.1 m off sideways.");
  const data = walk({ up: (x) => [x, 0] });
  data.scores.estimators.up.drift_m = { rmse: { longitudinal: 0.1, lateral: 0.2, vertical: 4 } };
  data.scores.estimators.up.max_error_z_m = 8.8;
  assert.deepEqual(page.findingsOf(data).list[0].aside, { direction: "height", most: 8.8 });
});

test("over several seeds the sentence names median and worst, and separates by either", () => {
  const route = { corridor: true, length: Infinity };
  const one = { success: true, signed: null, ate: 0.1, loss: null, aside: null, returns: null, healthy: false };
  const a = { ...one, name: "a", percent: 0.12, worst: 0.21 };
  assert.equal(page.finding([a, { ...one, name: "b", percent: 0.2, worst: 0.3 }], route),
    "a and b both keep the corridor's length within 0.20 % in the median and 0.30 % at worst: these runs do not separate them by it.");
  assert.equal(page.finding([a, { ...one, name: "b", percent: 0.2, worst: 0.62 }], route),
    "a keeps the corridor's length within 0.12 % in the median and 0.21 % at worst, b within 0.20 % in the median and 0.62 % at worst.");
  assert.equal(page.finding([{ ...a, name: "b", fails: "2 of 5 seeds" }, { ...a, percent: 0.2 }], route),
    "a and b keep the corridor's length within 0.20 % in the median and 0.21 % at worst; b fails on 2 of 5 seeds.");
});

test("where nothing differs the sentence says so", () => {
  const data = walk({ a: (x) => [1.0002 * x, 0], b: (x) => [1.0003 * x, 0] });
  const { list, route } = page.findingsOf(data);
  assert.match(page.finding(list, route), /^a and b both keep the corridor's length within 0\.030 %: this run does not separate them by it\.$/);
  assert.equal(page.finding([], route), "");
});

test("of curves on each other the worst is below and the widest", () => {
  const item = (name, most) => ({ name, track: { error: [0, most] } });
  const layers = page.layered([item("good", 0.1), item("lost", 29), item("alike", 0.1)]);
  assert.deepEqual(layers.map(({ item: { name } }) => name), ["lost", "alike", "good"]);
  assert.ok(layers[0].width > layers[1].width && layers[1].width > layers[2].width && layers[2].width >= 1);
  assert.ok(page.layered(Array.from({ length: 20 }, (_, i) => item(`${i}`, i)))[0].width < 8, "also of many");
});

test("the plan of a corridor fills its height, that of a square keeps its scale", () => {
  const corridor = page.planFrame({ min: [0, -1.5], max: [80, 1.5] }, 1300);
  assert.ok(corridor.height >= 150 && corridor.stretch > 2, `${corridor.height} ${corridor.stretch}`);
  const square = page.planFrame({ min: [0, 0], max: [30, 30] }, 1300);
  assert.equal(square.stretch, 1);
  const metre = (axis, size) => (axis.at(1) - axis.at(0)) * size;
  assert.ok(Math.abs(metre(square.long, 1300) - metre(square.across, square.height)) < 1e-9);
});

test("a flat view of a corridor stretches across, up to a limit, and not when told so", () => {
  const sides = page.flatSides(80, 4, 2.5, true);
  assert.ok(Math.abs(sides.y - 2) < 1e-12 && Math.abs(sides.x - 40) < 1e-12);
  assert.ok(Math.abs(sides.stretch - 8) < 1e-12, `${sides.stretch}`);
  assert.equal(page.flatSides(80, 4, 2.5, false).stretch, 1);
  assert.equal(page.flatSides(80, 0.1, 2.5, true).stretch, 12);
  assert.equal(page.flatSides(10, 40, 2.5, true).stretch, 1);
});

test("the state survives its address, and what is unknown is left out", () => {
  const data = walk({ a: (x) => [x, 0], "b&c=d": (x) => [x, 0] });
  const first = { cursor: 1, from: 0, to: 9, chosen: 0, level: "n100", coloring: "height", scanColoring: "intensity",
    ceiling: false, errorScale: "chosen", hidden: new Set(), alignment: "heading", tab: "errors", preset: "orbit", follow: false };
  assert.equal(page.hashOf(first, first, data), "");
  const state = { ...first, cursor: 2.5, from: 1, to: 4, chosen: 1, hidden: new Set([1]), tab: "internals", preset: "top", ceiling: true };
  assert.deepEqual({ ...first, ...page.stateIn(`#${page.hashOf(state, first, data)}`, data) }, state);
  assert.deepEqual(page.stateIn("#preset=nowhere&estimator=x&from=5&to=1&cursor=abc&hide=", data), {});
});
