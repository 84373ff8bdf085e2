// SPDX-License-Identifier: BSD-3-Clause
/**
 * A chart of few marks: lines that each have their own x, 95 % intervals, marks that differ in shape
 * as well as in colour.
 */
import { areaY, dot, line as lineMark, lineY, plot, ruleX, text, type Markish } from "@observablehq/plot";
import { h } from "../dom";
import { formatNumber, isNumber } from "../format";
import { extent } from "./axis";
import { figure, type Drawing } from "./figure";
import { plotted, shown, symbolOf, type Scale } from "./plot";
import { dashOf, seriesPaint } from "./svg";

export interface Mark {
  x: number;
  y: number;
  /** 95 % interval; NaN: none. */
  low?: number;
  high?: number;
  /** Shown after the numbers when the mark is read. */
  note?: string;
  /** Drawn as a cross; without a value at the upper edge. */
  cross?: boolean;
}

export interface Line {
  name: string;
  /** Decides colour, dash and mark. */
  index: number;
  marks: Mark[];
  /** Marks alone, faint. */
  scatter?: boolean;
  /** Marks without a line between them. */
  unjoined?: boolean;
  /** Line alone, thin; its marks can still be read. */
  plain?: boolean;
  /** Switched off at first. */
  hidden?: boolean;
  /** The interval as an area, not as bars. */
  band?: boolean;
}

export interface ChartOptions {
  /** What the chart shows, for those who cannot see it. */
  label: string;
  xLabel: string;
  yLabel: string;
  xLog?: boolean;
  yLog?: boolean;
  /** Ticks of x at whole numbers alone. */
  xWhole?: boolean;
  xEnds?: [number, number];
  yEnds?: [number, number];
  height?: number;
  /** The diagonal from (0, 0) to (1, 1): a random guess. */
  diagonal?: boolean;
  /** Lines side by side where they share their x: most pixels between neighbours. */
  dodge?: number;
  /** Upright lines. */
  verticals?: { x: number; label: string }[];
}

interface Axes {
  x: Scale;
  y: Scale;
}

function axesOf(lines: Line[], options: ChartOptions): Axes {
  const [xLog, yLog] = [options.xLog ?? false, options.yLog ?? false];
  const marks = lines.flatMap((line) => line.marks);
  const ys = marks.flatMap(({ y, low, high }) => [y, low, high].filter(isNumber));
  return {
    x: { label: options.xLabel, log: xLog, ends: options.xEnds ?? extent(marks.map(({ x }) => x), xLog), whole: options.xWhole ?? false },
    y: { label: options.yLabel, log: yLog, ends: options.yEnds ?? extent(ys, yLog) },
  };
}

/** How far a line stands aside of its x [px]; a fit stays where it is. */
function asideOf(lines: Line[], line: Line, dodge: number): number {
  if (line.plain) return 0;
  const marked = lines.filter((each) => !each.plain);
  return dodge * (marked.indexOf(line) - (marked.length - 1) / 2);
}

function intervalOf(line: Line, dx: number, { x, y }: Axes): Markish {
  const marks = line.marks.filter(({ x: at, low, high }) =>
    Number.isFinite(shown(at, x.log) + shown(low, y.log) + shown(high, y.log)));
  const where = { x: "x", y1: "low", y2: "high", ariaDescription: line.name };
  const paint = seriesPaint(line.index);
  return line.band ? areaY(marks, { ...where, fill: paint, fillOpacity: 0.14, className: "band" })
    : ruleX(marks, { ...where, dx, stroke: paint, strokeWidth: 1.2, marker: "tick-x", className: "bars" });
}

function marksOf(line: Line, dx: number, axes: Axes): Markish[] {
  const paint = seriesPaint(line.index);
  const y = ({ y: value }: Mark) => shown(value, axes.y.log);
  const known = line.marks.filter(({ x: at }) => Number.isFinite(shown(at, axes.x.log)));
  const where = { x: "x", y, dx, ariaDescription: line.name };
  const crosses = known.filter(({ cross }) => cross);
  const cross = { x: "x", dx, symbol: "times", r: 4, stroke: "var(--bad)", strokeWidth: 2, className: "cross", ariaDescription: line.name } as const;
  return [
    intervalOf(line, dx, axes),
    line.scatter || line.unjoined ? null
      : lineY(known, { ...where, stroke: paint, strokeWidth: line.plain ? 1 : 1.8, strokeDasharray: dashOf(line.index), className: "line" }),
    line.plain ? null : dot(known.filter((each) => !each.cross), {
      ...where, symbol: symbolOf(line.index), r: line.scatter ? 3 : 4, className: "marks", fill: paint,
      ...(line.scatter ? { fillOpacity: 0.4, stroke: paint } : { stroke: "var(--card)" }), strokeWidth: 0.8,
    }),
    dot(crosses.filter((each) => Number.isFinite(y(each))), { ...cross, y }),
    dot(crosses.filter((each) => !Number.isFinite(y(each))), { ...cross, y: () => axes.y.ends[1], dy: 6 }),
  ];
}

