// SPDX-License-Identifier: BSD-3-Clause
/** Ranges of a strip's vertical axis. */
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
