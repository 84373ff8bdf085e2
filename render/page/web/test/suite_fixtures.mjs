// SPDX-License-Identifier: BSD-3-Clause
// Made-up suites and sweeps, as the C++ side hands them to a page.

import { kScoreList } from "./score_list.mjs";

export const kHostile = `</script><script>window.broken=1</script><img src=x onerror="window.broken=1">`;

const kHeadline = ["m_list_percent.all", "m_end_m", "ate_m", "max_error_z_m"];

function score(median, count = 3) {
  return { median, worst: median === null ? null : 2 * median, count, median_low: median === null ? null : 0.8 * median, median_high: median === null ? null : 1.3 * median };
}

function estimator(ate, successes = 3, runs = 3) {
  return {
    runs, successes, success_rate: successes / runs, success_low: successes === runs ? 0.438 : 0, success_high: successes === runs ? 1 : 0.562,
    scores: {
      success: { median: successes === runs ? 1 : 0, worst: 1, count: runs }, "m_list_percent.all": score(ate === null ? null : 2 * ate),
      m_end_m: score(ate), ate_m: score(ate), max_error_z_m: score(null, 0),
    },
  };
}

function point(level, each) {
  const { median: ate, median_low: low, median_high: high } = each.scores.ate_m;
  return { level, ate_yaw_m: ate, ate_yaw_low_m: low, ate_yaw_high_m: high, m_list_percent: null, m_list_low_percent: null,
    m_list_high_percent: null, success_rate: each.success_rate, runs: each.runs };
}

/** Three levels of a severity and one scenario of no family; `b` diverges at the last level. */
export function suite({ first = "a", names = ["severity_1", "severity_2", "severity_3", "alone"] } = {}) {
  const scenarios = names.map((name, i) => ({
    name, tags: i < 3 ? ["severity"] : ["other"], family: i < 3 ? "severity" : "", level: i < 3 ? i + 1 : null, level_unit: i < 3 ? "step" : "",
    seeds: [1, 2, 3], invalid: [],
    expectations: [{ estimator: first, score: "ate_m", statistic: "worst", max: 0.1, min: null, value: 0.02 * (i + 1), seeds: [1], holds: i < 3 }],
    estimators: { [first]: estimator(0.0123 * (i + 1)), b: estimator(i === 2 ? null : 0.05 * (i + 1), i === 2 ? 0 : 3) },
  }));
  const levels = (name) => scenarios.slice(0, 3).map((each, i) => point(i + 1, each.estimators[name]));
  const runs = scenarios.flatMap((each) => each.seeds.map((seed) => ({
    scenario: each.name, seed, href: seed === 1 ? `runs/${encodeURIComponent(each.name)}/seed-1/page.html` : null,
    partial: [],
    estimators: {
      [first]: { success: true, diverged_at_s: null, diverged_reason: "", ate_m: 0.01 * seed, m_end_m: 0.02 },
      b: { success: each !== scenarios[2], diverged_at_s: each === scenarios[2] ? 12.5 : null, diverged_reason: "error_limit", ate_m: 0.5 },
    },
  })));
  return {
    schema: "aims.page/2", kind: "suite", title: "Suite made up", version: "0.1.0", score_list: kScoreList, headline: kHeadline, runs, roc: null, compare: null, notes: [],
    suite: {
      schema: "aims.suite/1", version: "0.1.0", code: "0123456789abcdef", complete: true, scenarios, failures: [],
      success_pairs: [{ first, second: "b", sequences: 12, seeds: 6, tests: { success: { only_first: 4, only_second: 0, seeds_first: 3, seeds_second: 0, p: 0.25 },
        success_1_percent: { only_first: 0, only_second: 0, seeds_first: 0, seeds_second: 0, p: 1 } } }],
      families: [{ name: "severity", level_unit: "step", mildest_level: 1, median_equivalent_returns: [900, 80, null],
        estimators: { [first]: { breaks_at: [3], points: levels(first) }, b: { breaks_at: [], points: levels("b") } } }],
    },
  };
}

/** The run of that seed, on which `name` ends with that outcome, which lacks a part of the run; without one it failed. */
export function lackPart(data, seed, name, outcome) {
  const run = data.runs.find((each) => each.seed === seed);
  run.partial = [...run.partial, name];
  if (outcome) run.estimators[name] = { success: false, ...outcome };
  else delete run.estimators[name];
  return run;
}

