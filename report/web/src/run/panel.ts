// SPDX-License-Identifier: BSD-3-Clause
/** One strip of the timeline: a uPlot chart, values at the cursor in its head, a line for the cursor. */
import uPlot from "uplot";
import type { Stretch } from "../contract";
import { h } from "../dom";
import { formatNumber, isNumber } from "../format";
import { color } from "../theme";
import { align, valueAt, type Track } from "./series";

export interface Curve {
  /** Name in the panel's head and in `data-series`. */
  label: string;
  track: Track;
  color: string;
  width?: number;
  dash?: number[];
  /** Filled down to the bottom, in steps. */
  area?: boolean;
  /** Does the vertical scale take it in? */
  counts?: boolean;
}

export interface Mark {
  t: number;
  text?: string;
  color: string;
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
}

/** What all panels draw behind their curves. */
export interface Backdrop {
  shaded: Stretch[];
  marks: Mark[];
}

const kAxisWidth = 54;
const kHeight = 84;
const kFont = "11px system-ui, sans-serif";

function withAlpha(hex: string, alpha: number): string {
  const value = Math.round(alpha * 255).toString(16).padStart(2, "0");
  return /^#[0-9a-f]{6}$/i.test(hex) ? hex + value : hex;
}

function logRange(low: number | null, high: number | null): uPlot.Range.MinMax {
  if (!isNumber(low) || !isNumber(high) || low <= 0) return [0.1, 10];
  return [10 ** Math.floor(Math.log10(low)), 10 ** Math.max(Math.ceil(Math.log10(high)), Math.floor(Math.log10(low)) + 1)];
}

function linearRange(low: number | null, high: number | null): uPlot.Range.MinMax {
  if (!isNumber(low) || !isNumber(high)) return [0, 1];
  const margin = 0.08 * (high - low) || Math.abs(high) * 0.1 || 1;
  return [low >= 0 ? Math.max(0, low - margin) : low - margin, high + margin];
}

/** Powers of ten of a logarithmic axis, thinned to what `space` allows; none in between. */
function decades(low: number, high: number, count: number): number[] {
  const first = Math.ceil(Math.log10(low) - 1e-9);
  const last = Math.floor(Math.log10(high) + 1e-9);
  const step = Math.max(1, Math.ceil((last - first) / Math.max(count, 1)));
  const list: number[] = [];
  for (let power = first; power <= last; power += step) list.push(Number(`1e${power}`));
  return list;
}

/** Short text of an axis value, no wider than the axis. */
function axisText(value: number | null): string {
  if (value === null) return "";
  const size = Math.abs(value);
  if (size !== 0 && (size >= 1e5 || size < 1e-3)) return value.toExponential(0).replace("e+", "e").replace(/-/g, "−");
  return String(Number(value.toPrecision(6))).replace("-", "−");
}

export class Panel {
  readonly element: HTMLElement;
  private readonly plot: uPlot;
  private readonly line: HTMLElement;
  private readonly values: { curve: Curve; shown: HTMLElement }[];
  private readonly sigma: HTMLElement | null;

  constructor(private readonly spec: PanelSpec, private readonly backdrop: Backdrop, width: number,
    private readonly window: { from: number; to: number }, private readonly named: boolean, withTime: boolean) {
    this.values = spec.curves.map((curve) => ({ curve, shown: h("output", { "data-series": curve.label }) }));
    this.sigma = spec.band ? h("output", { "data-series": "3 sigma" }) : null;
    const body = h("div", { class: "panel-body" });
    this.element = h("div", { class: "panel", "data-panel": spec.id }, this.head(), body);
    const height = kHeight + (withTime ? 22 : 0);
    this.plot = new uPlot(this.options(width, height, withTime), this.data(), body);
    this.line = h("div", { class: "cursor-line" });
    this.plot.over.append(this.line);
    this.plot.over.dataset["plot"] = spec.id;
  }

