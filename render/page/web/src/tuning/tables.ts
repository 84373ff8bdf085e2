// SPDX-License-Identifier: BSD-3-Clause
/** The analysis in numbers: best values, sensitivity, and every point. */
import { h } from "../dom";
import { formatFixed, formatNumber, isNumber, kNone } from "../format";
import { sortableTable, type Column } from "../table";
import {
  axisLabel, ends, pointsOf, type Analysis, type Best, type Point, type Sensitivity, type TunedEstimator, type TuningPayload, type SequenceChoice,
} from "./model";

export function percent(fraction: unknown): string {
  return isNumber(fraction) ? `${formatNumber(100 * fraction, 3)} %` : kNone;
}

function bracket(interval: [number, number] | null, scale = 1, unit = ""): string {
  return interval ? ` [${formatNumber(scale * interval[0])}, ${formatNumber(scale * interval[1])}]${unit}` : "";
}

/** The values found and, of a tuning, what the held-out sequences say of them. */
function verdict({ text: values, is_default: keeps }: Best, analysis: Analysis, { tuned, front, interrupted }: Search): HTMLElement {
  if (interrupted) {
    return h("p", { class: "verdict undecided", "data-verdict": "undecided" },
      h("strong", {}, "Interrupted."), ` Best so far, on the sequences tuned on: ${values}. Not validated.`);
  }
  if (front) {
    const name = front.startsWith("use ") ? "use" : front.startsWith("undecided") ? "undecided" : "do-not-use";
    return h("div", {},
      h("p", { class: `verdict ${name}`, "data-verdict": name.replaceAll("-", " ") }, h("strong", {}, "Pareto front."), ` Verdict: ${front}. Its points stand in tune.md.`),
      h("p", {}, keeps ? `In this objective alone the defaults are the best: ${values}.` : `Best in this objective alone: ${values}.`));
  }
  if (keeps) {
    return h("p", { class: "verdict do-not-use", "data-verdict": "do not use" },
      h("strong", {}, "Keep the defaults"), `: ${values}.`);
  }
  if (!tuned) {
    return h("p", { "data-standing": analysis.standing },
      h("strong", {}, `${analysis.standing === "best" ? "Best values" : analysis.standing.replace("least", "Least objective")}: ${values}${analysis.unresolved ?? ""}.`));
  }
  const held = analysis.held_out ?? { verdict: "undecided", text: "not validated: these values were not run on the held-out sequences" };
  return h("p", { class: `verdict ${held.verdict.replaceAll(" ", "-")}`, "data-verdict": held.verdict },
    h("strong", {}, `Tuned values: ${values}.`), ` Verdict: ${held.text}.`);
}

/** How points were found. */
export interface Search {
  /** By an optimizer, with sequences held out. */
  tuned: boolean;
  /** The verdict on a Pareto front; null: of one objective. */
  front: string | null;
  /** Ended by the user: there are points, and no result. */
  interrupted: boolean;
}

/** What the best point gains, in words. */
export function outcome(analysis: Analysis, search: Search): HTMLElement {
  const { best } = analysis;
  if (!best) return h("p", {}, `No best point: ${analysis.why_no_best ?? "no point is complete yet"}.`);
  const gain = isNumber(best.gain)
    ? ` The defaults have ${formatNumber(best.defaults)}: ${percent(best.gain)} less` +
      `${bracket(ends(best.gain_interval), 100, " %")} on these sequences, among which the best was chosen.`
    : best.defaults_diverged ? " No gain: every run with the default values diverged, so that a gain over them means nothing."
    : " The defaults were not run on every sequence, so that nothing is compared with them.";
  const sure = analysis.seeds < 2 ? "One seed: no intervals."
    : `Intervals: 95 % bootstraps over ${analysis.seeds} seeds${analysis.seeds < 10 ? ", too narrow for so few seeds" : ""}.`;
  return h("div", {}, verdict(best, analysis, search),
    h("p", {}, `Objective: ${analysis.objective}. ${best.is_default ? "The defaults have an objective of "
      : `The best of ${analysis.points} points has an objective of `}`,
      h("b", { "data-best": best.objective }, formatNumber(best.objective)),
      `${bracket(ends(best.objective_interval))}${best.is_default ? ", and no point less." : `.${gain}`}`),
    h("p", { class: "soft" }, sure +
      (analysis.incomplete > 0 ? ` ${analysis.incomplete} points are left out: some of their jobs are not done.` : "")));
}

