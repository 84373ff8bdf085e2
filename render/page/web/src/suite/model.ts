// SPDX-License-Identifier: BSD-3-Clause
/** The suite page's data, and functions on it. */
import type { ListedScore, Maybe, Numbers, PagePayload, Picture } from "../contract";
import { own } from "../dom";
import { isNumber } from "../format";
import { scoreAt } from "../scores";

export interface ScoreSummary {
  median: Maybe;
  worst: Maybe;
  count: number;
  median_low?: Maybe;
  median_high?: Maybe;
}

export interface EstimatorSummary {
  runs: number;
  successes: number;
  success_rate: Maybe;
  /** Wilson's interval, 95 %. */
  success_low?: Maybe;
  success_high?: Maybe;
  successes_1_percent?: number;
  scores: Record<string, ScoreSummary>;
}

/** A limit and what was measured; without an estimator it is of the run itself. */
export interface Expectation {
  estimator: string;
  score: string;
  statistic: string;
  max: Maybe;
  min: Maybe;
  value: Maybe;
  holds: boolean;
}

/** A run that no statistic holds. */
export interface InvalidRun {
  seed: number;
  reason: string;
}

export interface SuiteScenario {
  name: string;
  tags?: string[];
  family?: string;
  level?: Maybe;
  level_unit?: string;
  seeds: number[];
  invalid?: InvalidRun[];
  expectations?: Expectation[];
  estimators: Record<string, EstimatorSummary>;
}

/** The successes of two estimators on the sequences that both ran. */
export interface SuccessPair {
  first: string;
  second: string;
  sequences: number;
  seeds: number;
  /** Per limit: sequences on which one alone succeeds, seeds on which one succeeds on more, sign test over seeds. */
  tests: Record<string, { only_first: number; only_second: number; seeds_first: number; seeds_second: number; p: number }>;
}

export interface FamilyPoint {
  level: number;
  ate_yaw_m?: Maybe;
  ate_yaw_low_m?: Maybe;
  ate_yaw_high_m?: Maybe;
  m_list_percent: Maybe;
  m_list_low_percent: Maybe;
  m_list_high_percent: Maybe;
  success_rate: Maybe;
  success_low?: Maybe;
  success_high?: Maybe;
  runs: number;
  /** Of some run the estimate lacks a part. */
  partial?: boolean;
}

export interface Family {
  name: string;
  level_unit: string;
  mildest_level: number;
  /** Levels that the seeds do not tell apart from it; null: too few seeds. */
  alike_levels?: number[] | null;
  median_equivalent_returns?: Maybe[];
  estimators: Record<string, { breaks_at: number[]; points: FamilyPoint[] }>;
}

export interface Run {
  scenario: string;
  seed: number;
  href: string | null;
  /** Why the run is invalid; null when it is valid. */
  invalid?: string | null;
  /** Estimators whose estimate lacks a part of the run, or that failed on it (`is_partial`). */
  partial: string[];
  estimators: Record<string, Record<string, Maybe | boolean | string>>;
}

export interface RocScore {
  scenario: string | null;
  level: string;
  index: string;
  runs: number;
  scans: number;
  degenerate: number;
  auc: Maybe;
  auc_low: Maybe;
  auc_high: Maybe;
  detections: Maybe;
  onsets: number;
  missed: number;
  median_delay_s: Maybe;
  /** False-alarm and detection rate, alternating. */
  curve: Float32Array;
}

export interface Detectors {
  estimator: string;
  false_alarms: number;
  equivalent_returns_below: Record<string, number>;
  indices: Record<string, { degenerate_when: string; source: string }>;
  runs: unknown[];
  scores: RocScore[];
  warnings?: string[];
}

