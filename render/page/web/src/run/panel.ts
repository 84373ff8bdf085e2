// SPDX-License-Identifier: BSD-3-Clause
/** One strip: a uPlot chart over time or distance, a line for the cursor, values in the head. */
import uPlot from "uplot";
import { axis as axisOf, tickLabel } from "../charts/axis";
import { h } from "../dom";
import { formatFixed, formatNumber, isNumber } from "../format";
import { color } from "../theme";
import { linearRange, logRange } from "./panel_axes";
import { drawLevels, drawMarks, drawIntervals, type Backdrop } from "./panel_paint";
import { align, valueAt, type Track } from "./series";

export interface Curve {
  /** Name in the panel's head and in `data-series`. */
  label: string;
  track: Track;
  color: string;
  width?: number;
  /** In the panel's head, the least first. */
  place?: number;
  dash?: number[];
  /** Filled down to the bottom, in steps. */
  area?: boolean;
  /** Does the vertical scale take it in? */
  counts?: boolean;
}

export interface PanelSpec {
  id: string;
  title: string;
  unit?: string;
  hint?: string;
  curves: Curve[];
  /** Three standard deviations around zero, of the chosen estimator. */
  band?: { sigma: Track; color: string };
  log?: boolean;
  /** Fixed vertical range. */
  range?: [number, number];
  /** Horizontal lines that mean something, such as a threshold. */
  levels?: number[];
  /** Height without the axis below [px]. */
  height?: number;
  /** Of the axis below; seconds without. */
  xUnit?: string;
}

const kAxisWidth = 54;
const kHeight = 84;
const kTimeHeight = 28;
/** Least room of a tick on the axis below and beside [px]. */
const kTickWidth = 70;
const kTickHeight = 21;
/** Half of the last label of the time. */
const kRightPadding = 16;
const kFont = "11px system-ui, sans-serif";

function withAlpha(hex: string, alpha: number): string {
  const value = Math.round(alpha * 255)
    .toString(16)
    .padStart(2, "0");
  return /^#[0-9a-f]{6}$/i.test(hex) ? hex + value : hex;
}

export class Panel {
  readonly element: HTMLElement;
  private readonly plot: uPlot;
  private readonly line: HTMLElement;
  private readonly values: { curve: Curve; shown: HTMLElement }[];
  private readonly sigma: HTMLElement | null;
  private readonly at = h("span", { class: "cursor-at", "data-cursor-at": true });
  private readonly beyond = h("span", { class: "beyond" });

  constructor(
    private readonly spec: PanelSpec,
    private readonly backdrop: Backdrop,
    width: number,
    private readonly window: { from: number; to: number },
    private readonly named: boolean,
    withTime: boolean,
  ) {
    this.values = spec.curves.map((curve) => ({
      curve,
      shown: h("output", { "data-series": curve.label }),
    }));
    this.sigma = spec.band ? h("output", { "data-series": "3 sigma" }) : null;
    const body = h("div", { class: "panel-body" });
    this.element = h("div", { class: "panel", "data-panel": spec.id }, this.head(), body);
    const height = (spec.height ?? kHeight) + (withTime ? kTimeHeight : 0);
    this.plot = new uPlot(this.options(width, height, withTime), this.data(), body);
    this.line = h("div", { class: "cursor-line" });
    this.plot.over.append(this.line);
    this.plot.over.dataset["plot"] = spec.id;
  }

  /** Names the curves that leave the vertical scale, in the head. */
  private sayBeyond(plot: uPlot): void {
    const [low, high] = [plot.scales["y"]!.min, plot.scales["y"]!.max];
    if (!isNumber(low) || !isNumber(high)) return;
    const texts = this.spec.curves.flatMap(({ label, track, counts }) => {
      if (counts ?? true) return [];
      const most = track.values.reduce((a, b) => (Math.abs(b) > Math.abs(a) ? b : a), 0);
      return most > high || most < low ? [`${label} to ${formatNumber(most)}${this.spec.unit ? ` ${this.spec.unit}` : ""}`] : [];
    });
    this.beyond.textContent = texts.length > 0 ? `beyond the axis: ${texts.join(", ")}` : "";
  }

  private head(): HTMLElement {
    const legend = [...this.values]
      .sort((a, b) => (a.curve.place ?? 0) - (b.curve.place ?? 0))
      .map(({ curve, shown }) => {
        const swatch = h("i", { class: "swatch" });
        swatch.style.background = curve.color;
        if (curve.dash) swatch.classList.add("dashed");
        return h("span", { class: "legend-item" }, swatch, h("bdi", {}, curve.label), " ", shown);
      });
    if (this.spec.band && this.sigma) {
      const swatch = h("i", { class: "swatch wide" });
      swatch.style.background = withAlpha(this.spec.band.color, 0.25);
      legend.push(h("span", { class: "legend-item" }, swatch, "±3σ ", this.sigma));
    }
    return h(
      "div",
      { class: "panel-head", title: this.spec.hint },
      h(
        "span",
        { class: "panel-title" },
        this.spec.title,
        this.spec.unit ? h("span", { class: "unit" }, ` ${this.spec.unit}`) : null,
      ),
      this.at,
      ...legend,
      this.beyond,
    );
  }

