// SPDX-License-Identifier: BSD-3-Clause
/** Values over two quantities as coloured cells. */
import { dot, rect, text, type Markish } from "@observablehq/plot";
import { h } from "../dom";
import { formatNumber } from "../format";
import { unitScale } from "./axis";
import { figure, type Drawing } from "./figure";
import { plotted, type Scale } from "./plot";
import type { Key } from "./save_svg";
import { svg } from "./svg";

export interface HeatCell {
  x: number;
  y: number;
  /** NaN: none. */
  value: number;
}

export interface HeatMark {
  x: number;
  y: number;
  name: string;
  /** Drawn as a ring, else as a cross. */
  ring: boolean;
}

export interface HeatOptions {
  label: string;
  xLabel: string;
  yLabel: string;
  valueLabel: string;
  xLog: boolean;
  yLog: boolean;
  marks: HeatMark[];
}

/** Middle of each cell to its edges: half-way between neighbours, logarithmic where asked. */
function edgesOf(values: number[], log: boolean): number[] {
  const to = log ? Math.log : (value: number) => value;
  const back = log ? Math.exp : (value: number) => value;
  const at = values.map(to);
  const n = at.length;
  if (n === 1) return [back(at[0]! - 0.5), back(at[0]! + 0.5)];
  const middle = (i: number) => (at[i]! + at[i + 1]!) / 2;
  const edges = Array.from({ length: n - 1 }, (_, i) => middle(i));
  return [2 * at[0]! - edges[0]!, ...edges, 2 * at[n - 1]! - edges[n - 2]!].map(back);
}

/** A cell with its edges, and how deep its colour is, in [0, 1]. */
interface Box extends HeatCell {
  x1: number;
  x2: number;
  y1: number;
  y2: number;
  shade: number;
}

interface Grid {
  boxes: Box[];
  x: Scale;
  y: Scale;
  columns: number;
  scale: ReturnType<typeof unitScale>;
}

function gridOf(cells: HeatCell[], options: HeatOptions): Grid {
  const distinct = (values: number[]) => [...new Set(values)].sort((a, b) => a - b);
  const [xs, ys] = [distinct(cells.map(({ x }) => x)), distinct(cells.map(({ y }) => y))];
  const [xEdges, yEdges] = [edgesOf(xs, options.xLog), edgesOf(ys, options.yLog)];
  const scale = unitScale(cells.map(({ value }) => value).filter(Number.isFinite));
  const values = new Map(cells.map(({ x, y, value }) => [`${x} ${y}`, value]));
  const boxes = [...ys.keys()].reverse().flatMap((k) => xs.map((x, i): Box => {
    const value = values.get(`${x} ${ys[k]}`) ?? NaN;
    return {
      x, y: ys[k]!, value, shade: Number.isFinite(value) ? scale.at(value) : 0,
      x1: xEdges[i]!, x2: xEdges[i + 1]!, y1: yEdges[k]!, y2: yEdges[k + 1]!,
    };
  }));
  const axis = (label: string, log: boolean, edges: number[]): Scale => ({ label, log, ends: [edges[0]!, edges.at(-1)!] });
  return {
    boxes, columns: xs.length, scale,
    x: axis(options.xLabel, options.xLog, xEdges), y: axis(options.yLabel, options.yLog, yEdges),
  };
}

function paint(shade: number): string {
  return `color-mix(in oklab, var(--heat-deep) ${Math.round(100 * shade)}%, var(--card))`;
}

/** The cells' values, below a mark where there is one. */
function numbersOf(boxes: Box[], marks: HeatMark[]): Markish[] {
  const marked = ({ x1, x2, y1, y2 }: Box) => marks.some(({ x, y }) => x >= x1 && x <= x2 && y >= y1 && y <= y2);
  return [false, true].map((under) => text(boxes.filter((box) => marked(box) === under), {
    x: "x", y: "y", dy: under ? 20 : 0, className: "number",
    text: ({ value }: Box) => (Number.isFinite(value) ? formatNumber(value) : "none"),
    fill: { value: ({ shade }: Box) => (shade > 0.55 ? "var(--card)" : "var(--ink)"), scale: null },
  }));
}

function marksOf(marks: HeatMark[]): Markish[] {
  return marks.flatMap((mark) => [["var(--card)", 5], ["var(--bad)", 2.4]].map(([stroke, strokeWidth]) => dot([mark], {
    x: "x", y: "y", symbol: mark.ring ? "circle" : "times", r: 6, stroke: String(stroke), strokeWidth: Number(strokeWidth),
    ariaDescription: mark.name,
  })));
}

function drawn(grid: Grid, options: HeatOptions, width: number): Drawing {
  const height = Math.min(420, Math.max(260, 0.75 * width));
  const drawing = plotted({ label: options.label, width, height, grid: false }, grid.x, grid.y, [
    rect(grid.boxes.filter(({ value }) => Number.isFinite(value)), {
      x1: "x1", x2: "x2", y1: "y1", y2: "y2", inset: -0.25, className: "cells",
      fill: { value: ({ shade }: Box) => paint(shade), scale: null },
    }),
    ...(grid.columns <= 9 && (width - 70) / grid.columns > 48 ? numbersOf(grid.boxes, options.marks) : []),
    ...marksOf(options.marks),
  ]);
  for (const { x, y, value, x1, x2, y1, y2 } of grid.boxes) {
    const [left, right, top, bottom] = [drawing.at("x", x1), drawing.at("x", x2), drawing.at("y", y2), drawing.at("y", y1)];
    drawing.places.push({
      x: (left + right) / 2, y: (top + bottom) / 2, series: y, cell: [left, top, right - left, bottom - top],
      text: `${options.valueLabel} ${formatNumber(value)} at ${options.xLabel} ${formatNumber(x)}, ${options.yLabel} ${formatNumber(y)}`,
    });
  }
  return drawing;
}

/** Scale and marks of the file's legend. */
function keysOf({ scale }: Grid, { valueLabel, marks }: HeatOptions): Key[] {
  const swatch = (shade: number) => svg("rect", { width: 30, height: 12, style: `fill: ${paint(shade)}; stroke: var(--line)` });
  const mark = ({ ring }: HeatMark) => svg("path", {
    d: ring ? "M9,6a6,6 0 1,0 12,0a6,6 0 1,0 -12,0Z" : "M9,0l12,12m0,-12l-12,12", style: "fill: none; stroke: var(--bad); stroke-width: 2.4" });
  return [
    { name: `${formatNumber(scale.low)}, ${valueLabel}`, sample: swatch(0) }, { name: `${formatNumber(scale.high)}${scale.law}`, sample: swatch(1) },
    ...marks.map((each) => ({ name: each.name, sample: mark(each) })),
  ];
}

/** The map with its scale. */
export function heatMap(cells: HeatCell[], options: HeatOptions): HTMLElement {
  const grid = gridOf(cells, options);
  const { scale } = grid;
  const { element } = figure({
    kind: "chart heat-map", name: options.label, draw: (width) => drawn(grid, options, width), keys: () => keysOf(grid, options),
  });
  element.append(h("div", { class: "scale" }, formatNumber(scale.low), h("span", { class: "scale-bar deep" }),
    `${formatNumber(scale.high)}${scale.law}`,
    ...options.marks.map((mark) => h("span", {}, `${mark.ring ? "◯" : "✕"} ${mark.name}`))));
  return element;
}
