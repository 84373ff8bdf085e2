// SPDX-License-Identifier: BSD-3-Clause
/** Whether errors along the weak axis agree with the stated covariance. */
import { chart, type ChartOptions, type Line, type Mark } from "../charts/chart";
import { choice } from "../charts/controls";
import { h, own, section } from "../dom";
import { formatNumber, isNumber } from "../format";
import type { Numbers } from "../contract";
import { sortableTable } from "../table";
import type { ConsistencyCase, SuitePayload } from "./model";

function percent(fraction: unknown): string {
  return isNumber(fraction) ? `${formatNumber(100 * fraction)} %` : formatNumber(fraction);
}

function table(cases: ConsistencyCase[]): HTMLElement {
  return sortableTable(cases, [
    { title: "scenario", value: (each) => each.scenario },
    { title: "estimator", value: (each) => each.estimator },
    { title: "seeds", value: (each) => each.runs, show: (each) => String(each.runs) },
    {
      title: "mean NEES", hint: "1 when the stated variance is right, above when it is too small", value: (each) => each.mean_nees,
      interval: ({ mean_nees_interval: [low, high] }) => (isNumber(low) && isNumber(high) ? [low, high] : null),
    },
    {
      title: "inside", hint: "fraction of the instants at which the mean NEES over seeds lies within its 95 % bounds",
      value: (each) => each.inside_fraction, show: (each) => percent(each.inside_fraction),
    },
    { title: "above", value: (each) => each.above_fraction, show: (each) => percent(each.above_fraction) },
    {
      title: "within 2σ", hint: "fraction of runs whose error is within twice the stated deviation, over all instants",
      value: (each) => each.two_sigma.fraction, show: (each) => percent(each.two_sigma.fraction),
    },
    { title: "error", unit: "m", hint: "root mean square", value: (each) => each.error_rms_m },
    { title: "bound over error", hint: "posterior Cramér–Rao bound over the error, both root mean square", value: (each) => each.efficiency },
  ], { caption: "Along the weak axis, over the sequence", rowName: (each) => `${each.scenario}/${each.estimator}` });
}

type Series = Record<string, Numbers>;

/** A line over time; NaN for what a series does not have. */
function lineOf(series: Series, name: string, index: number, of: string | null, ends?: [string, string]): Line {
  const times = own<Numbers>(series, "t_s") ?? new Float32Array();
  const at = (key: string | null, i: number) => Math.abs((key === null ? undefined : own<Numbers>(series, key)?.[i]) ?? NaN);
  const marks = Array.from(times, (x, i): Mark => ({
    x, y: at(of, i), ...(ends ? { low: at(ends[0], i), high: at(ends[1], i) } : {}),
  }));
  return { name, index, marks, plain: true, band: ends !== undefined };
}

function charts({ series, example }: ConsistencyCase): HTMLElement {
  const drawn = (lines: Line[], label: string, yLabel: string, yLog = true): HTMLElement => {
    const options: ChartOptions = { label, xLabel: "time [s]", yLabel, yLog, height: 280 };
    return chart(lines.filter(({ marks }) => marks.some(({ y, low }) => Number.isFinite(y) || Number.isFinite(low))), options);
  };
  return h("div", { class: "figures" },
    drawn([
      lineOf(series, "95 % bounds of a consistent filter", 1, null, ["nees_low", "nees_high"]), lineOf(series, "mean over seeds", 0, "nees"),
    ], "Mean NEES over seeds and its bounds over time", "NEES [-]"),
    drawn([
      lineOf(series, "error", 0, "error_rms_m"), lineOf(series, "stated deviation", 1, "sigma_rms_m"),
      lineOf(series, "bound", 2, "bound_rms_m"), lineOf(series, "bound of legs", 3, "leg_bound_rms_m"),
    ], "Root mean squares over seeds, over time", "error along the weak axis [m]"),
    example ? drawn([
      lineOf(example.series, `size of the error, seed ${example.seed}`, 0, "error_m"), lineOf(example.series, "2σ", 1, "two_sigma_m"),
    ], "Error of one run and twice its stated deviation, over time", "error along the weak axis [m]", false) : null);
}

/** The section; none without a consistency study. */
export function consistencySection(data: SuitePayload): HTMLElement | null {
  const cases = (data.consistency?.cases ?? []).filter((each) => each.runs > 0);
  const first = cases[0];
  if (!first) return null;
  const place = h("div", {}, charts(first));
  return section("consistency", "Consistency along the weak axis", table(cases),
    h("div", { class: "toolbar" }, choice("Over time", cases.map((each, i) => ({ value: String(i), label: `${each.scenario}, ${each.estimator}` })), "0",
      (value) => place.replaceChildren(charts(cases[Number(value)] ?? first)))),
    place);
}
