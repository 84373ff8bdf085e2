// SPDX-License-Identifier: BSD-3-Clause
/** Position errors over the distance travelled, and where an estimate is lost. */
import type { Estimator, Numbers, RunPayload } from "../contract";
import { at } from "../dom";
import { isNumber } from "../format";
import { nearestIndex } from "./store";

/** How an estimate is laid onto the truth; either way its first pose is kept. */
export type Alignment = "heading" | "start";

/** The true path. */
export interface Path {
  t: Numbers;
  p: Numbers;
  /** Travelled at each stamp [m]; swaying on the spot does not count. */
  travelled: Float64Array;
}

/** Steps below this do not count as travel [m]. */
const kStep = 0.1;

export function truePath(data: RunPayload): Path | null {
  const { t, p } = data.truth ?? {};
  if (!t || !p || t.length < 2 || p.length < 3 * t.length) return null;
  const travelled = new Float64Array(t.length);
  let [x, y, sum] = [NaN, NaN, 0];
  for (let i = 0; i < t.length; ++i) {
    const [nx, ny] = [p[3 * i]!, p[3 * i + 1]!];
    if (!Number.isFinite(x + y)) [x, y] = [nx, ny];
    const step = Math.hypot(nx - x, ny - y);
    if (step > kStep) {
      sum += step;
      [x, y] = [nx, ny];
    }
    travelled[i] = sum;
  }
  return { t, p, travelled };
}

/** Position of the truth at an instant, between its samples; null outside of them. */
function truthAt(path: Path, seconds: number): [number, number, number] | null {
  const { t, p } = path;
  const near = nearestIndex(t, seconds);
  if (near < 0) return null;
  const i = Math.min(t[near]! <= seconds ? near : near - 1, t.length - 2);
  if (i < 0) return null;
  const part = (seconds - t[i]!) / (t[i + 1]! - t[i]!);
  if (!(part >= -1e-6 && part <= 1 + 1e-6)) return null;
  const at = (k: number) => p[3 * i + k]! + part * (p[3 * i + 3 + k]! - p[3 * i + k]!);
  return [at(0), at(1), at(2)];
}

/** An estimate compared with the truth, a sample per pose; in a gap one without numbers but its stamp and distance. */
export interface ErrorTrack {
  t: number[];
  /** Distance that the truth has travelled [m]. */
  distance: number[];
  /** Distance from the truth [m]. */
  error: number[];
  /** Laid onto the truth, xyz each [m]. */
  p: number[];
  /** By how much the heading was turned [rad]. */
  turn: number;
}

/** Turn about the first pose that brings the part before `until` [s] nearest to the truth [rad]. */
function fittedTurn(pairs: { t: number; e: number[]; q: number[] }[], until: number): number {
  const first = pairs[0]!;
  let [cross, dot] = [0, 0];
  for (const { t, e, q } of pairs) {
    if (t > until) break;
    const [ex, ey] = [e[0]! - first.e[0]!, e[1]! - first.e[1]!];
    const [qx, qy] = [q[0]! - first.q[0]!, q[1]! - first.q[1]!];
    cross += ex * qy - ey * qx;
    dot += ex * qx + ey * qy;
  }
  return Math.atan2(cross, dot);
}

/** Null without poses in the time of the truth. */
export function errorTrack(path: Path, estimator: Estimator, alignment: Alignment): ErrorTrack | null {
  const { t, p } = estimator.series ?? {};
  if (!t || !p) return null;
  const samples: { t: number; e: number[]; q: number[] }[] = [];
  for (let i = 0; i < t.length; ++i) {
    const q = truthAt(path, t[i]!);
    if (q && q.every(Number.isFinite)) samples.push({ t: t[i]!, e: [p[3 * i]!, p[3 * i + 1]!, p[3 * i + 2]!], q });
  }
  const pairs = samples.filter(({ e }) => e.every(Number.isFinite));
  if (pairs.length === 0) return null;
  const until = isNumber(estimator.diverged_at) ? estimator.diverged_at : Infinity;
  const turn = alignment === "heading" ? fittedTurn(pairs, until) : 0;
  const [cos, sin] = [Math.cos(turn), Math.sin(turn)];
  const start = pairs[0]!.e;
  const track: ErrorTrack = { t: [], distance: [], error: [], p: [], turn };
  for (const { t: at, e, q } of samples) {
    const [dx, dy] = [e[0]! - start[0]!, e[1]! - start[1]!];
    const laid = [start[0]! + cos * dx - sin * dy, start[1]! + sin * dx + cos * dy, e[2]!];
    track.t.push(at);
    track.distance.push(path.travelled[nearestIndex(path.t, at)]!);
    track.error.push(Math.hypot(laid[0]! - q[0]!, laid[1]! - q[1]!, laid[2]! - q[2]!));
    track.p.push(...laid);
  }
  return track;
}

/** The path of an estimate in its own frame, without a truth to compare it with. */
export function ownTrack(estimator: Estimator): ErrorTrack | null {
  const { t, p } = estimator.series ?? {};
  if (!t || !p) return null;
  const track: ErrorTrack = { t: [], distance: [], error: [], p: [], turn: 0 };
  for (let i = 0; i < t.length; ++i) {
    const at = [p[3 * i]!, p[3 * i + 1]!, p[3 * i + 2]!];
    track.t.push(t[i]!);
    track.distance.push(NaN);
    track.error.push(at.every(Number.isFinite) ? 0 : NaN);
    track.p.push(...at);
  }
  return track.error.some(Number.isFinite) ? track : null;
}