/** Two indices at two levels, one of them without a curve. */
/** A consistency study of two estimators; the second states no covariance. */
export function consistency(name = "a") {
  const t = Float32Array.from({ length: 20 }, (_, i) => i + 1);
  const flat = (value) => t.map(() => value);
  const one = (estimator, sigma) => ({
    scenario: "severity_1", estimator, runs: 3, inside_fraction: 0.95, above_fraction: 0, mean_nees: 1.1, mean_nees_interval: [0.6, 1.7],
    two_sigma: { fraction: 0.96 }, error_rms_m: 0.02, efficiency: 0.5,
    series: {
      t_s: t, nees: flat(sigma ? 1.1 : NaN), nees_low: flat(sigma ? 0.07 : NaN), nees_high: flat(sigma ? 3.1 : NaN),
      error_rms_m: t.map((each) => 0.001 * each), sigma_rms_m: flat(sigma), bound_rms_m: flat(0.001), leg_bound_rms_m: flat(0.1),
    },
    example: { seed: 7, series: { t_s: t, error_m: t.map((each) => (each % 2 ? -0.01 : 0.01)), two_sigma_m: flat(2 * sigma) } },
  });
  return { schema: "aims.consistency/2", cases: [one(name, 0.01), one("leg", NaN)] };
}

export function detectors(name = "D") {
  const curve = new Float32Array([0, 0, 0, 0.4, 0.2, 0.7, 1, 1]);
  const entry = (index, level, auc) => ({
    scenario: null, level, index, runs: 4, scans: 1000, degenerate: auc === null ? 0 : 200, auc, auc_low: auc === null ? null : auc - 0.1,
    auc_high: auc === null ? null : auc + 0.05, threshold: 0.2, detections: auc === null ? null : 0.4, onsets: 2, missed: 1,
    median_delay_s: null, curve: auc === null ? new Float32Array(0) : curve,
  });
  return {
    schema: "aims.detectors/1", estimator: "a", false_alarms: 0.05, equivalent_returns_below: { n10: 10, n100: 100 },
    indices: { [name]: { degenerate_when: "high", source: "" }, C_IL: { degenerate_when: "high", source: "" } }, runs: [{}, {}], warnings: [],
    scores: [entry(name, "n100", 0.7321), entry("C_IL", "n100", 0.5), entry(name, "n10", null), entry("C_IL", "n10", null)],
  };
}

export function comparison(scenario = "severity_1") {
  const change = (score, verdict, value, low, high) => ({ scenario, estimator: "a", score, seeds: 6, before: 0.2, after: 0.2 + value, change: value,
    change_low: low, change_high: high, verdict, false_alarm: 0.125 });
  return {
    schema: "aims.compare/3", before: "old", after: "new", summary: "3 scores compared.", only_before: [], only_after: ["alone, b, seed 4"],
    changes: [change("ate_m", "better", -0.11, -0.13, -0.09), change("m_end_m", "none", 0.001, -0.02, 0.03), change("success", "worse", -0.5, -0.9, -0.1)],
  };
}

/** The paper's first table with two systems of it and one that it does not have. */
export function paper(name = "loam", pictures = [{ name: "p", title: "corridor: maps", png: "iVBORw0KGgo=" }]) {
  const score = (paper, median) => ({ paper, median, worst: median === null ? null : 2 * median, values: [median] });
  const columns = [{ key: "m_end_m", title: "M_end [m]", systems: 2, tau: -1, tau_low: -1, tau_high: 0.3333 }];
  const systems = [
    { estimator: name, method: "LOAM", runs: 2, successes: 0, scores: [score(16.32, null)] },
    { estimator: "aims", method: "Proposed method", runs: 2, successes: 2, scores: [score(0.16, 0.012)] },
    { estimator: "aims_d", method: null, runs: 2, successes: 2, scores: [score(null, 0.004)] },
  ];
  return { experiments: [{ scenario: "corridor", title: "Table I, corridor", seeds: [1, 2], columns, systems }], pictures };
}

