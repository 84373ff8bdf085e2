// SPDX-License-Identifier: BSD-3-Clause
/** What a strip shows behind and over its curves. */
import type uPlot from "uplot";
import type { TimeInterval } from "../contract";
import { color } from "../theme";

export interface Mark {
  t: number;
  text?: string;
  color: string;
}

/** What all strips show: shaded intervals [s], and instants with a dashed line. */
export interface Backdrop {
  shaded: TimeInterval[];
  marks: Mark[];
}

/** Degenerate intervals, behind the curves. */
export function drawIntervals(plot: uPlot, shaded: TimeInterval[]): void {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.beginPath();
  ctx.rect(bbox.left, bbox.top, bbox.width, bbox.height);
  ctx.clip();
  ctx.fillStyle = color("--shade");
  for (const [from, to] of shaded) {
    const left = plot.valToPos(from, "x", true);
    ctx.fillRect(
      left,
      bbox.top,
      Math.max(plot.valToPos(to, "x", true) - left, devicePixelRatio),
      bbox.height,
    );
  }
  ctx.restore();
}

/** Thresholds, over the grid. */
export function drawLevels(plot: uPlot, levels: number[]): void {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.strokeStyle = color("--ink-soft");
  ctx.lineWidth = devicePixelRatio;
  ctx.setLineDash([2 * devicePixelRatio, 3 * devicePixelRatio]);
  for (const level of levels) {
    const y = Math.round(plot.valToPos(level, "y", true)) + 0.5;
    if (!(y > bbox.top && y < bbox.top + bbox.height)) continue;
    ctx.beginPath();
    ctx.moveTo(bbox.left, y);
    ctx.lineTo(bbox.left + bbox.width, y);
    ctx.stroke();
  }
  ctx.restore();
}

/** Waypoint times and losses, over the curves; `named` writes their names. */
export function drawMarks(plot: uPlot, marks: Mark[], named: boolean): void {
  const { ctx, bbox } = plot;
  ctx.save();
  ctx.font = `${11 * devicePixelRatio}px system-ui, sans-serif`;
  ctx.textBaseline = "top";
  for (const mark of marks) {
    if (mark.t < plot.scales["x"]!.min! || mark.t > plot.scales["x"]!.max!) continue;
    const x = Math.round(plot.valToPos(mark.t, "x", true)) + 0.5;
    ctx.strokeStyle = mark.color;
    ctx.fillStyle = mark.color;
    ctx.lineWidth = devicePixelRatio;
    ctx.setLineDash([4 * devicePixelRatio, 4 * devicePixelRatio]);
    ctx.beginPath();
    ctx.moveTo(x, bbox.top);
    ctx.lineTo(x, bbox.top + bbox.height);
    ctx.stroke();
    if (!mark.text || !named) continue;
    const right = x > bbox.left + bbox.width - 60 * devicePixelRatio;
    ctx.textAlign = right ? "right" : "left";
    ctx.fillText(mark.text.slice(0, 24), x + (right ? -3 : 3) * devicePixelRatio, bbox.top + 1);
  }
  ctx.restore();
}
