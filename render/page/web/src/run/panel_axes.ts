// SPDX-License-Identifier: BSD-3-Clause
/** Ranges and labels of a strip's vertical axis. */
import type uPlot from "uplot";
import { isNumber } from "../format";

/** A strip shows no more decades than this: one value of nearly nothing would flatten the others. */
const MOST_DECADES = 7;

export function logRange(low: number | null, high: number | null): uPlot.Range.MinMax {
  if (!isNumber(low) || !isNumber(high) || high <= 0) return [0.1, 10];
  const top = Math.ceil(Math.log10(high));
  const bottom = Math.max(Math.floor(Math.log10(Math.max(low, Number.MIN_VALUE))), top - MOST_DECADES);
  return [10 ** bottom, 10 ** Math.max(top, bottom + 1)];
}

export function linearRange(low: number | null, high: number | null): uPlot.Range.MinMax {
  if (!isNumber(low) || !isNumber(high)) return [0, 1];
  const margin = 0.08 * (high - low) || Math.abs(high) * 0.1 || 1;
  return [low >= 0 ? Math.max(0, low - margin) : low - margin, high + margin];
}

/** Powers of ten of a logarithmic axis, thinned to what `space` allows; none in between. */
export function decades(low: number, high: number, count: number): number[] {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const step = Math.max(1, Math.ceil((last - first) / Math.max(count, 1)));
  const list: number[] = [];
  for (let power = first; power <= last; power += step) list.push(Number(`1e${power}`));
  return list;
}

/** Short text of an axis value, no wider than the axis. */
export function axisText(value: number | null): string {
  if (value === null) return "";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3))
    return value.toExponential(0).replace("e+", "e").replace(/-/g, "−");
  return String(Number(value.toPrecision(6))).replace("-", "−");
}
