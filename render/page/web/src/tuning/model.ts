// SPDX-License-Identifier: BSD-3-Clause
/** The tuning page's data, and functions on it. */
import type { Maybe, Numbers, PagePayload } from "../contract";
import { isNumber } from "../format";

export type Interval = [Maybe, Maybe];

export interface Parameter {
  name: string;
  unit: string;
  meaning?: string;
  low: number;
  high: number;
  log: boolean;
  default: number;
}

export interface Best {
  values: number[];
  /** No point is better than the defaults. */
  is_default: boolean;
  /** Of each parameter: points that differ in it alone have the same scores. */
  without_effect: boolean[];
  /** The values beside the defaults, and which lies at an edge of its range. */
  text: string;
  between: Interval[];
  objective: Maybe;
  objective_interval: Interval;
  defaults: Maybe;
  gain: Maybe;
  gain_interval: Interval;
  /** Every run with the defaults: there is no gain. */
  defaults_diverged: boolean;
  /** Best minus default, in widths of the range. */
  distance: number[];
}

export interface Sensitivity {
  points: number;
  logarithmic: boolean;
  /** By an analysis of variance of a complete grid; else by a fit. */
  of_grid: boolean;
  /** By an analysis of variance of a part of a grid. */
  of_part?: { explained: number; with_pairs: boolean };
  /** From a grid or a fit. */
  has_indices: boolean;
  /** And the effect of all parameters is beyond the scatter of seeds. */
  resolved: boolean;
  /** Cross-validated R² from which on a fit supports indices. */
  least_explained: number;
  fit: { terms: number; error: number; explained: number } | null;
  first: number[];
  total: number[];
  total_interval: Interval[];
  second: number[][];
  negligible: boolean[];
}

export interface SlicePoints {
  x: Numbers;
  y?: Numbers;
  value: Numbers;
  low: Numbers;
  high: Numbers;
}

/** The objective along one parameter, or over two; the others held where `held` says. */
export interface Slice {
  first: number;
  second?: number;
  /** "": all scenarios. */
  family: string;
  held: string;
  /** A value per parameter; of those that vary, without meaning. */
  held_at: number[];
  measured: SlicePoints | null;
  fit: SlicePoints | null;
}

/** What the held-out sequences say of the best point. */
export interface HeldOut {
  verdict: "use" | "do not use" | "undecided";
  text: string;
  sequences: number;
  gain: Maybe;
  gain_interval: Interval;
  p: number;
}

export interface Analysis {
  score: string;
  objective: string;
  /** Label of the objective's axis, with its unit. */
  axis: string;
  relative: boolean;
  points: number;
  seeds: number;
  incomplete: number;
  /** Of each of the estimator's points; NaN while sequences are missing. */
  objectives: Numbers;
  best: Best | null;
  /** How much the objective differs between points, and whether that is beyond the scatter of seeds. */
  effect?: string;
  why_no_best?: string;
  held_out: HeldOut | null;
  /** What the best point is: "best", "least: keep the defaults", "least, not resolved" or the like. */
  standing: string;
  /** Why it is not resolved although points differ; empty else. */
  unresolved?: string;
  sensitivity: Sensitivity | null;
  why_no_sensitivity?: string;
  curves: Slice[];
  maps: Slice[];
}

export interface Sequence {
  scenario: string;
  family: string;
  seed: number;
}

export interface TunedEstimator {
  name: string;
  parameters: Parameter[];
  points: { values: Numbers; untuned: Uint8Array; generation: Numbers | null };
  /** A job each: point, sequence, outcome (0 done, 1 failed, 2 crashed, 3 timed out, 4 invalid run), scores, job by job. */
  rows: {
    point: Numbers; sequence: Numbers; outcome: Uint8Array; diverged: Uint8Array; held_out: Uint8Array; scores: Numbers;
    /** Whether points are compared on its sequence: all that count have a valid run there. */
    compared: Uint8Array;
  };
  analyses: Analysis[];
}

export interface TuningPayload extends PagePayload {
  kind: "tuning";
  source: "sweep" | "tune";
  plan: string;
  jobs: Record<string, number>;
  /** What the held-out sequences say of a Pareto front; null: of one objective. */
  front?: string | null;
  /** The search ended before its last generation and before the held-out sequences. */
  interrupted?: boolean;
  held_out_jobs: Record<string, number>;
  /** That held-out results were seen before the last ones. */
  looked?: string | null;
  scores: string[];
  sequences: Sequence[];
  estimators: TunedEstimator[];
  notes?: string[];
}

/** A point of the design with its scores over the chosen sequences. */
export interface Point {
  index: number;
  untuned: boolean;
  values: number[];
  generation: number;
  /** Median over the sequences; NaN for none. */
  score: number;
  sequences: number;
  diverged: number;
}

function median(values: number[]): number {
  const known = values.filter(Number.isFinite).sort((a, b) => a - b);
  if (known.length === 0) return NaN;
  const middle = Math.floor(known.length / 2);
  return known.length % 2 === 1 ? known[middle]! : (known[middle - 1]! + known[middle]!) / 2;
}

/** The outcome of a job on an invalid run. */
const kInvalid = 4;

/** Which sequences of the data are chosen. */
export interface SequenceChoice {
  /** null: all. */
  scenario: string | null;
  heldOut: boolean;
}

/** The estimator's points that were run on any of these sequences, with the median of that score over those compared. */
export function pointsOf(data: TuningPayload, own: TunedEstimator, score: string, choice: SequenceChoice): Point[] {
  const count = own.parameters.length;
  const column = data.scores.indexOf(score);
  const width = data.scores.length;
  const values = new Map<number, number[]>();
  const diverged = new Map<number, number>();
  own.rows.point.forEach((point, row) => {
    const sequence = data.sequences[own.rows.sequence[row]!];
    if ((own.rows.held_out[row] === 1) !== choice.heldOut) return;
    if (choice.scenario !== null && sequence?.scenario !== choice.scenario) return;
    if (!values.has(point)) values.set(point, []);
    if (own.rows.compared[row] !== 1 || own.rows.outcome[row] === kInvalid) return;
    values.get(point)!.push(column < 0 ? NaN : own.rows.scores[row * width + column]!);
    diverged.set(point, (diverged.get(point) ?? 0) + own.rows.diverged[row]!);
  });
  return [...values].map(([index, scores]) => ({
    index, untuned: own.points.untuned[index] === 1,
    values: Array.from(own.points.values.subarray(index * count, (index + 1) * count)),
    generation: own.points.generation?.[index] ?? NaN,
    score: median(scores), sequences: scores.length, diverged: diverged.get(index) ?? 0,
  }));
}

export function scenariosOf(data: TuningPayload): string[] {
  return [...new Set(data.sequences.map((each) => each.scenario))];
}

export function axisLabel(parameter: Parameter): string {
  return parameter.unit && parameter.unit !== "-" ? `${parameter.name} [${parameter.unit}]` : parameter.name;
}

/** Both ends of an interval, where it has them. */
export function ends(interval: Interval | undefined): [number, number] | null {
  if (!interval) return null;
  const [low, high] = interval;
  return isNumber(low) && isNumber(high) ? [low, high] : null;
}
