// SPDX-License-Identifier: BSD-3-Clause
/** A score over each parameter, scenario by scenario. */
import { chart, type Line, type Mark } from "../charts/chart";
import { h } from "../dom";
import { formatNumber } from "../format";
import {
  axisLabel, pointsOf, scenariosOf, type Analysis, type Parameter, type Slice, type TunedEstimator, type TuningPayload,
} from "./model";

function sliceMarks(slice: Slice): Mark[] {
  return Array.from(slice.x, (x, i) => ({ x, y: slice.value[i]!, low: slice.low[i]!, high: slice.high[i]! }));
}

/** The objective along a parameter with all others at their defaults: over all scenarios, and of each family. */
function sliceLines(analysis: Analysis, parameter: number): Line[] {
  return analysis.curves.filter((slice) => slice.first === parameter).map((slice, i) => ({
    name: `${slice.family || "all scenarios"}${slice.measured ? "" : ", fitted"}`, index: i,
    marks: sliceMarks(slice), plain: !slice.measured, band: !slice.measured,
  }));
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

function parameterHead(parameter: Parameter): HTMLElement {
  return h("h3", {}, parameter.name, parameter.meaning ? h("span", { class: "soft" }, `, ${parameter.meaning}`) : null);
}

/** A chart per parameter; `cloud` shows every point, else the curve with the others at their defaults. */
export function curves(
  data: TuningPayload, own: TunedEstimator, analysis: Analysis | undefined, score: string, cloud: boolean
): HTMLElement {
  const figures = own.parameters.map((parameter, i) => {
    const lines = cloud ? cloudLines(data, own, score, i) : analysis ? sliceLines(analysis, i) : [];
    const yLabel = cloud || !analysis ? score : `${score}, objective`;
    const verticals = [{ x: parameter.default, label: `default ${formatNumber(parameter.default)}` }];
    const body = lines.some((line) => line.marks.some((mark) => Number.isFinite(mark.y)))
      ? chart(lines, {
          label: `${yLabel} over ${parameter.name}`, xLabel: axisLabel(parameter), yLabel, height: 270,
          xLog: parameter.log, yLog: allPositive(lines), xEnds: parameterEnds(parameter), verticals,
        })
      : h("p", { class: "nothing" }, cloud ? "No point has this score."
          : "No curve: too few points, and no polynomial fits them. Choose “every point” instead.");
    return h("div", { "data-parameter": parameter.name }, parameterHead(parameter), body);
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