/** One estimator on one scenario; arrays by the names of consistency.json. */
export interface ConsistencyCase {
  scenario: string;
  estimator: string;
  runs: number;
  inside_fraction: Maybe;
  above_fraction: Maybe;
  mean_nees: Maybe;
  mean_nees_interval: [Maybe, Maybe];
  two_sigma: { fraction: Maybe };
  error_rms_m: Maybe;
  efficiency: Maybe;
  series: Record<string, Numbers>;
  example: { seed: number; series: Record<string, Numbers> } | null;
}

export interface ScoreChange {
  scenario: string;
  estimator: string;
  score: string;
  seeds: number;
  before: Maybe;
  after: Maybe;
  change: Maybe;
  change_low: Maybe;
  change_high: Maybe;
  verdict: string;
  false_alarm: Maybe;
}

export interface Comparison {
  before: string;
  after: string;
  summary?: string;
  /** What differs beside the results: settings, sequences, estimators of one label. */
  differs?: string;
  changes: ScoreChange[];
  /** Runs on which an estimator fails on one side alone; older results do not say. */
  fails_now?: string[];
  fails_no_more?: string[];
  partial?: string[];
  only_before: string[];
  only_after: string[];
}

/** A score of a system in the paper and here. */
export interface PaperScore {
  paper: Maybe;
  median: Maybe;
  worst: Maybe;
  values: Maybe[];
}

export interface PaperSystem {
  estimator: string;
  /** Its name in the paper; null when it is not there. */
  method: string | null;
  runs: number;
  successes: number;
  scores: PaperScore[];
}

/** A column, and how far both orders of the systems agree in it. */
export interface PaperColumn {
  key: string;
  title: string;
  systems: number;
  tau: Maybe;
  tau_low: Maybe;
  tau_high: Maybe;
}

export interface PaperExperiment {
  scenario: string;
  title: string;
  seeds: number[];
  columns: PaperColumn[];
  systems: PaperSystem[];
}

export interface Paper {
  experiments: PaperExperiment[];
  pictures?: Picture[];
}

/** benchmark.json: a public data set, scored as its authors score it. */
export interface Benchmark {
  title: string;
  citation?: string;
  url?: string;
  licence?: string;
  score: string;
  unit: string;
  score_text?: string;
  better?: string;
  published_source?: string;
  notes?: string[];
  sequences: { name: string; truth_text?: string; lack?: string; notes?: string[]; ours: Record<string, Maybe>; published: Record<string, Maybe> }[];
}

/** A scenario that could not be loaded, or estimators (a list of labels) that failed on one of its sequences. */
export interface RunFailure {
  scenario?: string;
  seed?: Maybe;
  estimator?: string;
  message?: string;
}

export interface SuitePayload extends PagePayload {
  kind: "suite";
  description?: string | null;
  /** Does the one scenario follow a corridor? */
  corridor?: boolean;
  /** Index in the palette of each estimator's style. */
  styles?: Record<string, number>;
  suite: {
    code?: string;
    complete?: boolean;
    interval?: string;
    scenarios: SuiteScenario[];
    families?: Family[];
    success_pairs?: SuccessPair[];
    failures?: RunFailure[];
    /** "key=value" on top of every scenario. */
    settings?: string[];
  };
  score_list: ListedScore[];
  /** Keys of the scores that lead. */
  headline: string[];
  runs: Run[];
  roc: Detectors | null;
  consistency?: { cases: ConsistencyCase[] } | null;
  compare: Comparison | null;
  paper?: Paper | null;
  benchmark?: Benchmark | null;
  notes?: string[];
}

/** Fraction of successful runs; no score of scores.json, but shown like one. */
export const kSuccessRate = "success rate";

/** Every estimator of the suite, in the order in which they appear. */
export function estimatorsOf(data: SuitePayload): string[] {
  const names = new Set<string>();
  for (const scenario of data.suite.scenarios) {
    for (const name of Object.keys(scenario.estimators)) names.add(name);
  }
  return [...names];
}

/** Index in the palette of an estimator's style. */
export function styleOf(data: SuitePayload, name: string): number {
  return own<number>(data.styles, name) ?? estimatorsOf(data).indexOf(name);
}

