// SPDX-License-Identifier: BSD-3-Clause
/** SVG elements, and colour and dash of series in them. */

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
