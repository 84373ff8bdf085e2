// SPDX-License-Identifier: BSD-3-Clause
/** The plan of a live estimate: scan in the colours of heights, path, robot, a scale. */
import { h } from "../dom";
import { ramp, rampColor } from "../run/ramps";
import { color, onTheme, seriesColor, theme } from "../theme";
import type { LiveState } from "./state";

const kMargin = 24;
/** Heights of the scan over the robot that the ramp spans [m]. */
const kLow = -1;
const kHigh = 2;
/** At least shown [m]. */
const kSmallest = 6;

export class Plan {
  readonly element: HTMLElement;
  private readonly canvas = h("canvas", { role: "img", "aria-label": "Path and last scan from above" });

  constructor(private readonly state: LiveState) {
    this.element = h("div", { class: "watch-plan" }, this.canvas);
    new ResizeObserver(() => this.draw()).observe(this.element);
    onTheme(() => this.draw());
  }

  /** Pixels per metre, and where the origin is. */
  private frame(width: number, height: number): { scale: number; x: number; y: number } {
    let [left, right, bottom, top] = [Infinity, -Infinity, Infinity, -Infinity];
    const take = (x: number, y: number) => {
      left = Math.min(left, x);
      right = Math.max(right, x);
      bottom = Math.min(bottom, y);
      top = Math.max(top, y);
    };
    for (const [x, y] of this.state.path) take(x, y);
    const scan = this.state.answer?.scan ?? [];
    for (let i = 0; i + 2 < scan.length; i += 3) take(scan[i]! / 100, scan[i + 1]! / 100);
    if (!(left <= right)) [left, right, bottom, top] = [-1, 1, -1, 1];
    const across = Math.max(right - left, kSmallest);
    const along = Math.max(top - bottom, kSmallest);
    const scale = Math.min((width - 2 * kMargin) / across, (height - 2 * kMargin) / along);
    return {
      scale,
      x: width / 2 - (scale * (left + right)) / 2,
      y: height / 2 + (scale * (bottom + top)) / 2,
    };
  }

  draw(): void {
    const { width, height } = this.element.getBoundingClientRect();
    const ctx = this.canvas.getContext("2d");
    if (!ctx || width < 1) return;
    this.canvas.width = width * devicePixelRatio;
    this.canvas.height = height * devicePixelRatio;
    ctx.scale(devicePixelRatio, devicePixelRatio);
    const { scale, x, y } = this.frame(width, height);
    const at = (px: number, py: number): [number, number] => [x + scale * px, y - scale * py];
    this.drawScan(ctx, at);
    this.drawPath(ctx, at);
    this.drawRobot(ctx, at);
    this.drawScale(ctx, scale, height);
  }

  private drawScan(ctx: CanvasRenderingContext2D, at: (x: number, y: number) => [number, number]): void {
    const scan = this.state.answer?.scan ?? [];
    const base = this.state.answer?.pose?.[2] ?? 0;
    const stops = ramp("height", theme() === "dark");
    for (let i = 0; i + 2 < scan.length; i += 3) {
      const share = (scan[i + 2]! / 100 - base - kLow) / (kHigh - kLow);
      ctx.fillStyle = `rgb(${rampColor(stops, share).join(",")})`;
      const [px, py] = at(scan[i]! / 100, scan[i + 1]! / 100);
      ctx.fillRect(px - 1, py - 1, 2, 2);
    }
  }

  private drawPath(ctx: CanvasRenderingContext2D, at: (x: number, y: number) => [number, number]): void {
    ctx.strokeStyle = seriesColor(0);
    ctx.lineWidth = 2;
    ctx.beginPath();
    for (const [px, py] of this.state.path) ctx.lineTo(...at(px, py));
    ctx.stroke();
  }

  private drawRobot(ctx: CanvasRenderingContext2D, at: (x: number, y: number) => [number, number]): void {
    const pose = this.state.answer?.pose;
    if (!pose) return;
    ctx.save();
    ctx.translate(...at(pose[0], pose[1]));
    ctx.rotate(-pose[3]);
    ctx.fillStyle = color("--ink");
    ctx.beginPath();
    ctx.moveTo(11, 0);
    ctx.lineTo(-7, 7);
    ctx.lineTo(-3, 0);
    ctx.lineTo(-7, -7);
    ctx.fill();
    ctx.restore();
  }

  private drawScale(ctx: CanvasRenderingContext2D, scale: number, height: number): void {
    const length = [0.5, 1, 2, 5, 10, 20, 50, 100, 200, 500].find((each) => each * scale > 50) ?? 1000;
    ctx.strokeStyle = ctx.fillStyle = color("--ink-soft");
    ctx.lineWidth = 1.5;
    ctx.beginPath();
    ctx.moveTo(12, height - 20);
    ctx.lineTo(12, height - 12);
    ctx.lineTo(12 + length * scale, height - 12);
    ctx.lineTo(12 + length * scale, height - 20);
    ctx.stroke();
    ctx.font = "12px system-ui, sans-serif";
    ctx.fillText(`${length} m`, 18, height - 18);
  }
}
