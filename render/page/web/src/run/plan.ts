// SPDX-License-Identifier: BSD-3-Clause
/** The plan: walls, truth and estimates from above. A long corridor is stretched across. */
import { axis, type Axis } from "../charts/axis";
import { figure } from "../charts/figure";
import { dashOf, lineSample, seriesPaint, svg } from "../charts/svg";
import type { RunPayload } from "../contract";
import { h } from "../dom";
import { formatNumber, isNumber } from "../format";
import type { ErrorTrack } from "./errors";
import { layered } from "./layers";

/** The axes follow estimates up to this far from the truth [m]. */
const kFollow = 2;
const kLeastHeight = 150;
const kMostHeight = 420;
const kMargin = { left: 46, right: 12, top: 10, bottom: 40 };

export interface PlanLine {
  name: string;
  index: number;
  track: ErrorTrack;
}

interface Extent {
  min: [number, number];
  max: [number, number];
}

/** Of the truth, and of estimates while they are near it, with some air. */
export function planExtent(data: RunPayload, lines: PlanLine[]): Extent | null {
  const extent: Extent = { min: [Infinity, Infinity], max: [-Infinity, -Infinity] };
  const take = (x: number, y: number) => {
    if (!Number.isFinite(x + y)) return;
    extent.min = [Math.min(extent.min[0], x), Math.min(extent.min[1], y)];
    extent.max = [Math.max(extent.max[0], x), Math.max(extent.max[1], y)];
  };
  const p = data.truth?.p ?? [];
  for (let i = 0; i + 2 < p.length; i += 3) take(p[i]!, p[i + 1]!);
  for (const { track } of lines)
    track.error.forEach((error, i) => { if (error <= kFollow) take(track.p[3 * i]!, track.p[3 * i + 1]!); });
  if (extent.min[0] > extent.max[0]) return null;
  const air = [0.03 * (extent.max[0] - extent.min[0]) + 0.5, 1.2] as const;
  return {
    min: [extent.min[0] - air[0], extent.min[1] - air[1]],
    max: [extent.max[0] + air[0], extent.max[1] + air[1]],
  };
}

interface Frame {
  long: Axis;
  across: Axis;
  /** Does x run from left to right? Else y does, and x upwards. */
  plain: boolean;
  width: number;
  height: number;
  stretch: number;
}

/** The longer side lies along the width; the shorter one is stretched to the least height. */
export function planFrame({ min, max }: Extent, width: number): Frame {
  const size = [max[0] - min[0], max[1] - min[1]] as const;
  const plain = size[0] >= size[1];
  const [along, across] = plain ? [0, 1] as const : [1, 0] as const;
  const equal = (width * size[across]) / size[along];
  const height = Math.min(Math.max(equal, kLeastHeight), kMostHeight);
  let ends: [number, number] = [min[along], max[along]];
  if (height < equal) {
    const more = (0.5 * (equal / height - 1)) * size[along];
    ends = [ends[0] - more, ends[1] + more];
  }
  const sides: [number, number] = plain ? [min[1], max[1]] : [max[0], min[0]];
  return {
    long: axis(ends, false, Math.max(3, Math.floor(width / 80))),
    across: axisOf(sides, Math.max(2, Math.floor(height / 40))),
    plain, width, height,
    stretch: Math.max(1, height / equal),
  };
}

/** An axis that may run downwards: its ticks stand where those of the upright one do. */
function axisOf([from, to]: [number, number], most: number): Axis {
  if (from < to) return axis([from, to], false, most);
  const upright = axis([to, from], false, most);
  return { ...upright, at: (value) => 1 - upright.at(value) };
}

function pathOf(frame: Frame, count: number, at: (i: number) => [number, number]): string {
  let path = "";
  let pen = "M";
  for (let i = 0; i < count; ++i) {
    const [x, y] = at(i);
    if (!Number.isFinite(x + y)) {
      pen = "M";
      continue;
    }
    const [px, py] = place(frame, x, y);
    // Far beyond the frame a drawing has no place for numbers.
    if (Math.abs(px) > 1e5 || Math.abs(py) > 1e5) {
      pen = "M";
      continue;
    }
    path += `${pen}${px.toFixed(1)},${py.toFixed(1)}`;
    pen = "L";
  }
  return path;
}

function place(frame: Frame, x: number, y: number): [number, number] {
  const [along, across] = frame.plain ? [x, y] : [y, x];
  return [
    kMargin.left + frame.long.at(along) * frame.width,
    kMargin.top + (1 - frame.across.at(across)) * frame.height,
  ];
}

function wallPath(data: RunPayload, frame: Frame): string {
  const edges = data.scene?.edges ?? [];
  let path = "";
  for (let i = 0; i + 5 < edges.length; i += 6) {
    const [ax, ay] = place(frame, edges[i]!, edges[i + 1]!);
    const [bx, by] = place(frame, edges[i + 3]!, edges[i + 4]!);
    if (Math.hypot(ax - bx, ay - by) > 0.3) path += `M${ax.toFixed(1)},${ay.toFixed(1)}L${bx.toFixed(1)},${by.toFixed(1)}`;
  }
  return path;
}