function guidesOf({ diagonal, verticals = [] }: ChartOptions, { x }: Axes): Markish[] {
  const [low, high] = x.ends;
  const inside = verticals.filter(({ x: at }) => at >= low && at <= high);
  const guide = { stroke: "var(--ink-soft)", strokeDasharray: "3 4" };
  const last = ({ x: at }: { x: number }) => (x.log ? Math.log(at / low) / Math.log(high / low) : (at - low) / (high - low)) > 0.75;
  const named = (end: boolean): Markish => text(inside.filter((each) => last(each) === end), {
    x: "x", text: "label", frameAnchor: "top", textAnchor: end ? "end" : "start", lineAnchor: "bottom", dx: end ? 4 : -4, dy: -4, fill: "var(--ink-soft)",
  });
  return [
    diagonal ? lineMark([[0, 0], [1, 1]], { ...guide, strokeWidth: 1 }) : null,
    ruleX(inside, { x: "x", ...guide }), named(false), named(true),
  ];
}

function textOf({ name }: Line, { x, y, low, high, note }: Mark, options: ChartOptions): string {
  const interval = isNumber(low) && isNumber(high) ? ` [${formatNumber(low)}, ${formatNumber(high)}]` : "";
  return `${name}: ${options.yLabel} ${formatNumber(y)}${interval} at ${options.xLabel} ${formatNumber(x)}${note ? `; ${note}` : ""}`;
}

function drawn(lines: Line[], options: ChartOptions, width: number): Drawing {
  const axes = axesOf(lines, options);
  const dodge = Math.min(options.dodge ?? 0, width / 150);
  const aside = (line: Line) => asideOf(lines, line, dodge);
  const top = options.verticals ? 24 : undefined;  // for their labels
  const drawing = plotted({ label: options.label, width, height: options.height ?? 300, top }, axes.x, axes.y,
    [...guidesOf(options, axes), ...lines.flatMap((line) => marksOf(line, aside(line), axes))]);
  for (const line of lines) {
    for (const mark of line.marks) {
      const x = drawing.at("x", shown(mark.x, axes.x.log)) + aside(line);
      const value = shown(mark.y, axes.y.log);
      if (!Number.isFinite(x) || (Number.isNaN(value) && !mark.cross)) continue;
      const y = Number.isNaN(value) ? drawing.at("y", axes.y.ends[1]) + 6 : drawing.at("y", value);
      drawing.places.push({ x, y, series: line.name, text: textOf(line, mark, options) });
    }
  }
  return drawing;
}

/** Line and mark of a legend's entry. */
function sampleOf(line: Line): SVGElement {
  const paint = seriesPaint(line.index);
  const sample = plot({
    width: 30, height: 12, margin: 0, axis: null, x: { domain: [0, 1] }, y: { domain: [0, 1] },
    marks: [
      line.scatter || line.unjoined ? null : lineMark([[0, 0.5], [1, 0.5]], { stroke: paint, strokeWidth: 1.8, strokeDasharray: dashOf(line.index) }),
      line.plain ? null : dot([[0.5, 0.5]], { symbol: symbolOf(line.index), r: 4, fill: paint }),
    ],
  }) as unknown as SVGElement;
  sample.setAttribute("aria-hidden", "true");
  return sample;
}

/** The chart with its legend, whose keys switch lines off and on. */
export function chart(lines: Line[], options: ChartOptions): HTMLElement {
  const off = new Set(lines.filter((line) => line.hidden));
  const on = () => lines.filter((line) => !off.has(line));
  const { element, redraw } = figure({
    kind: "chart", name: `${options.yLabel} over ${options.xLabel}`,
    draw: (width) => drawn(on(), options, width),
    keys: () => on().map((line) => ({ name: line.name, sample: sampleOf(line) })),
  });
  const keys = lines.map((line) => {
    const key = h("button", { type: "button", class: "key", "aria-pressed": String(!off.has(line)) }, sampleOf(line), line.name);
    key.addEventListener("click", () => {
      if (!off.delete(line)) off.add(line);
      key.setAttribute("aria-pressed", String(!off.has(line)));
      redraw();
    });
    return key;
  });
  element.append(h("div", { class: "legend", role: "group", "aria-label": "Lines" }, ...keys));
  return element;
}
