// SPDX-License-Identifier: BSD-3-Clause
/** Charts by Observable Plot with the axes of all pages: ticks of `axis`, labels in the middle. */
import { axisX, axisY, gridX, gridY, plot, type Markish, type ScaleName, type SymbolType } from "@observablehq/plot";
import { styleIndex } from "../palette";
import { axis } from "./axis";
import type { Drawing, Place } from "./figure";

export interface Scale {
  label: string;
  log: boolean;
  ends: [number, number];
  /** Whole numbers alone. */
  whole?: boolean;
}

const kSymbols: SymbolType[] = ["circle", "square", "triangle", "diamond", "wye", "star"];

/** Mark of a series; with the dash it distinguishes series without colour. */
export function symbolOf(index: number): SymbolType {
  const style = styleIndex(index);
  return kSymbols[(style + Math.floor(style / 12)) % kSymbols.length]!;
}

/** A value that the axis can show, else NaN. */
export function shown(value: unknown, log: boolean): number {
  return typeof value === "number" && Number.isFinite(value) && (!log || value > 0) ? value : NaN;
}

interface Ticks {
  values: number[];
  labels: string[];
}

function ticksOf(scale: Scale, most: number): Ticks {
  const { ticks } = axis(scale.ends, scale.log, Math.max(2, most), scale.whole ?? false);
  return { values: ticks.map(({ value }) => value), labels: ticks.map(({ label }) => label) };
}

const kAxis = { tickSize: 0, tickPadding: 6, labelAnchor: "center", labelArrow: "none", color: "var(--ink-soft)" } as const;
const kBelow = { ...kAxis, labelOffset: 37 };
const kGrid = { stroke: "var(--grid)", strokeOpacity: 1 };

/** Pixels to the left of an axis of rows with these labels. */
function leftOf(labels: string[]): number {
  return 24 + 6.6 * Math.max(2, ...labels.map((label) => label.length));
}

/** A drawing, and where a value of a scale lies in it [px]. */
export interface Plotted extends Drawing {
  at: (scale: "x" | "y", value: number | string) => number;
}

function finished(options: Parameters<typeof plot>[0]): Plotted {
  const drawn = plot(options);
  const at = (name: ScaleName, value: number | string) => {
    const scale = drawn.scale(name)!;
    return scale.apply(value) + (scale.bandwidth ?? 0) / 2;
  };
  return { svg: drawn as unknown as SVGSVGElement, places: [] as Place[], at };
}

interface Size {
  label: string;
  width: number;
  height: number;
  grid?: boolean;
  /** Above the plot [px]. */
  top?: number | undefined;
}

/** Two numeric axes and what is between. */
export function plotted({ label, width, height, grid = true, top = 10 }: Size, x: Scale, y: Scale, marks: Markish[]): Plotted {
  const yTicks = ticksOf(y, Math.floor(height / 45));
  const marginLeft = leftOf(yTicks.labels);
  const xTicks = ticksOf(x, Math.floor(Math.max(60, width - marginLeft - 12) / 70));
  return finished({
    width, height, marginLeft, marginRight: 12, marginTop: top, marginBottom: 44, ariaLabel: label,
    x: { type: x.log ? "log" : "linear", domain: x.ends },
    y: { type: y.log ? "log" : "linear", domain: y.ends },
    marks: [
      grid ? [gridX(xTicks.values, kGrid), gridY(yTicks.values, kGrid)] : null,
      axisX(xTicks.values, { ...kBelow, label: x.label, text: xTicks.labels }),
      axisY(yTicks.values, { ...kAxis, label: y.label, text: yTicks.labels }),
      ...marks,
    ],
  });
}

/** Longest name of a row that is written out. */
const kLongest = 22;

/** A numeric axis below, a row of that height per name. */
export function plottedRows(
  label: string, width: number, row: number, x: Scale, names: string[], marks: Markish[],
): Plotted {
  const cut = names.map((name) => (name.length > kLongest ? `${name.slice(0, kLongest - 1)}…` : name));
  const marginLeft = Math.min(leftOf(cut), width / 3);
  const ticks = ticksOf(x, Math.floor(Math.max(80, width - marginLeft - 16) / 80));
  return finished({
    width, height: 4 + row * names.length + 44, marginLeft, marginRight: 16, marginTop: 4, marginBottom: 44, ariaLabel: label,
    x: { type: x.log ? "log" : "linear", domain: x.ends },
    y: { type: "band", domain: names, paddingInner: 0.56, paddingOuter: 0.28 },
    marks: [
      gridX(ticks.values, kGrid),
      axisX(ticks.values, { ...kBelow, label: x.label, text: ticks.labels }),
      axisY(names, { ...kAxis, label: null, text: cut, title: (name: string) => name }),
      ...marks,
    ],
  });
}