  private data(): uPlot.AlignedData {
    const tracks = this.spec.curves.map((curve) => curve.track);
    if (this.spec.band) {
      const { times, values } = this.spec.band.sigma;
      tracks.push(
        { times, values: values.map((value) => 3 * value) },
        { times, values: values.map((value) => -3 * value) },
      );
    }
    return align(tracks, this.spec.log) as uPlot.AlignedData;
  }

  private series(): uPlot.Series[] {
    const list: uPlot.Series[] = this.spec.curves.map((curve) => ({
      stroke: curve.color,
      width: curve.width ?? 1.25,
      dash: curve.dash,
      auto: curve.counts ?? true,
      points: { show: curve.track.times.length < 3, size: 5, fill: curve.color },
      ...(curve.area
        ? { fill: withAlpha(curve.color, 0.35), paths: uPlot.paths.stepped!({ align: 1 }) }
        : {}),
    }));
    if (this.spec.band) {
      const edge = {
        stroke: withAlpha(this.spec.band.color, 0.5),
        width: 0.75,
        points: { show: false },
      };
      list.push({ ...edge }, { ...edge });
    }
    return [{}, ...list];
  }

  private options(width: number, height: number, withTime: boolean): uPlot.Options {
    const spec = this.spec;
    const soft = color("--ink-soft");
    const grid = { stroke: color("--grid"), width: 1 };
    const axis = { stroke: soft, font: kFont, grid, ticks: { show: false } };
    const splits = (log: boolean, room: number) => (_plot: uPlot, _axis: number, low: number, high: number) =>
      axisOf([low, high], log, Math.max(2, Math.floor(room))).ticks.map(({ value }) => value);
    const last = spec.curves.length + 1;
    return {
      width,
      height,
      padding: [6, kRightPadding, withTime ? 0 : 6, 0],
      cursor: { show: false },
      legend: { show: false },
      scales: {
        x: { time: false, range: () => [this.window.from, this.window.to] },
        y: {
          distr: spec.log ? 3 : 1,
          range: (_plot, low, high) =>
            spec.range ?? (spec.log ? logRange(low, high) : linearRange(low, high)),
        },
      },
      axes: [
        {
          ...axis,
          show: withTime,
          size: kTimeHeight,
          gap: 9,
          splits: splits(false, (width - kAxisWidth) / kTickWidth),
          values: (_plot, list) => list.map((value) => `${tickLabel(value)} ${spec.xUnit ?? "s"}`),
        },
        {
          ...axis,
          size: kAxisWidth,
          gap: 4,
          splits: splits(spec.log ?? false, (spec.height ?? kHeight) / kTickHeight),
          filter: (_plot, list) => list,
          values: (_plot, list) => list.map(tickLabel),
        },
      ],
      series: this.series(),
      bands: spec.band
        ? [{ series: [last, last + 1], fill: withAlpha(spec.band.color, 0.14) }]
        : [],
      hooks: {
        drawClear: [(plot) => drawIntervals(plot, this.backdrop.shaded)],
        draw: [
          (plot) => drawLevels(plot, spec.levels ?? []),
          (plot) => this.sayBeyond(plot),
          (plot) => drawMarks(plot, this.backdrop.marks, this.named),
        ],
      },
    };
  }

  /** Moves the line and shows the values there; `at`: where that is, `valueOf`: of a curve over another axis than time. */
  showCursor(
    seconds: number, at = `at ${formatFixed(seconds, 1)} s`, valueOf = (curve: Curve) => valueAt(curve.track, seconds),
  ): void {
    const position = this.plot.valToPos(seconds, "x");
    const inside = position >= -1 && position <= this.plot.bbox.width / uPlot.pxRatio + 1;
    this.line.hidden = !inside;
    this.at.textContent = at;
    if (inside) this.line.style.transform = `translateX(${position.toFixed(2)}px)`;
    for (const { curve, shown } of this.values) {
      const value = valueOf(curve);
      shown.textContent = formatNumber(value);
      shown.dataset["value"] = String(value);
    }
    if (this.spec.band && this.sigma) {
      this.sigma.textContent = formatNumber(3 * valueAt(this.spec.band.sigma, seconds));
    }
  }

  showWindow(): void {
    this.plot.setScale("x", { min: this.window.from, max: this.window.to });
  }

  resize(width: number): void {
    this.plot.setSize({ width, height: this.plot.height });
  }

  /** Is a point of the window in this strip's column? */
  spans(clientX: number): boolean {
    const { left, right } = this.plot.over.getBoundingClientRect();
    return clientX >= left && clientX <= right;
  }

  /** Time under a point of the window, in its coordinates [px], null beside the chart. */
  timeAt(clientX: number): number {
    return this.plot.posToVal(clientX - this.plot.over.getBoundingClientRect().left, "x");
  }

  destroy(): void {
    this.plot.destroy();
    this.element.remove();
  }
}
