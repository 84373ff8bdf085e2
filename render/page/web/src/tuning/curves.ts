// SPDX-License-Identifier: BSD-3-Clause
/** A score over each parameter, scenario by scenario. */
import { chart, type Line, type Mark } from "../charts/chart";
import { h } from "../dom";
import { formatNumber } from "../format";
import {
  axisLabel, pointsOf, scenariosOf, type Analysis, type Parameter, type Slice, type SlicePoints, type TunedEstimator, type TuningPayload,
} from "./model";

function marksOf(points: SlicePoints): Mark[] {
  return Array.from(points.x, (x, i) => ({ x, y: points.value[i]!, low: points.low[i]!, high: points.high[i]! }));
}

/**
 * The objective along a parameter: markers where it was measured, a thin line where a fit is supported. Beside one over
 * all scenarios, those of a scenario are off at first: intervals at the same values cover each other.
 */
function sliceLines(slices: Slice[]): Line[] {
  return slices.flatMap((slice, index) => {
    const name = slice.family || "all scenarios";
    const lines: Line[] = [];
    const hidden = slice.family !== "" && slices.some((each) => !each.family);
    if (slice.fit) lines.push({ name: `${name}, fit`, index, marks: marksOf(slice.fit), plain: true, band: true, hidden });
    if (slice.measured) lines.push({ name: `${name}, measured`, index, marks: marksOf(slice.measured), unjoined: true, hidden });
    return lines;
  });
}

function slicesOf(analysis: Analysis | undefined, parameter: number): Slice[] {
  return analysis?.curves.filter((slice) => slice.first === parameter) ?? [];
}

/** Every point's own score over that parameter, a series per scenario. */
function cloudLines(data: TuningPayload, own: TunedEstimator, score: string, parameter: number): Line[] {
  return scenariosOf(data).map((scenario, index) => ({
    name: scenario, index, scatter: true,
    marks: pointsOf(data, own, score, { scenario, heldOut: false }).map((point) => ({
      x: point.values[parameter]!, y: point.score, cross: point.diverged > 0,
      note: point.untuned ? "defaults" : point.diverged > 0 ? `${point.diverged} of ${point.sequences} diverged` : "",
    })),
  })).filter((line) => line.marks.length > 0);
}

/** The objective of every point over that parameter, whatever the others are. */
function pointLines(data: TuningPayload, own: TunedEstimator, analysis: Analysis, parameter: number): Line[] {
  const points = pointsOf(data, own, analysis.score, { scenario: null, heldOut: false });
  const isBest = (values: number[]) => analysis.best?.values.every((value, i) => Math.fround(value) === values[i]) ?? false;
  const marks = points.map(({ index, values, untuned }): Mark => ({
    x: values[parameter]!, y: analysis.objectives[index]!, note: untuned ? "defaults" : isBest(values) ? "best" : "",
  }));
  return [
    { name: "points", index: 0, scatter: true, marks: marks.filter(({ note }) => note !== "best") },
    { name: "best point", index: 1, unjoined: true, marks: marks.filter(({ note }) => note === "best") },
  ].filter((line) => line.marks.length > 0);
}

function parameterHead(parameter: Parameter): HTMLElement {
  return h("h3", {}, parameter.name, parameter.meaning ? h("span", { class: "soft" }, `, ${parameter.meaning}`) : null);
}

/** Points that differ in one parameter alone with their fit; the objective of all points; their scores by scenario. */
export type Shown = "slice" | "points" | "cloud";

/** A chart per parameter. */
export function curves(
  data: TuningPayload, own: TunedEstimator, analysis: Analysis | undefined, score: string, shown: Shown
): HTMLElement {
  const figures = own.parameters.map((parameter, i) => {
    const slices = slicesOf(analysis, i);
    const lines = shown === "cloud" || !analysis ? cloudLines(data, own, score, i)
      : shown === "points" ? pointLines(data, own, analysis, i) : sliceLines(slices);
    const yLabel = shown === "cloud" || !analysis ? `score: median ${score}` : analysis.axis;
    const held = shown === "slice" ? slices[0]?.held ?? "" : "";
    const verticals = [{ x: parameter.default, label: `default ${formatNumber(parameter.default)}` }];
    const body = lines.some((line) => line.marks.some((mark) => Number.isFinite(mark.y)))
      ? chart(lines, {
          label: `${yLabel} over ${parameter.name}`, xLabel: axisLabel(parameter), yLabel, height: 270,
          xLog: parameter.log, yLog: allPositive(lines), xEnds: parameterEnds(parameter), verticals,
          dodge: shown === "slice" ? 9 : 0,
        })
      : h("p", { class: "nothing" }, shown !== "slice" ? "No point has this score."
          : "No curve: fewer than two points differ in this parameter alone, and no fit is supported. Choose “every point” instead.");
    return h("div", { "data-parameter": parameter.name }, parameterHead(parameter), body,
      held ? h("p", { class: "soft held" }, `At ${held}.`) : null);
  });
  return h("div", { class: "figures" }, ...figures);
}

function allPositive(lines: Line[]): boolean {
  const values = lines.flatMap((line) => line.marks.map((mark) => mark.y)).filter(Number.isFinite);
  return values.length > 0 && values.every((value) => value > 0);
}

/** The range and the default, which may lie outside. */
export function parameterEnds(parameter: Parameter): [number, number] {
  const inside = parameter.log && !(parameter.default > 0) ? parameter.low : parameter.default;
  const low = Math.min(parameter.low, inside);
  const high = Math.max(parameter.high, inside);
  if (!(high > low)) return parameter.log ? [low / 2, low * 2] : [low - 0.5, high + 0.5];
  if (parameter.log) return [low / (high / low) ** 0.02, high * (high / low) ** 0.02];
  return [low - 0.02 * (high - low), high + 0.02 * (high - low)];
}
