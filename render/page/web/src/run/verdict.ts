// SPDX-License-Identifier: BSD-3-Clause
/** What came of the run, in sentences: validity, expectations, successes. */
import type { Failure, RunPayload } from "../contract";
import { at, h, own } from "../dom";
import { finding } from "../findings";
import { firstLine, formatFixed, formatNumber, isNumber } from "../format";
import { missingText } from "./errors";
import { findingsOf } from "./findings_of";

export type Mood = "good" | "bad" | "plain";

export interface Sentence {
  mood: Mood;
  lead: string;
  rest: string;
}

/** An expectation of scores.json. */
export interface Expectation {
  estimator?: string;
  score?: string;
  min?: number | null;
  max?: number | null;
  value?: number | null;
  holds?: boolean;
}

export function expectationsOf(data: RunPayload): Expectation[] {
  const list = own<unknown>(data.scores, "expectations");
  return Array.isArray(list) ? list : [];
}

/** Limits of an expectation: "at least 1, at most 2". */
export function limitsOf({ min, max }: Expectation): string {
  return [
    isNumber(min) ? `at least ${formatNumber(min)}` : "",
    isNumber(max) ? `at most ${formatNumber(max)}` : "",
  ]
    .filter((part) => part !== "")
    .join(", ");
}

function failuresOf(data: RunPayload): Failure[] {
  return Array.isArray(data.failures) ? data.failures : [];
}

function robotSentence(data: RunPayload): Sentence | null {
  const robot = data.scenario.robot;
  if (robot?.valid === false) {
    return {
      mood: "bad",
      lead: `Invalid run: ${robot.invalid_reason ?? "its robot did not finish"}.`,
      rest: "No estimator counts as a success on it, and its scores enter no statistics.",
    };
  }
  if (data.scenario.complete === false)
    return { mood: "bad", lead: "Interrupted:", rest: "the run did not reach its end." };
  return null;
}

function expectationSentence(data: RunPayload): Sentence | null {
  const all = expectationsOf(data);
  if (all.length === 0) return null;
  const missed = all.filter((each) => each.holds !== true);
  if (missed.length === 0)
    return { mood: "good", lead: `All ${all.length} expectations hold.`, rest: "" };
  const text = missed.map(
    (each) =>
      `${each.estimator || "the run"} ${each.score ?? ""} is ${formatNumber(each.value)}, ` +
      `expected ${limitsOf(each)}`,
  );
  return {
    mood: "bad",
    lead: `${missed.length} of ${all.length} expectations do not hold:`,
    rest: `${text.join("; ")}.`,
  };
}

function successSentence(data: RunPayload): Sentence | null {
  const scores = Object.entries(own<object>(data.scores, "estimators") ?? {});
  const start = data.t0_s ?? 0;
  const unscored = failuresOf(data).filter(({ estimator }) => !scores.some(([name]) => name === estimator));
  if (scores.length + unscored.length === 0 || !data.truth) return null;
  const failed = scores.filter(([, own]) => at(own, "success") !== true);
  const reasons = failed.map(([name, own]) => {
    const divergedAt = at(own, "diverged_at_s");
    if (at(own, "diverged_reason") === "no_poses") return `${name} returned no pose`;
    const missing = missingText(data, name);
    if (missing) return `${name} ${missing}`;
    return isNumber(divergedAt) ? `${name} diverged ${formatFixed(divergedAt - start, 0)} s after the start` : `${name} failed`;
  });
  reasons.push(...unscored.map(({ estimator }) => `${estimator} failed to run`));
  return {
    mood: "plain",
    lead: "",
    rest: `${scores.length - failed.length} of ${scores.length + unscored.length} estimators succeeded. ` +
       (reasons.length > 0 ? `${reasons.join(", ")}.` : ""),
  };
}

/** Who keeps the length and where others lose it; null of an invalid run and without scores. */
function findingSentence(data: RunPayload): Sentence | null {
  if (data.scenario.robot?.valid === false) return null;
  const { list, route } = findingsOf(data);
  const text = finding(list, route);
  return text ? { mood: "plain", lead: text, rest: "" } : null;
}

/** What is said of a run, the gravest first. */
export function verdict(data: RunPayload): Sentence[] {
  const robot = robotSentence(data);
  const successes = data.scenario.robot?.valid === false ? null : successSentence(data);
  const found = [robot, findingSentence(data), expectationSentence(data), successes].filter((each) => each !== null);
  if (found.length > 0) return found;
  return [
    {
      mood: "plain",
      lead: data.truth ? "No estimator was scored." : "No truth:",
      rest: data.truth ? "" : "errors are unknown; the health is what each estimator reports of itself.",
    },
  ];
}

/** Assumptions about the recording that may decide the result; null without any. */
export function warningBox(data: RunPayload): HTMLElement | null {
  const warnings = (data.warnings ?? []).filter((each) => typeof each === "string");
  if (warnings.length === 0) return null;
  return h(
    "div",
    { class: "banner", role: "alert", "data-warnings": warnings.length },
    h("strong", {}, "Assumed about this recording, and decisive for the result:"),
    h("ul", {}, ...warnings.map((each) => h("li", {}, each))),
  );
}

/** How the recording was read; null without notes. */
export function readingBox(data: RunPayload): HTMLElement | null {
  const notes = (data.reading ?? []).filter((each) => typeof each === "string");
  if (notes.length === 0) return null;
  return h(
    "details",
    { open: true, "data-reading": notes.length },
    h("summary", {}, "How the recording was read"),
    h("ul", { class: "notes" }, ...notes.map((each) => h("li", {}, each))),
  );
}

/** Estimators that failed, each with the first line of its message; null without any. */
export function failureBox(data: RunPayload): HTMLElement | null {
  const failures = failuresOf(data);
  if (failures.length === 0) return null;
  return h(
    "div",
    { class: "banner", role: "alert", "data-failures": failures.length },
    h("strong", {}, failures.length === 1 ? "One estimator failed:" : `${failures.length} estimators failed:`),
    h("ul", {}, ...failures.map(({ estimator, message }) =>
      h("li", {}, h("bdi", {}, estimator ?? ""), `: ${firstLine(message)}`))),
  );
}

/** What was noticed while scoring: a turned body frame, a clock that differs; null without any. */
export function hintBox(data: RunPayload): HTMLElement | null {
  const notes = own<unknown>(data.scores, "notes");
  const hints = Array.isArray(notes) ? notes.filter((each) => typeof each === "string") : [];
  if (hints.length === 0) return null;
  return h("div", { class: "verdict", "data-hints": hints.length, role: "note" },
    h("p", {}, h("strong", {}, "Noticed while scoring:")),
    h("ul", {}, ...hints.map((each) => h("li", {}, each))));
}

/** The sentences in a box that is red for what failed. */
export function verdictBox(data: RunPayload): HTMLElement {
  const sentences = verdict(data);
  const mood = (["bad", "good", "plain"] as const).find((each) =>
    sentences.some((sentence) => sentence.mood === each),
  );
  return h(
    "div",
    { class: `verdict ${mood}`, "data-verdict": mood, role: mood === "bad" ? "alert" : "status" },
    ...sentences.map(({ mood: own, lead, rest }) =>
      h("p", {}, lead ? h("strong", { class: own }, `${lead} `) : null, rest.trim()),
    ),
  );
}
