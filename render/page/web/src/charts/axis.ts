// SPDX-License-Identifier: BSD-3-Clause
/** One axis of a chart: values to pixels, and where its ticks stand. All charts of the pages take their ticks here. */
import { formatNumber } from "../format";

export interface Axis {
  log: boolean;
  low: number;
  high: number;
  /** Position in [0, 1]; outside for values beyond the ends, NaN for what has no place. */
  at: (value: number) => number;
  ticks: { value: number; label: string }[];
}

function linearTicks(low: number, high: number, most: number, whole = false): number[] {
  const rough = Math.max(whole ? 1 : 0, (high - low) / Math.max(1, most));
  const power = 10 ** Math.floor(Math.log10(rough));
  // A tick or two more than `most` beat a step that is twice as wide.
  const step = [1, 2, 5, 10].map((each) => each * power).find((each) => each >= 0.8 * rough) ?? 10 * power;
  const ticks: number[] = [];
  for (let k = Math.ceil(low / step - 1e-9); k * step <= high + 1e-9 * step; ++k) ticks.push(k * step);
  return ticks;
}

/** The finest of 1-2-5, 1-3 and 1 per decade that fits, else every so many decades; linear in less than a decade. */
function logTicks(low: number, high: number, most: number): number[] {
  const first = Math.floor(Math.log10(low) + 1e-9);
  const last = Math.ceil(Math.log10(high) - 1e-9);
  const of = (steps: number[], stride = 1) => {
    const ticks: number[] = [];
    for (let power = first; power <= last; power += stride) ticks.push(...steps.map((step) => step * 10 ** power));
    return ticks.filter((value) => value >= low * (1 - 1e-9) && value <= high * (1 + 1e-9));
  };
  const fit = [[1, 2, 5], [1, 3], [1]].map((steps) => of(steps)).find((ticks) => ticks.length <= most + 1) ??
    of([1], Math.ceil((last - first) / most));
  return fit.length > 1 ? fit : linearTicks(low, high, Math.max(most, 4));
}

/** Ends that hold all values, with some air; [0, 1] for none. Log: of those above zero. */
export function extent(values: Iterable<number>, log: boolean): [number, number] {
  let low = Infinity;
  let high = -Infinity;
  for (const value of values) {
    if (!Number.isFinite(value) || (log && value <= 0)) continue;
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  if (low > high) return log ? [0.1, 1] : [0, 1];
  if (log) {
    const air = Math.max(1.05, (high / low) ** 0.04);
    return [low / air, high * air];
  }
  const air = high > low ? 0.04 * (high - low) : Math.max(Math.abs(high) * 0.1, 1e-3);
  return [low - air, high + air];
}

/** An axis between those ends with about `most` ticks; `whole`: of whole numbers, such as levels. */
export function axis(ends: [number, number], log: boolean, most: number, whole = false): Axis {
  const [low, high] = ends;
  const at = log
    ? (value: number) =>
        value > 0 ? Math.log(value / low) / Math.log(high / low) : NaN
    : (value: number) => (value - low) / (high - low);
  const values = log ? logTicks(low, high, most) : linearTicks(low, high, most, whole);
  return { log, low, high, at, ticks: values.map((value) => ({ value, label: tickLabel(value) })) };
}

/** Text of a tick; no ten-thousandths that come from rounding. */
export function tickLabel(value: number): string {
  if (value === 0 || Math.abs(value) < 1e-12) return "0";
  const text = formatNumber(Number(value.toPrecision(6)), 6);
  if (text.includes("e")) return formatNumber(value, 1);
  return text.includes(".") ? text.replace(/\.?0+$/, "") : text;
}

/** From values to [0, 1], logarithmic where all are above zero; its ends, and a note of the law. */
export function unitScale(values: number[]): {
  low: number; high: number; law: string; at: (value: number) => number;
} {
  const low = Math.min(...values);
  const high = Math.max(...values);
  if (!(high > low)) return { low, high, law: "", at: () => 0 };
  if (low > 0)
    return { low, high, law: ", logarithmic", at: (value) => Math.log(value / low) / Math.log(high / low) };
  return { low, high, law: "", at: (value) => (value - low) / (high - low) };
}
