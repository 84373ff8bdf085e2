// SPDX-License-Identifier: BSD-3-Clause
/** Box plots: median, quartiles and range of each group's values, and every value as a mark. */
import "./charts.css";
import { h } from "../dom";
import { formatNumber } from "../format";
import { axis, extent } from "./axis";
import { drawToFit, seriesPaint, svg } from "./svg";

export interface BoxValue {
  value: number;
  /** Drawn as a cross. */
  failed: boolean;
  /** What it belongs to, shown when it is pointed at. */
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

/** The quantile of ascending values, between neighbours (type 7 of Hyndman and Fan). */
export function quantile(sorted: number[], fraction: number): number {
  if (sorted.length === 0) return NaN;
  const place = fraction * (sorted.length - 1);
  const low = Math.floor(place);
  const high = Math.min(low + 1, sorted.length - 1);
  return sorted[low]! + (place - low) * (sorted[high]! - sorted[low]!);
}

const kRow = 30;
const kBox = 13;

function cross(x: number, y: number): string {
  return `M${x - 3.5},${y - 3.5}l7,7m0,-7l-7,7`;
}

function drawGroup(group: BoxGroup, y: number, at: (value: number) => number): SVGElement {
  const shown = group.values.filter(({ value }) => Number.isFinite(at(value)));
  const sorted = shown.map(({ value }) => value).sort((a, b) => a - b);
  const drawn = svg("g", { class: "box", style: `--paint: ${seriesPaint(group.index)}`, "data-series": group.name });
  if (sorted.length > 2) {
    const [least, low, middle, high, most] = [0, 0.25, 0.5, 0.75, 1].map((each) => at(quantile(sorted, each))) as
      [number, number, number, number, number];
    drawn.append(
      svg("path", { class: "whisker", d: `M${least},${y}H${low}M${high},${y}H${most}M${least},${y - 4}v8M${most},${y - 4}v8` }),
      svg("rect", { class: "quartiles", x: low, y: y - kBox / 2, width: Math.max(high - low, 1), height: kBox }),
      svg("path", { class: "median", d: `M${middle},${y - kBox / 2 - 2}v${kBox + 4}` }));
  } else if (sorted.length > 0) {
    const middle = at(quantile(sorted, 0.5));
    drawn.append(svg("path", { class: "median", d: `M${middle},${y - kBox / 2 - 2}v${kBox + 4}` }));
  }
  shown.forEach(({ value, failed, note }, i) => {
    const lift = ((i % 3) - 1) * 3;
    const title = svg("title", {}, `${group.name}, ${note}: ${formatNumber(value)}${failed ? ", no success" : ""}`);
    drawn.append(failed
      ? svg("path", { class: "failed", d: cross(at(value), y + lift) }, title)
      : svg("circle", { class: "dot", cx: at(value), cy: y + lift, r: 2.6 }, title));
  });
  return drawn;
}

/** A row per group on a common axis, logarithmic where all values are above zero. */
export function boxPlot(groups: BoxGroup[], options: BoxOptions): HTMLElement {
  const stage = h("div", { class: "stage" });
  const draw = () => {
    const width = Math.max(240, stage.clientWidth || 600);
    const values = groups.flatMap((group) => group.values.map(({ value }) => value)).filter(Number.isFinite);
    const log = values.length > 0 && Math.min(...values) > 0;
    const longest = Math.max(3, ...groups.map(({ name }) => Math.min(name.length, 22)));
    const left = Math.min(14 + 7 * longest, width / 3);
    const inner = Math.max(80, width - left - 16);
    const x = axis(extent(values, log), log, Math.max(2, Math.floor(inner / 80)));
    const bottom = 6 + kRow * groups.length;
    const at = (value: number) => left + x.at(value) * inner;
    const drawing = svg("svg", { width, height: bottom + 40, viewBox: `0 0 ${width} ${bottom + 40}`, role: "img", "aria-label": options.label });
    for (const tick of x.ticks)
      drawing.append(svg("line", { class: "grid", x1: at(tick.value), x2: at(tick.value), y1: 4, y2: bottom }),
        svg("text", { x: at(tick.value), y: bottom + 14, "text-anchor": "middle" }, tick.label));
    drawing.append(svg("text", { class: "axis-label", x: left + inner / 2, y: bottom + 32, "text-anchor": "middle" }, options.xLabel));
    groups.forEach((group, i) => {
      const y = 6 + kRow * (i + 0.5);
      const name = group.name.length > 22 ? `${group.name.slice(0, 21)}…` : group.name;
      drawing.append(svg("text", { class: "name", x: left - 8, y: y + 4, "text-anchor": "end" }, name, svg("title", {}, group.name)),
        drawGroup(group, y, at));
      if (group.values.length === 0)
        drawing.append(svg("text", { x: left + 4, y: y + 4 }, "no value"));
    });
    stage.replaceChildren(drawing);
  };
  drawToFit(stage, draw);
  return h("figure", { class: "chart boxes" }, stage);
}
