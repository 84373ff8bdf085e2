// SPDX-License-Identifier: BSD-3-Clause
/** Columns of the payload: samples at an instant, several clocks on one axis of time. */
import type { Estimator, Numbers, RunPayload } from "../contract";
import { isNumber } from "../format";
import { nearestIndex } from "./store";

/** A column over time; `times` ascending [s]. */
export interface Track {
  times: Numbers;
  values: Numbers;
}

/** Column of an estimator, null if the folder did not hold it or nothing in it is a number. */
export function column(estimator: Estimator | undefined, name: string): Track | null {
  const series = estimator?.series;
  if (!series || !Object.hasOwn(series, name)) return null;
  return track(series.t, series[name] ?? null);
}

/** Track of a column that may be missing. */
export function track(
  times: Numbers | null | undefined,
  values: Numbers | null | undefined,
): Track | null {
  if (!times || !values || times.length === 0 || values.length < times.length) return null;
  return values.some((value) => Number.isFinite(value)) ? { times, values } : null;
}

/** How far from the cursor a sample may lie to count as its value [s]. */
function reach(times: ArrayLike<number>): number {
  const count = times.length;
  return count < 2 ? 0.5 : Math.max(0.5, (1.5 * (times[count - 1]! - times[0]!)) / (count - 1));
}

/** Index of the sample at an instant, -1 if none lies near. */
export function indexAt(times: ArrayLike<number> | null | undefined, seconds: number): number {
  if (!times) return -1;
  const index = nearestIndex(times, seconds);
  return index >= 0 && Math.abs(times[index]! - seconds) <= reach(times) ? index : -1;
}

/** Value at an instant, NaN if there is none, also on both sides of the sample without a number that stands in a gap. */
export function valueAt({ times, values }: Track, seconds: number): number {
  const index = indexAt(times, seconds);
  if (index < 0 || times[index] === seconds) return index < 0 ? NaN : values[index]!;
  const other = values[index + (times[index]! < seconds ? 1 : -1)];
  return other !== undefined && Number.isNaN(other) ? NaN : values[index]!;
}

/** Three numbers of a list of xyz, null if one has no value. */
export function vectorAt(
  list: Numbers | null | undefined,
  index: number,
): [number, number, number] | null {
  if (!list || index < 0 || 3 * index + 2 >= list.length) return null;
  const x = list[3 * index]!,
    y = list[3 * index + 1]!,
    z = list[3 * index + 2]!;
  return Number.isFinite(x + y + z) ? [x, y, z] : null;
}

/** Four numbers of a list of xyzw; the identity if it has none there. */
export function quaternionAt(
  list: Numbers | null | undefined,
  index: number,
): [number, number, number, number] {
  if (!list || index < 0 || 4 * index + 3 >= list.length) return [0, 0, 0, 1];
  const q = [0, 1, 2, 3].map((i) => list[4 * index + i]!) as [number, number, number, number];
  return Number.isFinite(q[0] + q[1] + q[2] + q[3]) ? q : [0, 0, 0, 1];
}

export type Aligned = [number[], ...(number | null | undefined)[][]];

/** Float32 of stamps a millisecond apart or less are the same instant. */
const key = (seconds: number) => Math.round(seconds * 1000);

/** A sample without a value breaks a curve from the value before it to the next, also at the stamps of other curves between them. */
function widenBreaks(column: (number | null | undefined)[]): void {
  let from = 0;
  for (let i = 0; i <= column.length; ++i) {
    if (i < column.length && !isNumber(column[i])) continue;
    if (column.slice(from, i).includes(null)) column.fill(null, from, i);
    from = i + 1;
  }
}

/** Tracks on the union of their stamps: undefined without a sample, null without a value. */
export function align(tracks: Track[], positiveOnly = false): Aligned {
  const stamps = new Set<number>();
  const clocks = new Set(tracks.map((item) => item.times));
  for (const times of clocks) {
    for (const seconds of times) if (isNumber(seconds)) stamps.add(key(seconds));
  }
  const keys = [...stamps].sort((a, b) => a - b);
  const place = new Map(keys.map((value, index) => [value, index]));
  const columns = tracks.map(({ times, values }) => {
    const out = new Array<number | null | undefined>(keys.length).fill(undefined);
    for (let i = 0; i < times.length; ++i) {
      const index = place.get(key(times[i]!));
      const value = values[i]!;
      if (index !== undefined)
        out[index] = Number.isFinite(value) && !(positiveOnly && value <= 0) ? value : null;
    }
    widenBreaks(out);
    return out;
  });
  return [keys.map((value) => value / 1000), ...columns];
}

/** Where the cursor may stand [s]: scans, else samples of an estimator or the truth; ascending. */
export function cursorTimes(data: RunPayload): number[] {
  const spanOf = (t: Numbers | undefined) => (t && t.length > 0 ? t[t.length - 1]! - t[0]! : 0);
  const estimators = data.estimators.map((item) => item.series?.t);
  const longest = estimators.sort((a, b) => spanOf(b) - spanOf(a) || (b?.length ?? 0) - (a?.length ?? 0))[0];
  const found = [data.localizability?.t, longest, data.truth?.t].find((times) => times?.length);
  return found ? [...found].filter(isNumber).sort((a, b) => a - b) : [];
}

/** First and last stamp of anything [s]; a second around a single one, 0 to 1 without any. */
export function timeSpan(data: RunPayload): [number, number] {
  let first = Infinity;
  let last = -Infinity;
  const all = [
    data.truth?.t,
    data.localizability?.t,
    data.legs?.t,
    ...data.estimators.map((item) => item.series?.t),
  ];
  for (const times of all) {
    for (const seconds of times ?? []) {
      if (!Number.isFinite(seconds)) continue;
      if (seconds < first) first = seconds;
      if (seconds > last) last = seconds;
    }
  }
  if (last < first) return [0, 1];
  return last - first < 1 ? [first - 0.5, last + 0.5] : [first, last];
}
