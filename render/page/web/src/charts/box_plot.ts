// SPDX-License-Identifier: BSD-3-Clause
/** Box plots: median, quartiles and range of each group's values, and every value as a mark. */
import { barX, dot, groupY, ruleY, text, tickX, type Markish } from "@observablehq/plot";
import { formatNumber } from "../format";
import { extent } from "./axis";
import { figure, type Drawing } from "./figure";
import { plottedRows, shown } from "./plot";
import { seriesPaint } from "./svg";

export interface BoxValue {
  value: number;
  /** Drawn as a cross. */
  failed: boolean;
  /** What it belongs to, shown when it is read. */
  note: string;
}

export interface BoxGroup {
  name: string;
  /** Of its style in the palette. */
  index: number;
  values: BoxValue[];
}

export interface BoxOptions {
  label: string;
  xLabel: string;
}

const kRow = 30;
/** Marks of neighbours lie apart [px]. */
const kLift = 3;
/** Fewer values have no quartiles. */
const kLeast = 3;

function marksOf({ name, index, values }: BoxGroup): Markish[] {
  const paint = seriesPaint(index);
  const where = { x: "value", y: () => name, ariaDescription: name };
  if (values.length === 0) return [text([name], { y: [name], text: ["no value"], frameAnchor: "left", dx: 4, fill: "var(--ink-soft)" })];
  const box = values.length < kLeast ? [] : [
    ruleY(values, groupY({ x1: "min", x2: "max" }, { ...where, stroke: paint, marker: "tick-y", className: "whisker" })),
    barX(values, groupY({ x1: "p25", x2: "p75" }, { ...where, fill: "var(--card)", className: "ground" })),
    barX(values, groupY({ x1: "p25", x2: "p75" }, { ...where, fill: paint, fillOpacity: 0.2, stroke: paint, className: "quartiles" })),
  ];
  const marks = [0, 1, 2].flatMap((third) => {
    const own = values.filter((_, i) => i % 3 === third);
    const dy = (third - 1) * kLift;
    return [
      dot(own.filter(({ failed }) => !failed), { ...where, dy, r: 2.6, fill: paint, stroke: "var(--card)", strokeWidth: 0.7, className: "dots" }),
      dot(own.filter(({ failed }) => failed), { ...where, dy, r: 3, symbol: "times", stroke: "var(--bad)", strokeWidth: 1.7, className: "failed" }),
    ];
  });
  return [...box, tickX(values, groupY({ x: "median" }, { ...where, stroke: paint, strokeWidth: 2.6, className: "median" })), ...marks];
}

function drawn(groups: BoxGroup[], options: BoxOptions, width: number): Drawing {
  const log = groups.every(({ values }) => values.every(({ value }) => value > 0));
  const known = groups.map((group) => ({ ...group, values: group.values.filter(({ value }) => Number.isFinite(shown(value, log))) }));
  const x = { label: options.xLabel, log, ends: extent(known.flatMap(({ values }) => values.map(({ value }) => value)), log) };
  const drawing = plottedRows(options.label, width, kRow, x, known.map(({ name }) => name), known.flatMap(marksOf));
  for (const { name, values } of known) {
    drawing.places.push(...values.map(({ value, failed, note }, i) => ({
      x: drawing.at("x", value), y: drawing.at("y", name) + ((i % 3) - 1) * kLift, series: name,
      text: `${name}, ${note}: ${formatNumber(value)}${failed ? ", no success" : ""}`,
    })));
  }
  return drawing;
}

/** A row per group on a common axis, logarithmic where all values are above zero. */
export function boxPlot(groups: BoxGroup[], options: BoxOptions): HTMLElement {
  return figure({ kind: "chart boxes", name: options.label, draw: (width) => drawn(groups, options, width) }).element;
}
