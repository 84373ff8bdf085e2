// SPDX-License-Identifier: BSD-3-Clause
/** Titles and units of scores: the list of the C++ side, which the payload holds. */
import type { ListedScore } from "./contract";

const kOptimized = "optimized.";

/** The entry of a dotted key, or of the closest one above it; "*" in an entry is any part. */
export function scoreAt(list: ListedScore[], key: string): ListedScore | undefined {
  const parts = (key.startsWith(kOptimized) ? key.slice(kOptimized.length) : key).split(".");
  return list.find((each) => each.key.split(".").every((part, i) => part === "*" || part === parts[i]));
}

/** Which end of a score is best; none of one of which neither is. */
export function bestEnd(score: ListedScore | undefined): "low" | "high" | undefined {
  if (score?.better === "neither") return undefined;
  return score?.better === "larger" ? "high" : "low";
}