  private head(): HTMLElement {
    const legend = [...this.values].sort((a, b) => (b.curve.width ?? 0) - (a.curve.width ?? 0)).map(({ curve, shown }) => {
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
    return h("div", { class: "panel-head", title: this.spec.hint }, h("span", { class: "panel-title" }, this.spec.title,
      this.spec.unit ? h("span", { class: "unit" }, ` ${this.spec.unit}`) : null), ...legend);
  }

  private data(): uPlot.AlignedData {
    const tracks = this.spec.curves.map((curve) => curve.track);
    if (this.spec.band) {
      const { times, values } = this.spec.band.sigma;
      tracks.push({ times, values: values.map((value) => 3 * value) }, { times, values: values.map((value) => -3 * value) });
    }
    return align(tracks, this.spec.log) as uPlot.AlignedData;
  }

  private series(): uPlot.Series[] {
    const list: uPlot.Series[] = this.spec.curves.map((curve) => ({
      stroke: curve.color, width: curve.width ?? 1.25, dash: curve.dash, auto: curve.counts ?? true,
      points: { show: curve.track.times.length < 3, size: 5, fill: curve.color },
      ...(curve.area ? { fill: withAlpha(curve.color, 0.35), paths: uPlot.paths.stepped!({ align: 1 }) } : {}),
    }));
    if (this.spec.band) {
      const edge = { stroke: withAlpha(this.spec.band.color, 0.5), width: 0.75, points: { show: false } };
      list.push({ ...edge }, { ...edge });
    }
    return [{}, ...list];
  }

  private options(width: number, height: number, withTime: boolean): uPlot.Options {
    const spec = this.spec;
    const soft = color("--ink-soft");
    const grid = { stroke: color("--grid"), width: 1 };
    const axis = { stroke: soft, font: kFont, grid, ticks: { show: false } };
    const last = spec.curves.length + 1;
    return {
      width, height,
      padding: [6, 6, withTime ? 0 : 6, 0],
      cursor: { show: false },
      legend: { show: false },
      scales: {
        x: { time: false, range: () => [this.window.from, this.window.to] },
        y: {
          distr: spec.log ? 3 : 1,
          range: (_plot, low, high) => spec.range ?? (spec.log ? logRange(low, high) : linearRange(low, high)),
        },
      },
      axes: [
        { ...axis, show: withTime, size: 22, gap: 2, space: 60, values: (_plot, list) => list.map((value) => `${axisText(value)} s`) },
        { ...axis, size: kAxisWidth, gap: 4, space: spec.log ? 16 : 18,
          values: (_plot, list) => list.map(axisText),
          ...(spec.log ? { splits: (_plot: uPlot, _axis: number, low: number, high: number) => decades(low, high, 4), filter: (_plot: uPlot, list: number[]) => list } : {}) },
      ],
      series: this.series(),
      bands: spec.band ? [{ series: [last, last + 1], fill: withAlpha(spec.band.color, 0.14) }] : [],
      hooks: { drawClear: [(plot) => this.drawBackdrop(plot)], draw: [(plot) => this.drawMarks(plot)] },
    };
  }

  /** Degenerate stretches, behind the curves. */
  private drawBackdrop(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.beginPath();
    ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
    ctx.clip();
    ctx.fillStyle = color("--shade");
    for (const [from, to] of this.backdrop.shaded) {
      const left = plot.valToPos(from, "x", true);
      ctx.fillRect(left, bbox.top, Math.max(plot.valToPos(to, "x", true) - left, devicePixelRatio), bbox.height);
    }
    ctx.restore();
  }

  /** Thresholds, over the grid. */
  private drawLevels(plot: uPlot): void {
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.strokeStyle = color("--ink-soft");
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
    for (const level of this.spec.levels ?? []) {
      const y = Math.round(plot.valToPos(level, "y", true)) + 0.5;
      if (!(y > bbox.top && y < bbox.top + bbox.height)) continue;
      ctx.beginPath();
      ctx.moveTo(bbox.left, y);
      ctx.lineTo(bbox.left + bbox.width, y);
      ctx.stroke();
    }
    ctx.restore();
  }

  /** Passages and losses, over the curves. */
  private drawMarks(plot: uPlot): void {
    this.drawLevels(plot);
    const { ctx, bbox } = plot;
    ctx.save();
    ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
    ctx.textBaseline = "top";
    for (const mark of this.backdrop.marks) {
      if (mark.t < this.window.from || mark.t > this.window.to) continue;
      const x = Math.round(plot.valToPos(mark.t, "x", true)) + 0.5;
      ctx.strokeStyle = mark.color;
      ctx.fillStyle = mark.color;
      ctx.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
      ctx.beginPath();
      ctx.moveTo(x, bbox.top);
      ctx.lineTo(x, bbox.top + bbox.height);
      ctx.stroke();
      if (!mark.text || !this.named) continue;
      const right = x > bbox.left + bbox.width - 60 * devicePixelRatio;
      ctx.textAlign = right ? "right" : "left";
      ctx.fillText(mark.text.slice(0, 24), x + (right ? -3 : 3) * devicePixelRatio, bbox.top + 1);
    }
    ctx.restore();
  }

  /** Moves the line and shows the values there; seconds. */
  showCursor(seconds: number): void {
    const position = this.plot.valToPos(seconds, "x");
    const inside = position >= -1 && position <= this.plot.bbox.width / uPlot.pxRatio + 1;
    this.line.hidden = !inside;
    if (inside) this.line.style.transform = `translateX(${position.toFixed(2)}px)`;
    for (const { curve, shown } of this.values) {
      const value = valueAt(curve.track, seconds);
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

  /** Time under a point of the window, in its coordinates [px], null beside the chart. */
  timeAt(clientX: number): number {
    return this.plot.posToVal(clientX - this.plot.over.getBoundingClientRect().left, "x");
  }

  destroy(): void {
    this.plot.destroy();
    this.element.remove();
  }
}