/** Where an estimate leaves the truth for good. */
export interface Loss {
  /** From then on the error stays above the limit [s]. */
  from: number;
  /** Distance travelled there [m]. */
  distance: number;
  /** Largest error after it [m]. */
  most: number;
}

/** An error that stays above this [m], and above this fraction of the distance travelled, is a loss. */
const kLost = 0.5;
const kLostPart = 0.01;

/** The last instant at which the estimate was still near the truth; null if it is near at the end. */
export function lossOf(track: ErrorTrack): Loss | null {
  const known = track.t.map((_, i) => i).filter((i) => Number.isFinite(track.error[i]!));
  const near = (i: number) => track.error[i]! <= Math.max(kLost, kLostPart * track.distance[i]!);
  let last = known.length - 1;
  while (last >= 0 && !near(known[last]!)) --last;
  if (last === known.length - 1) return null;
  const from = known[Math.max(last, 0)]!;
  return { from: track.t[from]!, distance: track.distance[from]!, most: mostOf(track, from) };
}

/** An error of the scale alone is within this part of itself in each of so many parts of the way. */
const kSteady = 0.25;
const kBlocks = 8;

/** Whether the distance from the start is wrong by one factor all along: beyond a quarter of the way, by the median of each part. */
export function isScaled(path: Path, track: ErrorTrack): boolean {
  const [start, first] = [truthAt(path, track.t[0]!), track.p.slice(0, 3)];
  if (!start) return false;
  const far = track.t.map((t, i) => {
    const truth = truthAt(path, t)!;
    const of = (p: number[], from: number[]) => Math.hypot(p[0]! - from[0]!, p[1]! - from[1]!);
    return { truth: of(truth, start), estimate: of(track.p.slice(3 * i, 3 * i + 2), first) };
  });
  const least = 0.25 * Math.max(...far.map((each) => each.truth));
  const errors = far.filter((each) => each.truth > least && Number.isFinite(each.estimate)).map((each) => each.estimate / each.truth - 1);
  if (errors.length < 2 * kBlocks) return false;
  const middle = (list: number[]) => [...list].sort((a, b) => a - b)[list.length >> 1]!;
  const blocks = Array.from({ length: kBlocks }, (_, i) =>
    middle(errors.slice((i * errors.length) / kBlocks, ((i + 1) * errors.length) / kBlocks)));
  const usual = middle(errors);
  return blocks.every((each) => Math.abs(each - usual) <= kSteady * Math.abs(usual));
}

/** The largest error from a sample on [m]. */
export function mostOf(track: ErrorTrack, from = 0): number {
  return track.error.reduce((most, error, i) => (i >= from && error > most ? error : most), 0);
}

/** The longest stretch of the truth's time without poses: "has no poses for the first 12 s", "has no poses for 12 s, from 34 s on". */
function longestHole(stamps: number[], first: number, last: number): string {
  const [start, end] = [stamps[0]! - first, last - stamps[stamps.length - 1]!];
  const steps = stamps.slice(1).map((stamp, i) => stamp - stamps[i]!);
  const longest = Math.max(0, ...steps);
  const usual = steps.length > 0 ? [...steps].sort((a, b) => a - b)[steps.length >> 1]! : 0;
  if (start >= Math.max(end, longest)) return `has no poses for the first ${start.toFixed(0)} s`;
  if (end >= longest) return `has no poses for the last ${end.toFixed(0)} s`;
  if (longest < 2 * usual) return `has a pose every ${usual.toFixed(1)} s only`;
  return `has no poses for ${longest.toFixed(0)} s, from ${stamps[steps.indexOf(longest)]!.toFixed(0)} s on`;
}

/** What is missing of an estimate of a part of the run, e.g. "has no poses for 12 s, from 34 s on"; null: nothing. */
export function missingText(data: RunPayload, name: string): string | null {
  const estimator = data.estimators.find((item) => item.name === name);
  const own = at(data.scores, "estimators", name);
  const [invalid, poses] = [at(own, "poses_invalid"), at(own, "poses")];
  if (isNumber(invalid) && isNumber(poses) && invalid > 0) return `returned ${invalid} of ${poses} poses that are none`;
  const { t, p } = estimator?.series ?? {};
  const truth = data.truth?.t;
  const isPartial = ["starts_late", "ends_early", "gap"].includes(String(at(own, "diverged_reason"))) || at(own, "partial") === true;
  if (!isPartial || !t || !p || !truth || truth.length === 0) return null;
  const stamps = [...t].filter((_, i) => Number.isFinite(p[3 * i]!));
  return stamps.length === 0 ? null : longestHole(stamps, truth[0]!, truth[truth.length - 1]!);
}

/** At most `count` samples of a track, evenly, with the last one, and those of gaps. */
export function thin(track: ErrorTrack, count: number): number[] {
  const n = track.t.length;
  const step = Math.max(1, Math.ceil(n / count));
  const kept: number[] = [];
  for (let i = 0; i < n; ++i) if (i % step === 0 || Number.isNaN(track.error[i]!)) kept.push(i);
  if (kept[kept.length - 1] !== n - 1) kept.push(n - 1);
  return kept;
}
