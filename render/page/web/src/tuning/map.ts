// SPDX-License-Identifier: BSD-3-Clause
/** The objective over two parameters. */
import { choice } from "../charts/controls";
import { heatMap, type HeatMark } from "../charts/heat_map";
import { h } from "../dom";
import { axisLabel, type Analysis, type Slice, type TunedEstimator } from "./model";

export interface Pair {
  first: number;
  second: number;
  /** "": all scenarios. */
  family?: string;
}

/** The pair that the objective depends on most, where that is known and its map is there. */
export function firstPair(analysis: Analysis): Pair | null {
  const total = analysis.sensitivity?.resolved ? analysis.sensitivity.total : [];
  const weight = (slice: Slice) => (total[slice.first] ?? 0) + (total[slice.second ?? 0] ?? 0);
  const best = analysis.maps.filter(({ family }) => family === "").reduce<Slice | null>((most, each) => !most || weight(each) > weight(most) ? each : most, null);
  return best && best.second !== undefined ? { first: best.first, second: best.second } : null;
}

/** The best point, where the map shows it, and where the defaults lie. */
function marksOf(own: TunedEstimator, analysis: Analysis, slice: Slice, x: number, y: number): HeatMark[] {
  const [px, py] = [own.parameters[x]!, own.parameters[y]!];
  const marks: HeatMark[] = [{ x: px.default, y: py.default, name: "default", ring: false }];
  const best = analysis.best?.values;
  const shown = best?.every((value, i) => i === x || i === y || value === slice.held_at[i]) ?? false;
  if (best && shown) marks.push({ x: best[x]!, y: best[y]!, name: "best point", ring: true });
  return marks;
}

/** Map of the chosen pair, in the order that was chosen. */
export function map(own: TunedEstimator, analysis: Analysis, pair: Pair, changed: (pair: Pair) => void): HTMLElement {
  const names = own.parameters.map((each, i) => ({ value: String(i), label: each.name }));
  const { first: x, second: y, family = "" } = pair;
  const families = [...new Set(analysis.maps.map((each) => each.family))];
  const slice = analysis.maps.find((each) => each.family === family &&
    ((each.first === x && each.second === y) || (each.first === y && each.second === x)));
  const turned = slice?.first !== x;
  const choose = (nextX: number, nextY: number) => changed(nextX === nextY
    ? { first: nextX, second: nextX === x ? x : y === nextX ? x : y, family } : { first: nextX, second: nextY, family });
  const bar = h("div", { class: "toolbar" },
    choice("x axis", names, String(x), (value) => choose(Number(value), Number(value) === y ? x : y)),
    choice("y axis", names, String(y), (value) => choose(Number(value) === x ? y : x, Number(value))),
    families.length > 1 ? choice("Scenarios", families.map((each) => ({ value: each, label: each || "all" })), family,
      (value) => changed({ first: x, second: y, family: value })) : null);
  const points = slice?.measured ?? slice?.fit;
  if (!slice || !points?.y || x === y) {
    return h("div", {}, bar, h("p", { class: "nothing" },
      "No map: the points are no grid over both parameters, and no fit is supported."));
  }
  const [xs, ys] = turned ? [points.y, points.x] : [points.x, points.y];
  const cells = Array.from(points.value, (value, i) => ({ x: xs[i]!, y: ys[i]!, value }));
  const [px, py] = [own.parameters[x]!, own.parameters[y]!];
  const marks = marksOf(own, analysis, slice, x, y);
  return h("div", {}, bar, heatMap(cells, {
    label: `Objective over ${px.name} and ${py.name}`, xLabel: axisLabel(px), yLabel: axisLabel(py),
    valueLabel: analysis.axis, xLog: px.log, yLog: py.log, marks,
  }), h("p", { class: "soft" }, (slice.measured ? "Measured at each point of the grid" : "By a fit through all points") +
    (slice.held ? `, at ${slice.held}` : "") +
    (marks.length > 1 ? "." : "; the best point lies elsewhere.")));
}