/** A sweep over a grid of 4 x 3 values, on one or two scenarios and two seeds; score falls with the first parameter. */
export function tuning({ parameter = "degeneracy.eta", scenarios = ["corridor", "garage"] } = {}) {
  const parameters = [
    { name: parameter, unit: "-", meaning: "sensitivity", low: 0, high: 6, log: false, default: 3 },
    { name: "degeneracy.kappa", unit: "-", meaning: "", low: 1, high: 100, log: true, default: 12.6 },
  ];
  const sequences = scenarios.flatMap((scenario) => [1, 2].map((seed) => ({ scenario, family: scenario, seed })));
  const grid = [0, 2, 4, 6].flatMap((x) => [1, 10, 100].map((y) => [x, y]));
  const points = [[3, 12.6], ...grid];
  const value = ([x, y]) => 1 - 0.1 * x + 0.05 * Math.log10(y);
  const rows = points.flatMap((each, k) => sequences.map((_, w) => ({ k, w, diverged: k === 1 && w === 0, score: k === 1 && w === 0 ? NaN : value(each) * (1 + w) })));
  const column = (pick) => rows.map(pick);
  const measured = (first, members, y) => ({ x: Float32Array.from(members, (each) => each[first]), ...y,
    value: Float32Array.from(members, value), low: Float32Array.from(members, (each) => 0.9 * value(each)), high: Float32Array.from(members, (each) => 1.1 * value(each)) });
  const slice = (first, held, members) => ({ first, family: "", held, held_at: [4, 10], measured: measured(first, members, {}), fit: null });
  const analysis = {
    score: "ate_m", objective: "median of ate_m; a diverged run counts 10", axis: "objective: ate_m [m]", objectives: Float32Array.from(points, value),
    held_out: null, relative: false, points: 12, seeds: 2, incomplete: 0,
    standing: "best",
    effect: "The objective lies between 0.4 and 1.1 at the 12 points (175 %), beyond the scatter of seeds (p = 0.005).",
    best: { is_default: false, without_effect: [false, false], values: [6, 1], text: `${parameter} 6.00 instead of 3.00`, between: [[4, 6], [1, 10]], objective: 0.4, objective_interval: [0.38, 0.44], defaults: 0.755, gain: 0.47,
      gain_interval: [0.4, 0.5], distance: [0.5, -0.55] },
    sensitivity: { points: 12, logarithmic: true, of_grid: true, has_indices: true, resolved: true, least_explained: 0.9, fit: { terms: 4, error: 0.05, explained: 0.97 }, first: [0.88, 0.02], total: [0.95, 0.04],
      total_interval: [[0.9, 0.98], [0.01, 0.049]], second: [[0, 0.02], [0.02, 0]], negligible: [false, true] },
    curves: [slice(0, "degeneracy.kappa = 10 (default 12.6)", grid.filter(([, y]) => y === 10)),
      slice(1, `${parameter} = 4 (default 3)`, grid.filter(([x]) => x === 4))],
    maps: [{ first: 0, second: 1, family: "", held: "", held_at: [4, 10], measured: measured(0, grid, { y: Float32Array.from(grid, ([, y]) => y) }), fit: null }],
  };
  return {
    schema: "aims.page/2", kind: "tuning", title: "Sweep made up", source: "sweep", plan: `over: ["${parameter}=0:6:4"]\n`,
    jobs: { total: 60, done: rows.length - 1, failed: 1, crashed: 0, timed_out: 0, missing: 60 - rows.length, others: 0 },
    held_out_jobs: { total: 0, done: 0 }, scores: ["ate_m", "m_end_m"], sequences, notes: [],
    estimators: [{
      name: "aims", parameters,
      points: { values: Float32Array.from(points.flat()), untuned: Uint8Array.from(points, (_, k) => (k === 0 ? 1 : 0)), generation: null },
      rows: {
        point: Float32Array.from(column((row) => row.k)), sequence: Float32Array.from(column((row) => row.w)), outcome: Uint8Array.from(column((row) => (row.diverged ? 1 : 0))),
        diverged: Uint8Array.from(column((row) => (row.diverged ? 1 : 0))), held_out: new Uint8Array(rows.length),
        compared: new Uint8Array(rows.length).fill(1),
        scores: Float32Array.from(rows.flatMap((row) => [row.score, row.score / 2])),
      },
      analyses: [analysis],
    }],
  };
}
