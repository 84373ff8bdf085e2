// SPDX-License-Identifier: BSD-3-Clause
/** Colours and dashes of series: the table of core/series_style.cpp, as every page carries it. */
import type { SeriesStyle } from "./contract";

let styles: SeriesStyle[] = [{ light: "#2a24de", dark: "#455ef8", dash: [] }];

/** Takes the page's table; its colours become the CSS variables --series-0, --series-1, ... */
export function usePalette(table: SeriesStyle[] | null | undefined): void {
  if (table && table.length > 0) styles = table;
  const hex = (text: string) => (/^#[0-9a-f]{6}$/i.test(text) ? text : "#808080");
  const list = (key: "light" | "dark") =>
    styles.map((style, i) => `--series-${i}: ${hex(style[key])};`).join(" ");
  const sheet = document.createElement("style");
  sheet.textContent = `:root { ${list("light")} } :root[data-theme="dark"] { ${list("dark")} }`;
  document.head.append(sheet);
}

/** Place of a style in the table; cyclic. */
export function styleIndex(index: number): number {
  const whole = Number.isFinite(index) ? Math.trunc(index) : 0;
  return ((whole % styles.length) + styles.length) % styles.length;
}

/** Lengths of line and gap in turn [px]; none for a solid line. */
export function seriesDash(index: number): number[] {
  const dash = styles[styleIndex(index)]!.dash;
  return Array.isArray(dash) ? dash.filter((length) => Number.isFinite(length)) : [];
}
