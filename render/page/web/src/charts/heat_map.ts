// SPDX-License-Identifier: BSD-3-Clause
/** Values over two quantities as coloured cells; read with the pointer or the arrow keys. */
import "./charts.css";
import { h } from "../dom";
import { formatNumber } from "../format";
import { axis, unitScale, type Frame } from "./axis";
import { drawToFit, svg } from "./svg";

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

function distinct(values: number[]): number[] {
  return [...new Set(values)].sort((a, b) => a - b);
}

const kPaint = "color-mix(in oklab, var(--heat-deep) var(--shade), var(--card))";

function ticks(frame: Frame, options: HeatOptions): SVGElement[] {
  const bottom = frame.top + frame.height;
  const middle = frame.top + frame.height / 2;
  return [
    ...frame.x.ticks.map((tick) => svg("text", {
      x: frame.left + frame.x.at(tick.value) * frame.width, y: bottom + 15, "text-anchor": "middle",
    }, tick.label)),
    ...frame.y.ticks.map((tick) => svg("text", {
      x: frame.left - 6, y: frame.top + (1 - frame.y.at(tick.value)) * frame.height + 4, "text-anchor": "end",
    }, tick.label)),
    svg("text", { class: "axis-label", x: frame.left + frame.width / 2, y: bottom + 34, "text-anchor": "middle" },
      options.xLabel),
    svg("text", {
      class: "axis-label", x: 12, y: middle, "text-anchor": "middle", transform: `rotate(-90 12 ${middle})`,
    }, options.yLabel),
  ];
}

function drawMarks(frame: Frame, marks: HeatMark[]): SVGElement[] {
  return marks.flatMap((mark) => {
    const x = frame.left + frame.x.at(mark.x) * frame.width;
    const y = frame.top + (1 - frame.y.at(mark.y)) * frame.height;
    if (!Number.isFinite(x) || !Number.isFinite(y)) return [];
    const d = mark.ring ? `M${x - 6},${y}a6,6 0 1,0 12,0a6,6 0 1,0 -12,0Z` : `M${x - 6},${y - 6}l12,12m0,-12l-12,12`;
    return [svg("path", { class: "best-halo", d }), svg("path", { class: "best-mark", d }, svg("title", {}, mark.name))];
  });
}

/** The map with its scale. */
export function heatMap(cells: HeatCell[], options: HeatOptions): HTMLElement {
  const xs = distinct(cells.map((cell) => cell.x));
  const ys = distinct(cells.map((cell) => cell.y));
  const xEdges = edgesOf(xs, options.xLog);
  const yEdges = edgesOf(ys, options.yLog);
  const scale = unitScale(cells.map((cell) => cell.value).filter(Number.isFinite));
  const byPlace = new Map(cells.map((cell) => [`${cell.x} ${cell.y}`, cell.value]));
  const says = h("p", { class: "readout", "aria-live": "polite" });
  const stage = h("div", { class: "stage" });
  let at: [number, number] | null = null;

  const draw = () => {
    const width = Math.max(220, stage.clientWidth || 500);
    const height = Math.min(420, Math.max(260, 0.75 * width));
    const y = axis([yEdges[0]!, yEdges[yEdges.length - 1]!], options.yLog, Math.floor(height / 45));
    const left = 24 + 6.6 * Math.max(2, ...y.ticks.map((tick) => tick.label.length));
    const inner = width - left - 12;
    const x = axis([xEdges[0]!, xEdges[xEdges.length - 1]!], options.xLog, Math.max(2, Math.floor(inner / 70)));
    const frame: Frame = { x, y, left, top: 8, width: inner, height: height - 52 };
    const spanX = (i: number) => [xEdges[i]!, xEdges[i + 1]!].map((edge) => left + x.at(edge) * inner) as [number, number];
    const spanY = (i: number) => [yEdges[i + 1]!, yEdges[i]!].map((edge) => frame.top + (1 - y.at(edge)) * frame.height) as [number, number];
    const marked = (x0: number, x1: number, y0: number, y1: number) => options.marks.some((mark) => {
      const mx = left + x.at(mark.x) * inner;
      const my = frame.top + (1 - y.at(mark.y)) * frame.height;
      return mx >= x0 && mx <= x1 && my >= y0 && my <= y1;
    });
    const numbers = xs.length <= 9 && inner / xs.length > 48;
    const ring = svg("rect", { class: "ring", width: 0, height: 0 });
    const drawing = svg("svg", { width, height, viewBox: `0 0 ${width} ${height}`, role: "img", tabindex: 0, "aria-label": options.label });
    xs.forEach((xv, i) => ys.forEach((yv, k) => {
      const value = byPlace.get(`${xv} ${yv}`) ?? NaN;
      const [x0, x1] = spanX(i);
      const [y0, y1] = spanY(k);
      const known = Number.isFinite(value);
      const shade = known ? Math.round(100 * scale.at(value)) : 0;
      drawing.append(svg("rect", {
        class: "cell", x: x0, y: y0, width: Math.max(0, x1 - x0 + 0.5), height: Math.max(0, y1 - y0 + 0.5),
        style: known ? `--shade: ${shade}%; fill: ${kPaint}` : "fill: none",
      }));
      if (numbers) {
        drawing.append(svg("text", {
          x: (x0 + x1) / 2, y: (y0 + y1) / 2 + (marked(x0, x1, y0, y1) ? 24 : 4), "text-anchor": "middle",
          style: `fill: ${shade > 55 ? "var(--card)" : "var(--ink)"}`,
        }, known ? formatNumber(value) : "none"));
      }
    }));
    drawing.append(...ticks(frame, options), ...drawMarks(frame, options.marks), ring);
    const read = (place: [number, number] | null) => {
      at = place;
      if (!place) {
        says.textContent = "";
        return;
      }
      const [i, k] = place;
      const [x0, x1] = spanX(i);
      const [y0, y1] = spanY(k);
      for (const [name, value] of Object.entries({ x: x0, y: y0, width: x1 - x0, height: y1 - y0 })) {
        ring.setAttribute(name, String(value));
      }
      says.textContent = `${options.valueLabel} ${formatNumber(byPlace.get(`${xs[i]} ${ys[k]}`) ?? NaN)} at ` +
        `${options.xLabel} ${formatNumber(xs[i])}, ${options.yLabel} ${formatNumber(ys[k])}`;
    };
    drawing.addEventListener("pointermove", (event) => {
      const box = drawing.getBoundingClientRect();
      const px = event.clientX - box.left;
      const py = event.clientY - box.top;
      const i = xs.findIndex((_, n) => px >= spanX(n)[0] && px <= spanX(n)[1]);
      const k = ys.findIndex((_, n) => py >= spanY(n)[0] && py <= spanY(n)[1]);
      if (i >= 0 && k >= 0) read([i, k]);
    });
    drawing.addEventListener("keydown", (event) => {
      const step = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] }[event.key];
      if (!step) return;
      event.preventDefault();
      const [i, k] = at ?? [0, 0];
      read(at ? [Math.min(xs.length - 1, Math.max(0, i + step[0]!)), Math.min(ys.length - 1, Math.max(0, k + step[1]!))] : [0, 0]);
    });
    stage.replaceChildren(drawing);
  };
  drawToFit(stage, draw);
  return h("figure", { class: "heat-map" }, stage, says,
    h("div", { class: "scale" }, formatNumber(scale.low), h("span", { class: "scale-bar deep" }),
      `${formatNumber(scale.high)}${scale.law}`,
      ...options.marks.map((mark) => h("span", {}, `${mark.ring ? "◯" : "✕"} ${mark.name}`))));
}
