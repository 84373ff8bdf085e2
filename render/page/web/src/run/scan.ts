// SPDX-License-Identifier: BSD-3-Clause
/** The scan at the cursor: which points it has, where they stand, what their colours mean. */
import { Quaternion, Vector3 } from "three";
import type { RunPayload, Scans } from "../contract";
import { indexAt, quaternionAt, vectorAt } from "./series";
import { nearestIndex, type ScanColoring, type State } from "./store";
import type { Surface } from "./surface";

/** A residual that the end of its ramp stands for [m]. */
const kLargestResidual = 0.5;

export interface PlacedScan {
  /** End of the scan [s]. */
  t: number;
  /** Points that it had, of which these are shown. */
  returns: number;
  /** By whose pose it is placed. */
  by: string;
  /** Points in the world, xyz each [m]. */
  p: Float32Array;
  /** What the colours show, one a point, from `low` to `high`. */
  values: Float32Array;
  low: number;
  high: number;
}

/** Index of the scan that is nearest to an instant, -1 without any near. */
function scanAt(scans: Scans, seconds: number): number {
  const index = nearestIndex(scans.t, seconds);
  const spacing = scans.t.length > 1 ? (scans.t[1] ?? 0) - (scans.t[0] ?? 0) : 1;
  return index >= 0 && Math.abs(scans.t[index]! - seconds) <= 1.5 * spacing ? index : -1;
}

/** Brightest intensity of a run but for the last two percent. */
function brightest(scans: Scans): number {
  const sorted = Uint8Array.from(scans.intensity).sort();
  return Math.max(sorted[Math.floor(0.98 * (sorted.length - 1))] ?? 255, 1) / 255;
}

/** Farthest return of a run [m]. */
function farthest(scans: Scans): number {
  let most = 1;
  for (let i = 0; i + 2 < scans.p.length; i += 3)
    most = Math.max(most, Math.hypot(scans.p[i]!, scans.p[i + 1]!, scans.p[i + 2]!));
  return most;
}

/** Places scans of a run. */
export class ScanPlacer {
  /** Value at the end of each colouring's ramp. */
  private readonly ends: Record<ScanColoring, number>;

  constructor(
    private readonly data: RunPayload,
    private readonly surface: Surface | null,
  ) {
    const scans = data.scans;
    this.ends = {
      intensity: scans ? brightest(scans) : 1,
      range: scans ? farthest(scans) : 1,
      residual: kLargestResidual,
      none: 1,
    };
  }

  /** Colourings that have values. */
  colorings(): ScanColoring[] {
    return ["intensity", "range", ...(this.surface ? (["residual"] as const) : []), "none"];
  }

  /** The scan at the cursor, placed by the chosen estimator, else by the truth; null without one. */
  place(state: Readonly<State>): PlacedScan | null {
    const scans = this.data.scans;
    if (!scans || state.scanColoring === "none") return null;
    const index = scanAt(scans, state.cursor);
    if (index < 0) return null;
    const t = scans.t[index]!;
    const chosen = this.data.estimators[state.chosen];
    const poses = [
      { by: chosen?.name ?? "", poses: chosen?.series },
      { by: "the truth", poses: this.data.truth },
    ];
    for (const { by, poses: list } of poses) {
      const at = indexAt(list?.t, t);
      const position = vectorAt(list?.p, at);
      if (!position) continue;
      const turn = new Quaternion(...quaternionAt(list?.q, at)).normalize();
      return this.placed(scans, index, by, turn, new Vector3(...position), state);
    }
    return null;
  }

  private placed(
    scans: Scans,
    index: number,
    by: string,
    turn: Quaternion,
    position: Vector3,
    state: Readonly<State>,
  ): PlacedScan {
    const first = scans.first[index]!;
    const end = scans.first[index + 1] ?? scans.p.length / 3;
    const count = state.ceiling ? end - first : Math.min(scans.below[index]!, end - first);
    const p = new Float32Array(3 * count);
    const values = new Float32Array(count);
    const point = new Vector3();
    for (let i = 0; i < count; ++i) {
      point.fromArray(scans.p, 3 * (first + i));
      const range = point.length();
      point.applyQuaternion(turn).add(position);
      point.toArray(p, 3 * i);
      values[i] =
        state.scanColoring === "intensity"
          ? scans.intensity[first + i]! / 255
          : state.scanColoring === "range"
            ? range
            : (this.surface?.distance([point.x, point.y, point.z], kLargestResidual) ?? 0);
    }
    const high = this.ends[state.scanColoring];
    return { t: scans.t[index]!, returns: scans.returns[index]!, by, p, values, low: 0, high };
  }
}
