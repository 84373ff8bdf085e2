// SPDX-License-Identifier: BSD-3-Clause
/**
 * A chart of few marks: lines that each have their own x, 95 % intervals, marks that differ in shape
 * as well as in colour. The values are read with the pointer or the arrow keys.
 */
import "./charts.css";
import { h } from "../dom";
import { formatNumber, isNumber } from "../format";
import { axis, extent, type Frame } from "./axis";
import { dashOf, drawToFit, markPath, seriesPaint, svg } from "./svg";

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
  /** Line alone, as thick as others. */
  bare?: boolean;
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
  xEnds?: [number, number];
  yEnds?: [number, number];
  height?: number;
  /** The diagonal from (0, 0) to (1, 1): a random guess. */
  diagonal?: boolean;
  /** Lines side by side where they share their x: most pixels between neighbours. */
  dodge?: number;
  /** Upright lines. */
  verticals?: { x: number; label: string }[];
  /** Shaded from one x to another, behind everything. */
  areas?: [number, number][];
  /** Without a legend: the page has one elsewhere. */
  quiet?: boolean;
}

/** How far a line stands aside of its x [px]. */
function shift(lines: Line[], line: Line, dodge: number): number {
  return dodge * (lines.indexOf(line) - (lines.length - 1) / 2);
}

interface Place {
  line: Line;
  mark: Mark;
  px: number;
  py: number;
}

const kRadius = 4;
const kReach = 30;

function px(frame: Frame, x: number): number {
  return frame.left + frame.x.at(x) * frame.width;
}

function py(frame: Frame, y: number): number {
  return frame.top + (1 - frame.y.at(y)) * frame.height;
}

function* allY(lines: Line[]): Generator<number> {
  for (const line of lines) {
    for (const mark of line.marks) {
      yield mark.y;
      if (isNumber(mark.low)) yield mark.low;
      if (isNumber(mark.high)) yield mark.high;
    }
  }
}

function frameOf(lines: Line[], options: ChartOptions, width: number, height: number): Frame {
  const xs = lines.flatMap((line) => line.marks.map((mark) => mark.x));
  const xEnds = options.xEnds ?? extent(xs, options.xLog ?? false);
  const yEnds = options.yEnds ?? extent(allY(lines), options.yLog ?? false);
  const y = axis(yEnds, options.yLog ?? false, Math.max(2, Math.floor(height / 45)));
  const longest = Math.max(2, ...y.ticks.map((tick) => tick.label.length));
  const left = 24 + 6.6 * longest;
  const inner = Math.max(60, width - left - 12);
  const x = axis(xEnds, options.xLog ?? false, Math.max(2, Math.floor(inner / 70)));
  return { x, y, left, top: 10, width: inner, height: height - 52 };
}

