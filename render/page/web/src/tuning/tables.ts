// SPDX-License-Identifier: BSD-3-Clause
/** What the analysis says in numbers: best values, sensitivity, and every point. */
import { h } from "../dom";
import { formatFixed, formatNumber, isNumber, kNone } from "../format";
import { sortableTable, type Column } from "../table";
import {
  axisLabel, ends, pointsOf, type Analysis, type Point, type TunedEstimator, type TuningPayload, type WalkChoice,
} from "./model";

export function percent(share: unknown): string {
  return isNumber(share) ? `${formatNumber(100 * share, 3)} %` : kNone;
}

function bracket(interval: [number, number] | null, scale = 1, unit = ""): string {
  return interval ? ` [${formatNumber(scale * interval[0])}, ${formatNumber(scale * interval[1])}]${unit}` : "";
}

/** What the best point gains, in words. */
export function outcome(analysis: Analysis): HTMLElement {
  const { best } = analysis;
  if (!best) return h("p", {}, `No best point: ${analysis.why_no_best ?? "no point is complete yet"}.`);
  const gain = isNumber(best.gain)
    ? ` The untuned values have ${formatNumber(best.defaults)}; the gain is ${percent(best.gain)}` +
      `${bracket(ends(best.gain_interval), 100, " %")}.`
    : " The untuned values were not run on all walks, so that there is nothing to hold it against.";
  const sure = analysis.seeds < 2 ? "One seed tells nothing of the spread: there are no intervals."
    : `Intervals: 95 % bootstraps over ${analysis.seeds} seeds${analysis.seeds < 10 ? ", too narrow for so few" : ""}.`;
  return h("div", {},
    h("p", {}, `Objective: ${analysis.objective}. The best of ${analysis.points} points has `,
      h("b", { "data-best": best.objective }, formatNumber(best.objective)),
      `${bracket(ends(best.objective_interval))}.${gain}`),
    h("p", { class: "soft" }, sure +
      (analysis.incomplete > 0 ? ` ${analysis.incomplete} points are left out here: not all of their walks are done.` : "")));
}

/** A row per parameter: default, best with where it may lie. */
export function bestTable(own: TunedEstimator, analysis: Analysis): HTMLElement | null {
  const { best } = analysis;
  if (!best) return null;
  const rows = own.parameters.map((parameter, i) => ({ parameter, i }));
  return sortableTable(rows, [
    { title: "parameter", value: ({ parameter }) => axisLabel(parameter) },
    { title: "range", value: ({ parameter }) => `${formatNumber(parameter.low)} to ${formatNumber(parameter.high)}${parameter.log ? ", log" : ""}` },
    { title: "default", value: ({ parameter }) => parameter.default },
    { title: "best", value: ({ i }) => best.values[i], interval: ({ i }) => ends(best.between[i]) },
    {
      title: "moved", unit: "of range", hint: "best minus default, in widths of the range", value: ({ i }) => best.distance[i],
      show: ({ i }) => `${(best.distance[i] ?? 0) > 0 ? "+" : ""}${formatNumber(best.distance[i], 2)}`,
    },
  ], { caption: "Best values, with where the best lies when seeds are drawn again", rowName: ({ parameter }) => parameter.name });
}

/** Share of the objective's variance by each parameter: bars with their interval, and the numbers. */
export function sensitivity(own: TunedEstimator, analysis: Analysis): HTMLElement {
  const found = analysis.sensitivity;
  if (!found) {
    return h("p", { class: "nothing" },
      `Which parameter matters is not known: ${analysis.why_no_sensitivity ?? "no point is complete yet"}.`);
  }
  const error = found.logarithmic ? percent(Math.exp(found.error) - 1) : formatNumber(found.error);
  const said = `A polynomial of ${found.terms} terms through ${found.points} points explains ${percent(Math.max(0, found.explained))} of ` +
    `the variance${found.logarithmic ? " of the objective's logarithm" : ""} at points that were left out; its error there is ${error}.`;
  if (!found.trustworthy) {
    return h("p", { class: "nothing" }, `${said} That is too little: nothing is said of which parameter matters.`);
  }
  const order = own.parameters.map((_, i) => i).sort((a, b) => (found.total[b] ?? 0) - (found.total[a] ?? 0));
  const bars = order.map((i) => {
    const total = found.total[i] ?? 0;
    const first = found.first[i] ?? 0;
    const interval = ends(found.total_interval[i]);
    const place = (share: number) => `${100 * Math.min(1, Math.max(0, share))}%`;
    return h("div", { class: "share-row", "data-parameter": own.parameters[i]!.name, "data-total": total },
      h("span", { class: "share-name" }, own.parameters[i]!.name),
      h("span", { class: "share-track", "aria-hidden": "true" },
        h("span", { class: "share-total", style: `width: ${place(total)}` }),
        h("span", { class: "share-first", style: `width: ${place(first)}` }),
        interval ? h("span", { class: "share-interval", style: `left: ${place(interval[0])}; right: calc(100% - ${place(interval[1])})` }) : null),
      h("span", { class: "share-text" }, `${percent(total)}${bracket(interval, 100)}, alone ${percent(first)}` +
        (found.does_not_matter[i] ? "; does not matter" : "")));
  });
  return h("div", {}, h("div", { class: "shares" }, ...bars), h("p", { class: "soft" },
    `Wide bars: in total, with its 95 % interval; narrow bars: alone. ${said}`), interactions(own, found.second));
}

function interactions(own: TunedEstimator, second: number[][]): HTMLElement | null {
  const pairs: string[] = [];
  own.parameters.forEach((a, i) => own.parameters.forEach((b, k) => {
    const share = second[i]?.[k] ?? 0;
    if (k > i && share >= 0.05) pairs.push(`${a.name} and ${b.name} act together: ${percent(share)} of the variance`);
  }));
  return pairs.length > 0 ? h("p", {}, `${pairs.join("; ")}.`) : null;
}

/** Every point with its values and the median of the score. */
export function pointTable(data: TuningPayload, own: TunedEstimator, score: string, choice: WalkChoice): HTMLElement {
  const points = pointsOf(data, own, score, choice);
  if (points.length === 0) return h("p", { class: "nothing" }, "No unit of this choice is done yet.");
  const columns: Column<Point>[] = [
    { title: "point", value: (point) => point.index, show: (point) => (point.untuned ? `${point.index}, untuned` : String(point.index)) },
    { title: score, hint: "median over the walks", best: "low", eligible: (point) => point.lost === 0, value: (point) => point.score },
    ...own.parameters.map((parameter, i): Column<Point> => ({
      title: parameter.name, ...(parameter.unit && parameter.unit !== "-" ? { unit: parameter.unit } : {}),
      value: (point) => point.values[i],
    })),
    { title: "walks", value: (point) => point.walks, show: (point) => String(point.walks) },
    { title: "lost", value: (point) => point.lost, show: (point) => (point.lost > 0 ? `✕ ${point.lost}` : "0") },
  ];
  if (own.points.generation) columns.push({ title: "generation", value: (point) => point.generation, show: (point) => formatFixed(point.generation, 0) });
  return sortableTable(points, columns, {
    caption: `${points.length} points, median of ${score} over ${choice.scenario ?? "all walks"}${choice.heldOut ? ", held out" : ""}`,
    rowName: (point) => String(point.index), sortBy: 1,
  });
}
