// SPDX-License-Identifier: BSD-3-Clause
/** A drawing of the page as an SVG file that stands alone: light colours in place of variables, its legend below. */
import { h } from "../dom";
import { svg } from "./svg";

/** An entry of the legend. */
export interface Key {
  name: string;
  sample: SVGElement;
}

const kPaints = ["fill", "stroke"] as const;
const kKept = [
  "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "font-family", "font-size", "font-weight", "text-anchor",
  "paint-order",
];
const kRow = 20;
const kSample = 36;
const kFont = "12px system-ui, sans-serif";

/** Colours as #rrggbb with an opacity: what every reader of SVG understands. */
class Colors {
  private readonly ctx = Object.assign(h("canvas", {}), { width: 1, height: 1 }).getContext("2d", { willReadFrequently: true })!;
  private readonly known = new Map<string, { hex: string; alpha: number }>();

  of(text: string): { hex: string; alpha: number } {
    const found = this.known.get(text);
    if (found) return found;
    this.ctx.clearRect(0, 0, 1, 1);
    this.ctx.fillStyle = text;
    this.ctx.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = this.ctx.getImageData(0, 0, 1, 1).data as unknown as [number, number, number, number];
    const hex = `#${[r, g, b].map((each) => each.toString(16).padStart(2, "0")).join("")}`;
    const color = { hex, alpha: a / 255 };
    this.known.set(text, color);
    return color;
  }
}

/** What is drawn without any attribute. */
const kInitial: Record<string, string> = {
  fill: "#000000", "fill-opacity": "1", stroke: "none", "stroke-opacity": "1", "stroke-dasharray": "none", opacity: "1",
  "paint-order": "normal", "stroke-linejoin": "miter", "text-anchor": "start", "font-weight": "400",
};

/** Attributes that make an element look as the page shows it. */
function looksOf(element: Element, colors: Colors): Record<string, string> {
  const style = getComputedStyle(element);
  const looks: Record<string, string> = Object.fromEntries(kKept.map((name) => [name, style.getPropertyValue(name)]));
  for (const name of kPaints) {
    const value = style.getPropertyValue(name);
    const plain = value === "none" || value.startsWith("url");
    const { hex, alpha } = plain ? { hex: value, alpha: 1 } : colors.of(value);
    looks[name] = hex;
    looks[`${name}-opacity`] = String(Number((alpha * Number(style.getPropertyValue(`${name}-opacity`))).toFixed(3)));
  }
  return looks;
}

/** Takes the page's styles into the attributes of a copy, where they differ from those around it. */
function inline(from: Element, to: Element, colors: Colors, around: Record<string, string>): void {
  const looks = looksOf(from, colors);
  for (const [name, value] of Object.entries(looks)) {
    if (value === (name === "opacity" ? "1" : around[name])) to.removeAttribute(name);
    else to.setAttribute(name, value);
  }
  for (const name of ["class", "style", "tabindex", "role"]) to.removeAttribute(name);
  [...from.children].forEach((child, i) => inline(child, to.children[i]!, colors, looks));
}

/** Entries in rows of at most that width [px], and their height. */
function legend(keys: Key[], width: number): { element: SVGElement; height: number } {
  const element = svg("g", {});
  const measure = h("canvas", {}).getContext("2d")!;
  measure.font = kFont;
  let [x, y] = [12, 0];
  for (const { name, sample } of keys) {
    const size = kSample + measure.measureText(name).width + 18;
    if (x > 12 && x + size > width) [x, y] = [12, y + kRow];
    element.append(svg("g", { transform: `translate(${x},${y + 4})` }, sample,
      svg("text", { x: kSample, y: 10, style: `font: ${kFont}; fill: var(--ink)` }, name)));
    x += size;
  }
  return { element, height: keys.length > 0 ? y + kRow + 8 : 0 };
}

/** The text of the file. */
export function svgText(drawn: SVGSVGElement, title: string, keys: Key[]): string {
  const { width, height } = drawn.viewBox.baseVal;
  const below = legend(keys, width);
  below.element.setAttribute("transform", `translate(0,${height})`);
  const whole = svg("svg", { width, height: height + below.height, viewBox: `0 0 ${width} ${height + below.height}` },
    svg("title", {}, title), svg("rect", { width, height: height + below.height, fill: "#ffffff" }), drawn.cloneNode(true), below.element);
  whole.querySelectorAll("style, .ring").forEach((each) => each.remove());
  const root = document.documentElement;
  const before = root.dataset["theme"];
  root.dataset["theme"] = "light";
  // Styles are computed of what is in the document alone.
  const stage = h("div", { class: "chart saved" }, whole);
  document.body.append(stage);
  try {
    const copy = whole.cloneNode(true) as SVGSVGElement;
    inline(whole, copy, new Colors(), kInitial);
    return new XMLSerializer().serializeToString(copy);
  } finally {
    stage.remove();
    if (before) root.dataset["theme"] = before;
  }
}

/** Gives the reader the file. */
export function saveSvg(drawn: SVGSVGElement, name: string, keys: Key[]): void {
  const url = URL.createObjectURL(new Blob([svgText(drawn, name, keys)], { type: "image/svg+xml" }));
  const file = `${name.replace(/[^\p{L}\p{N}._-]+/gu, "-").replace(/^-+|-+$/g, "").slice(0, 80) || "chart"}.svg`;
  h("a", { href: url, download: file }).click();
  setTimeout(() => URL.revokeObjectURL(url), 1000);
}