function drawAxes(frame: Frame, options: ChartOptions): SVGElement {
  const group = svg("g", { class: "axes" });
  const bottom = frame.top + frame.height;
  for (const tick of frame.x.ticks) {
    const at = px(frame, tick.value);
    group.append(svg("line", { class: "grid", x1: at, x2: at, y1: frame.top, y2: bottom }),
      svg("text", { x: at, y: bottom + 15, "text-anchor": "middle" }, tick.label));
  }
  for (const tick of frame.y.ticks) {
    const at = py(frame, tick.value);
    group.append(svg("line", { class: "grid", x1: frame.left, x2: frame.left + frame.width, y1: at, y2: at }),
      svg("text", { x: frame.left - 6, y: at + 4, "text-anchor": "end" }, tick.label));
  }
  const middle = frame.top + frame.height / 2;
  group.append(
    svg("text", { class: "axis-label", x: frame.left + frame.width / 2, y: bottom + 34, "text-anchor": "middle" },
      options.xLabel),
    svg("text", {
      class: "axis-label", x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})`,
    }, options.yLabel));
  return group;
}

function drawGuides(frame: Frame, options: ChartOptions): SVGElement {
  const group = svg("g", { class: "guides" });
  for (const [from, to] of options.areas ?? []) {
    const [left, right] = [px(frame, from), px(frame, to)];
    group.append(svg("rect", { class: "shade", x: left, y: frame.top, width: Math.max(right - left, 1), height: frame.height }));
  }
  if (options.diagonal) {
    group.append(svg("line", { x1: px(frame, 0), y1: py(frame, 0), x2: px(frame, 1), y2: py(frame, 1) }));
  }
  for (const each of options.verticals ?? []) {
    const at = px(frame, each.x);
    if (!Number.isFinite(at) || at < frame.left - 1 || at > frame.left + frame.width + 1) continue;
    const end = at > frame.left + 0.75 * frame.width;
    group.append(svg("line", { x1: at, x2: at, y1: frame.top, y2: frame.top + frame.height }),
      svg("text", { x: at + (end ? -4 : 4), y: frame.top + 11, "text-anchor": end ? "end" : "start" }, each.label));
  }
  return group;
}

function bars(frame: Frame, line: Line, aside: number): string {
  let path = "";
  for (const mark of line.marks) {
    if (!isNumber(mark.low) || !isNumber(mark.high)) continue;
    const x = px(frame, mark.x) + aside;
    const low = py(frame, mark.low);
    const high = py(frame, mark.high);
    if (![x, low, high].every(Number.isFinite)) continue;
    path += `M${x.toFixed(1)},${low.toFixed(1)}V${high.toFixed(1)}` +
      `M${(x - 3).toFixed(1)},${low.toFixed(1)}h6M${(x - 3).toFixed(1)},${high.toFixed(1)}h6`;
  }
  return path;
}

function bandPath(frame: Frame, line: Line): string {
  const marks = line.marks.filter((mark) => isNumber(mark.low) && isNumber(mark.high) &&
    Number.isFinite(py(frame, mark.low)) && Number.isFinite(py(frame, mark.high)));
  if (marks.length < 2) return "";
  const point = (mark: Mark, y: number) => `${px(frame, mark.x).toFixed(1)},${py(frame, y).toFixed(1)}`;
  return `M${marks.map((mark) => point(mark, mark.high!)).join("L")}L` +
    `${marks.reverse().map((mark) => point(mark, mark.low!)).join("L")}Z`;
}

function drawLine(frame: Frame, line: Line, aside: number, places: Place[]): SVGElement {
  const group = svg("g", {
    class: line.scatter ? "series scatter" : "series", style: `--paint: ${seriesPaint(line.index)}`,
    "data-series": line.name,
  });
  let path = "";
  let pen = "M";
  let marks = "";
  let crosses = "";
  for (const mark of line.marks) {
    const x = px(frame, mark.x) + aside;
    const known = Number.isFinite(py(frame, mark.y));
    if (!Number.isFinite(x) || (!known && !mark.cross)) {
      pen = "M";
      continue;
    }
    const y = known ? py(frame, mark.y) : frame.top + 6;
    places.push({ line, mark, px: x, py: y });
    if (known) path += `${pen}${x.toFixed(1)},${y.toFixed(1)}`;
    pen = known ? "L" : "M";
    if (mark.cross) {
      crosses += `M${(x - 4).toFixed(1)},${(y - 4).toFixed(1)}l8,8m0,-8l-8,8`;
    } else {
      marks += markPath(line.index, x, y, line.scatter ? kRadius - 1 : kRadius);
    }
  }
  if (line.band) group.append(svg("path", { class: "band", d: bandPath(frame, line) }));
  else group.append(svg("path", { class: "bars", d: bars(frame, line, aside) }));
  if (!line.scatter && !line.unjoined) group.append(svg("path", {
    class: line.plain ? "line thin" : "line", d: path, "stroke-dasharray": dashOf(line.index) }));
  if (!line.plain && !line.bare) group.append(svg("path", { class: "marks", d: marks }));
  if (crosses) group.append(svg("path", { class: "cross", d: crosses }));
  return group;
}

function readout(place: Place, options: ChartOptions): string {
  const { line, mark } = place;
  const interval = isNumber(mark.low) && isNumber(mark.high)
    ? ` [${formatNumber(mark.low)}, ${formatNumber(mark.high)}]` : "";
  return `${line.name}: ${options.yLabel} ${formatNumber(mark.y)}${interval} at ` +
    `${options.xLabel} ${formatNumber(mark.x)}${mark.note ? `; ${mark.note}` : ""}`;
}

/** The mark that the arrow keys go to. */
function stepped(places: Place[], current: Place | null, key: string): Place | null {
  if (!current) return places[0] ?? null;
  const own = places.filter((each) => each.line === current.line);
  const i = own.indexOf(current);
  if (key === "ArrowLeft") return own[Math.max(0, i - 1)] ?? null;
  if (key === "ArrowRight") return own[Math.min(own.length - 1, i + 1)] ?? null;
  const lines = [...new Set(places.map((each) => each.line))];
  const next = lines[(lines.indexOf(current.line) + (key === "ArrowUp" ? lines.length - 1 : 1)) % lines.length];
  const others = places.filter((each) => each.line === next);
  return others.reduce<Place | null>((best, each) =>
    !best || Math.abs(each.px - current.px) < Math.abs(best.px - current.px) ? each : best, null);
}

/** The chart with its legend, whose keys switch lines off and on; redrawn when its width changes. */
export function chart(lines: Line[], options: ChartOptions): HTMLElement {
  const off = new Set<Line>();
  const says = h("p", { class: "readout", "aria-live": "polite" });
  const stage = h("div", { class: "stage" });
  let places: Place[] = [];
  let current: Place | null = null;
  let ring: SVGElement | null = null;
  const read = (place: Place | null) => {
    current = place;
    ring?.setAttribute("d", place ? markPath(0, place.px, place.py, kRadius + 3) : "");
    says.textContent = place ? readout(place, options) : "";
  };
  const draw = () => {
    const width = Math.max(220, stage.clientWidth || 600);
    const height = options.height ?? 300;
    const shown = lines.filter((line) => !off.has(line));
    const frame = frameOf(shown, options, width, height);
    const dodge = Math.min(options.dodge ?? 0, frame.width / 150);
    places = [];
    ring = svg("path", { class: "ring" });
    const drawing = svg("svg", {
      width, height, viewBox: `0 0 ${width} ${height}`, role: "img", tabindex: 0, "aria-label": options.label,
    }, drawGuides(frame, options), drawAxes(frame, options),
      ...shown.map((line) => drawLine(frame, line, shift(shown, line, dodge), places)), ring);
    drawing.addEventListener("pointermove", (event) => {
      const box = drawing.getBoundingClientRect();
      const distance = (place: Place) =>
        Math.hypot(place.px - (event.clientX - box.left), place.py - (event.clientY - box.top));
      const near = places.reduce<Place | null>((best, each) =>
        !best || distance(each) < distance(best) ? each : best, null);
      read(near && distance(near) < kReach ? near : null);
    });
    drawing.addEventListener("keydown", (event) => {
      if (!event.key.startsWith("Arrow")) return;
      event.preventDefault();
      read(stepped(places, current, event.key));
    });
    stage.replaceChildren(drawing);
    read(null);
  };
  drawToFit(stage, draw);
  return h("figure", { class: "chart" }, stage, says, options.quiet ? "" : legend(lines, off, draw));
}

function legend(lines: Line[], off: Set<Line>, changed: () => void): HTMLElement {
  const keys = lines.map((line) => {
    const sample = svg("svg", { width: 30, height: 12, "aria-hidden": "true", style: `--paint: ${seriesPaint(line.index)}` });
    if (!line.scatter && !line.unjoined) {
      sample.append(svg("path", { class: "line", d: "M1,6H29", "stroke-dasharray": dashOf(line.index) }));
    }
    if (!line.plain && !line.bare) sample.append(svg("path", { class: "marks", d: markPath(line.index, 15, 6, kRadius) }));
    const key = h("button", { type: "button", class: "key", "aria-pressed": "true" }, sample, line.name);
    key.addEventListener("click", () => {
      if (!off.delete(line)) off.add(line);
      key.setAttribute("aria-pressed", String(!off.has(line)));
      changed();
    });
    return key;
  });
  return h("div", { class: "legend", role: "group", "aria-label": "Lines" }, ...keys);
}