/** A row per parameter: default, best value with its interval. */
export function bestTable(own: TunedEstimator, analysis: Analysis): HTMLElement | null {
  const { best } = analysis;
  if (!best) return null;
  const rows = own.parameters.map((parameter, i) => ({ parameter, i }));
  return sortableTable(rows, [
    { title: "parameter", value: ({ parameter }) => axisLabel(parameter) },
    { title: "range", value: ({ parameter }) => `${formatNumber(parameter.low)} to ${formatNumber(parameter.high)}${parameter.log ? ", log" : ""}` },
    { title: "default", value: ({ parameter }) => parameter.default },
    {
      title: "best", value: ({ i }) => best.values[i], interval: ({ i }) => analysis.sensitivity?.negligible[i] ? null : ends(best.between[i]),
      show: ({ i }) => best.without_effect[i] ? "no effect"
        : formatNumber(best.values[i]) + (analysis.sensitivity?.negligible[i] ? ", negligible effect" : ""),
    },
    {
      title: "change", unit: "of range", hint: "best minus default, in widths of the range", value: ({ i }) => best.distance[i],
      show: ({ i }) => best.without_effect[i] ? kNone : `${(best.distance[i] ?? 0) > 0 ? "+" : ""}${formatNumber(best.distance[i], 2)}`,
    },
  ], { caption: "Best values; interval: best values when seeds are resampled", rowName: ({ parameter }) => parameter.name });
}

/** Where the indices come from. */
function sourceText(found: Sensitivity): string {
  const of = found.logarithmic ? "the objective's logarithm" : "the objective";
  if (found.of_part) {
    return `By an analysis of variance of ${of} at ${found.points} points of a grid that is not complete: effects of the ` +
      `levels${found.of_part.with_pairs ? " and their pairs" : ""} with a cross-validated R² of ${percent(found.of_part.explained)}.`;
  }
  if (found.of_grid || !found.fit) {
    return `By an analysis of variance of ${of} at the ${found.points} points of the complete grid; intervals over seeds.`;
  }
  const error = found.logarithmic ? percent(Math.exp(found.fit.error) - 1) : formatNumber(found.fit.error);
  return `A polynomial of ${found.fit.terms} terms through ${found.points} points has a cross-validated R² of ` +
    `${percent(Math.max(0, found.fit.explained))} for ${of}; its error at points left out is ${error}.`;
}

/** Sobol indices of each parameter: bars with their interval, and the numbers. */
export function sensitivity(own: TunedEstimator, analysis: Analysis): HTMLElement {
  const found = analysis.sensitivity;
  if (!found) {
    return h("p", { class: "nothing" },
      `No sensitivity: ${analysis.why_no_sensitivity ?? "no point is complete yet"}. ${analysis.effect ?? ""}`);
  }
  const source = sourceText(found);
  if (!found.resolved) {
    return h("p", { class: "nothing" },
      found.has_indices ? `Not resolved. ${analysis.effect ?? ""} ${source}`
        : `Not resolved: indices take a cross-validated R² of at least ${percent(found.least_explained)}. ${source} ${analysis.effect ?? ""}`);
  }
  const order = own.parameters.map((_, i) => i).sort((a, b) => (found.total[b] ?? 0) - (found.total[a] ?? 0));
  const bars = order.map((i) => {
    const total = found.total[i] ?? 0;
    const first = found.first[i] ?? 0;
    const interval = ends(found.total_interval[i]);
    const place = (fraction: number) => `${100 * Math.min(1, Math.max(0, fraction))}%`;
    return h("div", { class: "sobol-row", "data-parameter": own.parameters[i]!.name, "data-total": total },
      h("span", { class: "sobol-name" }, own.parameters[i]!.name),
      h("span", { class: "sobol-track", "aria-hidden": "true" },
        h("span", { class: "sobol-total", style: `width: ${place(total)}` }),
        h("span", { class: "sobol-first", style: `width: ${place(first)}` }),
        interval ? h("span", { class: "sobol-interval", style: `left: ${place(interval[0])}; right: calc(100% - ${place(interval[1])})` }) : null),
      h("span", { class: "sobol-text" }, `${percent(total)}${bracket(interval, 100)}, first order ${percent(first)}` +
        (found.negligible[i] ? "; negligible" : "")));
  });
  return h("div", {}, h("p", { "data-effect": "" }, `Whole effect: ${analysis.effect ?? ""}`), h("div", { class: "sobol" }, ...bars), h("p", { class: "soft" },
    `Wide bars: total Sobol index with its 95 % interval; narrow bars: first-order index. ${source}`), interactions(own, found.second));
}