/** The score that is shown first: that of a benchmark, else the heading-aligned ATE where there is one. */
export function firstScore(data: SuitePayload): string {
  if (data.benchmark) return data.benchmark.score;
  return ["ate_yaw_m", "ate_m"].find((key) => data.headline.includes(key)) ?? data.headline[0] ?? "";
}

/** Every score of the suite. */
export function scoreKeysOf(data: SuitePayload): string[] {
  const keys = new Set<string>();
  for (const scenario of data.suite.scenarios) {
    for (const each of Object.values(scenario.estimators)) {
      for (const key of Object.keys(each.scores ?? {})) keys.add(key);
    }
  }
  return [...keys];
}

/** A score as the page shows it: the title of one that is not a headline score is its key. */
export function scoreOf(data: SuitePayload, key: string): ListedScore {
  if (key === kSuccessRate) return { key, title: "success", unit: "fraction of runs", better: "larger" };
  const listed = scoreAt(data.score_list, key);
  const title = data.headline.includes(key) ? listed?.title : key;
  return { key, title: title ?? key, unit: listed?.unit ?? "", better: listed?.better ?? "smaller" };
}

/** The scores that lead. */
export function headlineOf(data: SuitePayload): ListedScore[] {
  return data.headline.map((key) => scoreOf(data, key));
}

/** "ATE yaw [m]". */
export function labelOf({ title, unit }: ListedScore): string {
  return unit ? `${title} [${unit}]` : title;
}

export function summaryOf(scenario: SuiteScenario, estimator: string): EstimatorSummary | undefined {
  return own<EstimatorSummary>(scenario.estimators, estimator);
}

/** What a cell shows: the statistic of the score, or the success rate. */
export function valueOf(
  scenario: SuiteScenario, estimator: string, score: string, statistic: "median" | "worst"
): Maybe {
  const summary = summaryOf(scenario, estimator);
  if (!summary) return null;
  if (score === kSuccessRate) return isNumber(summary.success_rate) ? summary.success_rate : null;
  const value = own<ScoreSummary>(summary.scores, score)?.[statistic];
  return isNumber(value) ? value : null;
}

/** Why an estimator did not succeed, of each valid run on which it did not. */
export function reasonsOf(data: SuitePayload, scenario: string, estimator: string): unknown[] {
  return runsOf(data, scenario).filter((run) => !run.invalid).flatMap((run) => {
    const found = own<Run["estimators"][string]>(run.estimators, estimator);
    if (!found && failedOn(data, scenario, run.seed).includes(estimator)) return ["failed"];
    return found?.["success"] === false ? [found["diverged_reason"]] : [];
  });
}

/** Whether none of its estimates leaves a part of a run out, so that its scores are of all that those of others are. */
export function isWhole(data: SuitePayload, scenario: string, estimator: string): boolean {
  return runsOf(data, scenario).every((run) => !run.partial.includes(estimator));
}

/** Whether it is of an invalid run, which says nothing of its estimators. */
export function isOfInvalidRun(data: SuitePayload, failure: RunFailure): boolean {
  return data.runs.some((run) => run.invalid && run.scenario === failure.scenario && run.seed === failure.seed);
}

/** The failures but for those of invalid runs. */
export function failuresOf(data: SuitePayload): RunFailure[] {
  return (data.suite.failures ?? []).filter((each) => !isOfInvalidRun(data, each));
}

/** Estimators that failed to run on a valid seed of a scenario. */
export function failedOn(data: SuitePayload, scenario: string, seed: number): string[] {
  return failuresOf(data).filter((each) => each.scenario === scenario && each.seed === seed)
    .flatMap((each) => (each.estimator ?? "").split(", ")).filter((name) => name !== "");
}

/** Pages and scores of that scenario's runs, by seed. */
export function runsOf(data: SuitePayload, scenario: string): Run[] {
  return data.runs.filter((run) => run.scenario === scenario);
}
