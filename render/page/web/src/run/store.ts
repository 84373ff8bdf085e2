// SPDX-License-Identifier: BSD-3-Clause
/** What the parts of the run page share: cursor, zoom, chosen estimator. */

import type { Alignment } from "./errors";

export type Level = "n10" | "n100" | "n1000";
export type Coloring = "height" | "error";
export type ScanColoring = "intensity" | "range" | "residual" | "none";
export type ErrorScale = "chosen" | "all";
export type Tab = "errors" | "internals";
export type Preset = "orbit" | "top" | "side";

export interface State {
  /** Cursor [s], always at a sample of the run. */
  cursor: number;
  /** Window of time that every panel shows [s]. */
  from: number;
  to: number;
  /** Index of the chosen estimator, -1 without any. */
  chosen: number;
  /** Level at which degenerate intervals are shaded. */
  level: Level;
  coloring: Coloring;
  /** What the colours of the scan show; is it drawn? */
  scanColoring: ScanColoring;
  /** Is the ceiling drawn? */
  ceiling: boolean;
  errorScale: ErrorScale;
  /** Indices of the estimators that are not drawn. */
  hidden: ReadonlySet<number>;
  /** How estimates are laid onto the truth in the overview. */
  alignment: Alignment;
  /** Which strips the timeline shows. */
  tab: Tab;
  /** From where the 3D view looks, and whether it goes with the robot. */
  preset: Preset;
  follow: boolean;
}

type Listener = (state: Readonly<State>) => void;

export class Store {
  private readonly listeners: { keys: (keyof State)[]; call: Listener }[] = [];
  private readonly changed = new Set<keyof State>();
  private scheduled = false;

  /** `times`: where the cursor may stand [s], ascending; `span`: all of the run [s]. */
  constructor(
    private current: State,
    readonly times: number[],
    readonly span: [number, number],
  ) {}

  get state(): Readonly<State> {
    return this.current;
  }

  /** Changes the state; listeners hear of it once per frame. */
  set(patch: Partial<State>): void {
    for (const key of Object.keys(patch) as (keyof State)[]) {
      if (this.current[key] !== patch[key]) this.changed.add(key);
    }
    this.current = { ...this.current, ...patch };
    if (this.changed.size === 0 || this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => this.flush());
  }

  /** Calls back when one of the keys has changed. */
  on(keys: (keyof State)[], call: Listener): void {
    this.listeners.push({ keys, call });
  }

  private flush(): void {
    const keys = new Set(this.changed);
    this.changed.clear();
    this.scheduled = false;
    for (const listener of this.listeners) {
      if (listener.keys.some((key) => keys.has(key))) listener.call(this.current);
    }
  }

  /** Draws an estimator, or leaves it out. */
  show(index: number, shown: boolean): void {
    const hidden = new Set(this.current.hidden);
    if (shown) hidden.delete(index);
    else hidden.add(index);
    this.set({ hidden });
  }

  /** Puts the cursor on the sample nearest to an instant, and moves the window after it. */
  moveTo(seconds: number): void {
    const index = nearestIndex(this.times, seconds);
    if (index < 0) return;
    const cursor = this.times[index]!;
    const { from, to } = this.current;
    const shift = cursor < from ? cursor - from : cursor > to ? cursor - to : 0;
    this.set({ cursor, from: from + shift, to: to + shift });
  }

  /** Index of the cursor among `times`, -1 without any. */
  index(): number {
    return nearestIndex(this.times, this.current.cursor);
  }

  /** Moves the cursor by so many samples. */
  step(samples: number): void {
    const index = Math.min(Math.max(this.index() + samples, 0), this.times.length - 1);
    if (index >= 0) this.moveTo(this.times[index]!);
  }

  /** Shows a window of time, kept inside the run and at least a fifth of a second long. */
  zoomTo(from: number, to: number): void {
    const [first, last] = this.span;
    const length = Math.min(Math.max(to - from, 0.2), last - first);
    const start = Math.min(Math.max(from, first), last - length);
    this.set({ from: start, to: start + length });
  }

  /** Scales the window by `factor`, `seconds` staying where it is. */
  zoomBy(factor: number, seconds: number): void {
    const { from, to } = this.current;
    this.zoomTo(seconds - (seconds - from) * factor, seconds + (to - seconds) * factor);
  }

  zoomAll(): void {
    this.zoomTo(...this.span);
  }
}

/** Index of the value nearest to `value` in an ascending list, -1 if it is empty. */
export function nearestIndex(list: ArrayLike<number>, value: number): number {
  let low = 0;
  let high = list.length - 1;
  if (high < 0 || Number.isNaN(value)) return -1;
  while (high - low > 1) {
    const middle = (low + high) >> 1;
    if (list[middle]! <= value) low = middle;
    else high = middle;
  }
  return Math.abs(list[high]! - value) < Math.abs(list[low]! - value) ? high : low;
}