function interactions(own: TunedEstimator, second: number[][]): HTMLElement | null {
  const pairs: string[] = [];
  own.parameters.forEach((a, i) => own.parameters.forEach((b, k) => {
    const fraction = second[i]?.[k] ?? 0;
    if (k > i && fraction >= 0.05) pairs.push(`interaction of ${a.name} and ${b.name}: ${percent(fraction)} of the variance`);
  }));
  return pairs.length > 0 ? h("p", {}, `${pairs.join("; ")}.`) : null;
}

/** Whether jobs of this choice are on sequences on which points are not compared. */
function leftOut(own: TunedEstimator, choice: SequenceChoice): boolean {
  return own.rows.compared.some((each, row) => each !== 1 && (own.rows.held_out[row] === 1) === choice.heldOut);
}

/** Every point with its values, its objective over all sequences that are tuned on, and the median of the score. */
export function pointTable(
  data: TuningPayload, own: TunedEstimator, analysis: Analysis | undefined, score: string, choice: SequenceChoice
): HTMLElement {
  const points = pointsOf(data, own, score, choice);
  if (points.length === 0) return h("p", { class: "nothing" }, "No job of this choice is done yet.");
  const objectives = choice.scenario === null && !choice.heldOut ? analysis?.objectives : undefined;
  const best = objectives ? analysis?.best : null;
  const isBest = (point: Point) => best !== null && best !== undefined && objectives !== undefined &&
    Math.fround(best.objective ?? NaN) === objectives[point.index] && point.values.every((value, i) => value === Math.fround(best.values[i]!));
  const columns: Column<Point>[] = [
    { title: "point", value: (point) => point.index, show: (point) => `${point.index}${point.untuned ? ", defaults" : ""}${isBest(point) ? ", best" : ""}` },
    ...(objectives ? [{
      title: "objective", hint: analysis!.objective, best: "low", value: (point: Point) => objectives[point.index],
    } as Column<Point>] : []),
    {
      title: `score: ${score}`, hint: "as measured, median over the sequences",
      ...(objectives ? {} : { best: "low" as const, eligible: (point: Point) => point.diverged === 0 }), value: (point) => point.score,
    },
    ...own.parameters.map((parameter, i): Column<Point> => ({
      title: parameter.name, ...(parameter.unit && parameter.unit !== "-" ? { unit: parameter.unit } : {}),
      value: (point) => point.values[i],
    })),
    { title: "sequences", value: (point) => point.sequences, show: (point) => String(point.sequences) },
    { title: "diverged", value: (point) => point.diverged, show: (point) => (point.diverged > 0 ? `✕ ${point.diverged}` : "0") },
  ];
  if (own.points.generation) columns.push({ title: "generation", value: (point) => point.generation, show: (point) => formatFixed(point.generation, 0) });
  return sortableTable(points, columns, {
    caption: `${points.length} points, median of ${score} over ${choice.scenario ?? "all sequences"}${choice.heldOut ? ", held out" : ""}` +
      (leftOut(own, choice) ? "; points are compared on the sequences alone on which each has a valid run" : ""),
    rowName: (point) => String(point.index), sortBy: 1,
  });
}
