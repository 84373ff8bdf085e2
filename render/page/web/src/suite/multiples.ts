// SPDX-License-Identifier: BSD-3-Clause
/** One small chart per run, the worst first: a score of every estimator on one common axis. */
import { unitScale } from "../charts/axis";
import { choice } from "../charts/controls";
import { seriesPaint } from "../charts/svg";
import { h, section } from "../dom";
import { formatNumber, isNumber, kNone } from "../format";
import { failureMark, kPartLegend, partText } from "../outcome";
import { seriesDash } from "../palette";
import { estimatorsOf, failedOn, firstScore, headlineOf, labelOf, scoreOf, styleOf, type Run, type SuitePayload } from "./model";

/** Charts shown before the reader asks for all. */
const kShown = 24;

interface Bar {
  estimator: string;
  index: number;
  value: number | null;
  diverged: boolean;
  at: number | null;
  reason: unknown;
  /** The estimate lacks a part of the run. */
  partial: boolean;
}

/** One that failed to run. */
function failedBar(estimator: string, index: number): Bar {
  return { estimator, index, value: null, diverged: true, at: null, reason: "failed", partial: true };
}

function barsOf(run: Run, estimators: string[], score: string, styles?: (name: string) => number): Bar[] {
  return estimators.flatMap((estimator): Bar[] => {
    if (!Object.hasOwn(run.estimators, estimator)) return [];
    const found = run.estimators[estimator]!;
    const value = Object.hasOwn(found, score) ? found[score] : null;
    const at = found["diverged_at_s"];
    return [
      {
        estimator,
        index: styles?.(estimator) ?? 0,
        value: isNumber(value) ? value : null,
        diverged: found["success"] === false,
        at: isNumber(at) ? at : null,
        reason: found["diverged_reason"],
        partial: run.partial.includes(estimator),
      },
    ];
  });
}

/** Of every estimator, also of those that failed to run on that seed. */
function runBars(data: SuitePayload, run: Run, estimators: string[], score: string): Bar[] {
  const failed = failedOn(data, run.scenario, run.seed).filter((name) => !Object.hasOwn(run.estimators, name));
  return [...barsOf(run, estimators, score, (name) => styleOf(data, name)), ...failed.map((name) => failedBar(name, styleOf(data, name)))];
}

/** Runs by how many estimators diverged, then by their largest score; invalid runs come last. */
export function worstFirst(runs: Run[], estimators: string[], score: string): Run[] {
  const key = (run: Run) => {
    const bars = barsOf(run, estimators, score);
    const values = bars.flatMap((bar) => (bar.value === null ? [] : [Math.abs(bar.value)]));
    return {
      run,
      invalid: run.invalid ? 1 : 0,
      diverged: bars.filter((bar) => bar.diverged).length,
      largest: Math.max(-1, ...values),
    };
  };
  return runs
    .map(key)
    .sort(
      (a, b) => a.invalid - b.invalid || b.diverged - a.diverged || b.largest - a.largest,
    )
    .map(({ run }) => run);
}

/** The dashes of the series' line as stripes: a variant has the colour of its estimator and other dashes. */
function patternOf(index: number): string {
  const dash = seriesDash(index);
  if (dash.length === 0) return "none";
  let at = 0;
  const stops = dash.map((length, i) => {
    const from = at;
    at += length;
    return `${i % 2 === 0 ? "transparent" : "var(--card)"} ${from}px ${at}px`;
  });
  return `repeating-linear-gradient(90deg, ${stops.join(", ")})`;
}

function barRow(bar: Bar, at: (value: number) => number): HTMLElement {
  const width = bar.value === null ? 0 : 4 + 96 * at(Math.abs(bar.value));
  const mark = h("i", { class: bar.diverged ? "small-bar diverged" : "small-bar" });
  mark.style.width = `${width.toFixed(1)}%`;
  mark.style.setProperty("--paint", seriesPaint(bar.index));
  if (!bar.diverged) mark.style.setProperty("--pattern", patternOf(bar.index));
  return h(
    "div",
    { class: "small-row", "data-estimator": bar.estimator },
    h("span", { class: "small-name", title: bar.estimator }, h("bdi", {}, bar.estimator)),
    h("span", { class: "small-track" }, mark),
    h(
      "span",
      { class: "small-value" },
      bar.value === null && !bar.diverged ? kNone : bar.value === null ? "" : partText(bar.value, bar.partial),
      bar.diverged ? h("b", {}, ` ${failureMark(bar.reason, bar.at)}`) : null,
    ),
  );
}

function chart(run: Run, bars: Bar[], at: (value: number) => number): HTMLElement {
  const title = `${run.scenario}, seed ${run.seed}`;
  return h(
    "article",
    { class: "small", "data-run": title },
    h("h3", {}, run.href ? h("a", { href: run.href }, title) : title),
    run.invalid
      ? h("p", { class: "soft" }, `✕ invalid run: ${run.invalid}`)
      : h("div", {}, ...bars.map((bar) => barRow(bar, at))),
  );
}

/** Null without runs. */
export function multiplesSection(data: SuitePayload): HTMLElement | null {
  if (data.runs.length === 0 || data.headline.length === 0) return null;
  const estimators = estimatorsOf(data);
  const charts = h("div", { class: "smalls" });
  const words = h("p", { class: "soft" });
  const more = h("button", { type: "button" }, `Show all ${data.runs.length} runs`);
  let score = firstScore(data);
  let all = data.runs.length <= kShown;
  const draw = () => {
    const ordered = worstFirst(data.runs, estimators, score);
    const values = data.runs.flatMap((run) =>
      run.invalid ? [] : barsOf(run, estimators, score).flatMap((bar) => (bar.value === null ? [] : [Math.abs(bar.value)])));
    const scale = unitScale(values);
    const isMarked = (run: Run) => barsOf(run, estimators, score).some((bar) => bar.partial && bar.value !== null);
    const legend = data.runs.some((run) => !run.invalid && isMarked(run)) ? ` ${kPartLegend}` : "";
    const shown = scoreOf(data, score);
    words.textContent =
      values.length === 0
        ? `No run has a value of ${shown.title}.`
        : `${labelOf(shown)} of each run on one axis from ${formatNumber(scale.low)} to ` +
      `${formatNumber(scale.high)}${scale.law}; worst first: most diverged estimators, then the largest value.${legend}`;
    charts.replaceChildren(
      ...(all ? ordered : ordered.slice(0, kShown)).map((run) =>
        chart(run, runBars(data, run, estimators, score), scale.at)),
    );
    more.hidden = all;
  };
  more.addEventListener("click", () => {
    all = true;
    draw();
  });
  draw();
  return section(
    "runs",
    "Runs",
    h(
      "div",
      { class: "toolbar" },
      choice(
        "Score",
        headlineOf(data).map((each) => ({ value: each.key, label: labelOf(each) })),
        score,
        (value) => {
          score = value;
          draw();
        },
      ),
    ),
    words,
    charts,
    more,
  );
}
