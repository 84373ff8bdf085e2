// SPDX-License-Identifier: BSD-3-Clause
/** A figure: a drawing as wide as its place, whose values the pointer or the arrow keys read, saved as SVG. */
import "./charts.css";
import { h } from "../dom";
import { saveSvg, type Key } from "./save_svg";
import { drawToFit, svg } from "./svg";

/** Where a drawing shows a value [px], and what is said of it. */
export interface Place {
  x: number;
  y: number;
  /** Left and right stay in a series, up and down go to another. */
  series: string | number;
  text: string;
  /** Of a cell: left, top, width and height [px]. */
  cell?: [number, number, number, number];
}

export interface Drawing {
  svg: SVGSVGElement;
  places: Place[];
}

export interface FigureOptions {
  /** Class of the figure. */
  kind: string;
  /** What it shows, for the name of its file. */
  name: string;
  draw: (width: number) => Drawing;
  /** Legend of the file. */
  keys?: () => Key[];
}

const kReach = 30;

function distance({ x, y, cell }: Place, px: number, py: number): number {
  if (!cell) return Math.hypot(x - px, y - py);
  const [left, top, width, height] = cell;
  const beyond = (at: number, from: number, size: number) => Math.max(from - at, at - from - size, 0);
  return Math.hypot(beyond(px, left, width), beyond(py, top, height));
}

function nearest(places: Place[], measure: (place: Place) => number): Place | null {
  return places.reduce<Place | null>((best, each) => (!best || measure(each) < measure(best) ? each : best), null);
}

/** The place that the arrow keys go to. */
function stepped(places: Place[], current: Place | null, key: string): Place | null {
  if (!current) return places[0] ?? null;
  const own = places.filter(({ series }) => series === current.series);
  const i = own.indexOf(current);
  if (key === "ArrowLeft") return own[Math.max(0, i - 1)] ?? null;
  if (key === "ArrowRight") return own[Math.min(own.length - 1, i + 1)] ?? null;
  const all = [...new Set(places.map(({ series }) => series))];
  const next = all[(all.indexOf(current.series) + (key === "ArrowUp" ? all.length - 1 : 1)) % all.length];
  return nearest(places.filter(({ series }) => series === next), ({ x }) => Math.abs(x - current.x));
}

function ringPath({ x, y, cell }: Place): string {
  if (!cell) return `M${x - 7},${y}a7,7 0 1,0 14,0a7,7 0 1,0 -14,0Z`;
  const [left, top, width, height] = cell;
  return `M${left},${top}h${width}v${height}h${-width}Z`;
}

/** The figure, and how to draw it again. */
export function figure({ kind, name, draw, keys }: FigureOptions): { element: HTMLElement; redraw: () => void } {
  const says = h("p", { class: "readout", "aria-live": "polite" });
  const stage = h("div", { class: "stage" });
  const ring = svg("path", { class: "ring" });
  let drawing: Drawing | null = null;
  let current: Place | null = null;
  const read = (place: Place | null) => {
    current = place;
    ring.setAttribute("d", place ? ringPath(place) : "");
    says.textContent = place?.text ?? "";
  };
  const redraw = () => {
    drawing = draw(Math.max(220, stage.clientWidth || 600));
    const { svg: drawn, places } = drawing;
    drawn.setAttribute("role", "img");
    drawn.setAttribute("tabindex", "0");
    drawn.append(ring);
    drawn.addEventListener("pointermove", (event) => {
      const box = drawn.getBoundingClientRect();
      const far = (place: Place) => distance(place, event.clientX - box.left, event.clientY - box.top);
      const near = nearest(places, far);
      read(near && far(near) < (near.cell ? 1 : kReach) ? near : null);
    });
    drawn.addEventListener("keydown", (event) => {
      if (!event.key.startsWith("Arrow")) return;
      event.preventDefault();
      read(stepped(places, current, event.key));
    });
    stage.replaceChildren(drawn);
    read(null);
  };
  drawToFit(stage, redraw);
  const save = h("button", {
    type: "button", class: "quiet save", title: "Save this chart as an SVG file", "aria-label": `Save as SVG: ${name}`,
    onclick: () => drawing && saveSvg(drawing.svg, name, keys?.() ?? []),
  }, "SVG");
  return { element: h("figure", { class: kind }, stage, h("div", { class: "figure-foot" }, says, save)), redraw };
}
