// SPDX-License-Identifier: BSD-3-Clause
/** SVG elements, and what marks of different series look like without colour. */

import { seriesDash, styleIndex } from "../palette";

const kNamespace = "http://www.w3.org/2000/svg";

/** An SVG element; text enters as text nodes only. */
export function svg<Tag extends keyof SVGElementTagNameMap>(
  tag: Tag, attributes: Record<string, string | number | null | undefined> = {},
  ...children: (Node | string)[]
): SVGElementTagNameMap[Tag] {
  const element = document.createElementNS(kNamespace, tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (value !== null && value !== undefined) element.setAttribute(name, String(value));
  }
  element.append(...children);
  return element;
}

/** Colour of a series as a CSS value that follows the theme. */
export function seriesPaint(index: number): string {
  return `var(--series-${styleIndex(index)})`;
}

/** Dash pattern of a series; with the mark it distinguishes series without colour. */
export function dashOf(index: number): string {
  return seriesDash(index).join(" ");
}

/** Outline of the mark of a series around (x, y) with radius r. */
export function markPath(index: number, x: number, y: number, r: number): string {
  const p = (dx: number, dy: number) => `${(x + dx * r).toFixed(1)},${(y + dy * r).toFixed(1)}`;
  switch ((styleIndex(index) + Math.floor(styleIndex(index) / 12)) % 6) {
    case 0:
      return `M${p(-1, 0)}a${r},${r} 0 1,0 ${2 * r},0a${r},${r} 0 1,0 ${-2 * r},0Z`;
    case 1:
      return `M${p(-0.9, -0.9)}L${p(0.9, -0.9)}L${p(0.9, 0.9)}L${p(-0.9, 0.9)}Z`;
    case 2:
      return `M${p(0, -1.15)}L${p(1.1, 0.85)}L${p(-1.1, 0.85)}Z`;
    case 3:
      return `M${p(0, -1.25)}L${p(1.25, 0)}L${p(0, 1.25)}L${p(-1.25, 0)}Z`;
    case 4:
      return `M${p(0, 1.15)}L${p(1.1, -0.85)}L${p(-1.1, -0.85)}Z`;
    default:
      return `M${p(-1.1, -0.4)}L${p(1.1, -0.4)}L${p(1.1, 0.4)}L${p(-1.1, 0.4)}Z`;
  }
}

/** A short line in the style of a series. */
export function lineSample(index: number): SVGElement {
  return svg("svg", { class: "line-sample", width: 30, height: 10, "aria-hidden": "true", style: `--paint: ${seriesPaint(index)}` },
    svg("path", { d: "M1,5H29", "stroke-dasharray": dashOf(index) }));
}

/** Draws now, and again whenever the width of `stage` changes. */
export function drawToFit(stage: HTMLElement, draw: () => void): void {
  let width = 0;
  new ResizeObserver(() => {
    if (stage.clientWidth === width) return;
    width = stage.clientWidth;
    draw();
  }).observe(stage);
  draw();
}