function axes(frame: Frame): SVGElement {
  const group = svg("g", { class: "axes" });
  const bottom = kMargin.top + frame.height;
  for (const tick of frame.long.ticks) {
    const at = kMargin.left + frame.long.at(tick.value) * frame.width;
    group.append(svg("line", { class: "grid", x1: at, x2: at, y1: kMargin.top, y2: bottom }),
      svg("text", { x: at, y: bottom + 14, "text-anchor": "middle" }, tick.label));
  }
  for (const tick of frame.across.ticks) {
    const at = kMargin.top + (1 - frame.across.at(tick.value)) * frame.height;
    group.append(svg("line", { class: "grid", x1: kMargin.left, x2: kMargin.left + frame.width, y1: at, y2: at }),
      svg("text", { x: kMargin.left - 6, y: at + 4, "text-anchor": "end" }, tick.label));
  }
  const [long, across] = frame.plain ? ["x", "y"] : ["y", "x"];
  const middle = kMargin.top + frame.height / 2;
  const drawn = frame.stretch > 1.05 ? `, ${formatNumber(frame.stretch, 2)}× larger` : "";
  group.append(
    svg("text", { class: "axis-label", x: kMargin.left + frame.width / 2, y: bottom + 31, "text-anchor": "middle" }, `${long} [m]`),
    svg("text", { class: "axis-label", x: 11, y: middle, "text-anchor": "middle", transform: `rotate(-90 11 ${middle})` },
      `${across} [m]${drawn}`));
  return group;
}

/** Reference points of the route, each once. */
function points(data: RunPayload, frame: Frame): SVGElement {
  const group = svg("g", { class: "points" });
  const seen = new Set<string>();
  for (const { name, x, y } of data.waypoint_times ?? []) {
    if (seen.has(name) || !isNumber(x) || !isNumber(y)) continue;
    seen.add(name);
    const [px, py] = place(frame, x, y);
    const shown = name.slice(0, 12);
    const beyond = px + 6 + 8 * shown.length > kMargin.left + frame.width;
    group.append(svg("circle", { cx: px, cy: py, r: 3.5 }),
      svg("text", { x: px + (beyond ? -6 : 6), y: py - 5, "text-anchor": beyond ? "end" : "start" }, shown));
  }
  return group;
}

/** Where the estimate ends. */
function endOf({ name, index, track }: PlanLine, frame: Frame): SVGElement {
  const last = track.p.length - 3;
  const [cx, cy] = place(frame, track.p[last] ?? NaN, track.p[last + 1] ?? NaN);
  return svg("circle", { class: "end", "data-end": name, cx, cy, r: Number.isFinite(cx + cy) ? 4 : 0, style: `--paint: ${seriesPaint(index)}` });
}

/** Does any of the path lie beside the frame? */
export function isBeyond({ min, max }: Extent, { track }: PlanLine): boolean {
  return track.error.some((_, i) => ([0, 1] as const).some((axis) => track.p[3 * i + axis]! < min[axis] || track.p[3 * i + axis]! > max[axis]));
}

function drawn(data: RunPayload, lines: PlanLine[], extent: Extent, outer: number): SVGSVGElement {
  const id = "plan-clip";
  const frame = planFrame(extent, outer - kMargin.left - kMargin.right);
  const height = frame.height + kMargin.top + kMargin.bottom;
  const truth = data.truth?.p ?? new Float32Array();
  const layers = layered(lines);
  const clip = svg("clipPath", { id }, svg("rect", {
    x: kMargin.left, y: kMargin.top, width: frame.width, height: frame.height }));
  const inside = svg("g", { "clip-path": `url(#${id})` },
    svg("path", { class: "walls", d: wallPath(data, frame) }),
    svg("path", { class: "truth", "stroke-width": (layers[0]?.width ?? 1) + 3, d: pathOf(frame, truth.length / 3, (i) => [truth[3 * i]!, truth[3 * i + 1]!]) }),
    ...layers.map(({ item: { name, index, track }, width }) => svg("path", {
      class: "line", "data-series": name, style: `--paint: ${seriesPaint(index)}`, "stroke-width": width, "stroke-dasharray": dashOf(index),
      d: pathOf(frame, track.t.length, (i) => [track.p[3 * i]!, track.p[3 * i + 1]!]),
    })), ...layers.map(({ item }) => endOf(item, frame)), points(data, frame));
  return svg("svg", {
    class: "plan", width: outer, height, viewBox: `0 0 ${outer} ${height}`, "aria-label": "Walls, true path and estimated paths from above",
  }, clip, axes(frame), inside);
}

/** The drawing, and again when its width changes; null without any path. */
export function planView(data: RunPayload, lines: PlanLine[]): HTMLElement | null {
  const extent = planExtent(data, lines);
  if (!extent) return null;
  const beyond = lines.filter((line) => isBeyond(extent, line)).map(({ name }) => name);
  const plan = figure({
    kind: "chart", name: `Plan of ${data.title}`,
    draw: (width) => ({ svg: drawn(data, lines, extent, width), places: [] }),
    keys: () => lines.map(({ name, index }) => ({ name, sample: lineSample(index) })),
  }).element;
  plan.append(h("p", { class: "soft hint", "data-beyond": beyond.length },
    `Dots: where estimates end.${beyond.length > 0 ? ` Beyond this plan: ${beyond.join(", ")}.` : ""}`));
  return plan;
}
