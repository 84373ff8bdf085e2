// SPDX-License-Identifier: BSD-3-Clause
/** What `aims watch` serves as /state.json, joined over the answers. */

import type { Track } from "../run/series";

export interface Answer {
  node: string;
  /** Since the last odometry [s]; null: none yet. */
  silent_s: number | null;
  /** x, y, z [m], heading [rad]. */
  pose: [number, number, number, number] | null;
  /** New points [m] from index `from` on; another epoch replaces all. */
  path: { epoch: number; from: number; xy: [number, number][] };
  /** x, y, z of each point in turn [cm]. */
  scan: number[];
  health: { level: number; text: string; values: [string, string][] };
  malformed: number;
}

export class LiveState {
  path: [number, number][] = [];
  private epoch = 0;
  /** The last answer. */
  answer: Answer | null = null;
  /** Seconds, and figures by name, of the last minutes. */
  readonly history: { t: number; values: Map<string, number> }[] = [];

  get query(): string {
    return `state.json?epoch=${this.epoch}&from=${this.path.length}`;
  }

  take(answer: Answer, seconds: number): void {
    this.answer = answer;
    if (answer.path.epoch !== this.epoch) this.path = [];
    this.epoch = answer.path.epoch;
    this.path.length = Math.min(this.path.length, answer.path.from);
    this.path.push(...answer.path.xy);
    const values = new Map<string, number>();
    for (const [name, value] of answer.health.values) values.set(name, Number(value));
    this.history.push({ t: seconds, values });
    while (this.history[0]!.t < seconds - kMinutes * 60) this.history.shift();
  }

  /** A figure over time. */
  track(name: string): Track {
    const known = this.history.filter(({ values }) => Number.isFinite(values.get(name)));
    return {
      times: Float32Array.from(known, ({ t }) => t),
      values: Float32Array.from(known, ({ values }) => values.get(name)!),
    };
  }
}

/** Kept of the figures [min]. */
export const kMinutes = 2;
