// SPDX-License-Identifier: BSD-3-Clause
/** Why an estimate is no success, in the words of every page; the reasons are those of scores.json. */
import { formatFixed, formatNumber, isNumber } from "./format";

const kNames: Record<string, string> = {
  gap: "gap", starts_late: "starts late", ends_early: "ends early", no_poses: "no poses", no_overlap: "no poses in the time of the truth",
  invalid_pose: "invalid pose", low_coverage: "too little tracked", interrupted: "interrupted", failed: "failed",
};

/** "gap", "starts late", ...; one whose error is too large "diverged". */
export function reasonName(reason: unknown): string {
  return (typeof reason === "string" && Object.hasOwn(kNames, reason) ? kNames[reason] : undefined) ?? "diverged";
}

/** "✕ at 10 s", "✕ gap at 10 s", "✕ starts late"; seconds after the start, null: not known. */
export function failureMark(reason: unknown, seconds: number | null): string {
  const name = reasonName(reason);
  if (!isNumber(seconds) || reason === "starts_late") return `✕ ${name}`;
  const when = `at ${formatFixed(seconds, 0)} s`;
  return reason === "ends_early" ? `✕ ends ${when}` : name === "diverged" ? `✕ ${when}` : `✕ ${name} ${when}`;
}

/** "3 of 4 diverged", "4 of 4: gap", "4 of 4: 3 diverged, 1 gap". */
export function failureCount(reasons: unknown[], failed: number, runs: number): string {
  const counts = new Map<string, number>();
  for (const reason of reasons) counts.set(reasonName(reason), (counts.get(reasonName(reason)) ?? 0) + 1);
  const names = [...counts.keys()];
  if (names.length === 0 || (names.length === 1 && names[0] === "diverged")) return `${failed} of ${runs} diverged`;
  const text = names.length === 1 ? names[0]! : names.map((name) => `${counts.get(name)} ${name}`).join(", ");
  return `${failed} of ${runs}: ${text}`;
}

const kPart = " part";

/** What that mark means. */
export const kPartLegend = "part: over the parts of the runs that have poses alone.";

/** The mark of a value whose estimates lack a part of a run; nothing without a value. */
export function partMark(value: unknown, partial: boolean): string {
  return partial && isNumber(value) ? kPart : "";
}

/** The number with that mark. */
export function partText(value: unknown, partial: boolean): string {
  return formatNumber(value) + partMark(value, partial);
}
