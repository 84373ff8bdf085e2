// SPDX-License-Identifier: BSD-3-Clause
/** How well each index of an estimator's diagnostics separates degenerate scans from the others. */
import { chart, type Line, type Mark } from "../charts/chart";
import { choice } from "../charts/controls";
import { h, section } from "../dom";
import { formatNumber, isNumber } from "../format";
import { sortableTable } from "../table";
import type { Detectors, RocScore, SuitePayload } from "./model";

const kPooled = "";

function lineOf(score: RocScore, index: number): Line {
  const marks: Mark[] = [];
  const { curve } = score;
  for (let i = 0; i + 1 < curve.length; i += 2) {
    if (Number.isFinite(curve[i]!) && Number.isFinite(curve[i + 1]!)) marks.push({ x: curve[i]!, y: curve[i + 1]! });
  }
  return { name: `${score.index}, AUC ${formatNumber(score.auc)}`, index, marks, plain: true };
}

function rocTable(scores: RocScore[], roc: Detectors, caption: string): HTMLElement {
  return sortableTable(scores, [
    { title: "index", value: (score) => score.index },
    {
      title: "AUC", hint: "area under the curve; 0.5 is a random guess", best: "high", value: (score) => score.auc,
      interval: (score) => isNumber(score.auc_low) && isNumber(score.auc_high) ? [score.auc_low, score.auc_high] : null,
    },
    {
      title: "detected", hint: `fraction of degenerate scans detected at a false-alarm rate of at most ${100 * roc.false_alarms} %`,
      best: "high", value: (score) => score.detections,
    },
    { title: "delay", unit: "s", hint: "median time from onset to alarm", best: "low", value: (score) => score.median_delay_s },
    { title: "missed", value: (score) => score.missed, show: (score) => `${score.missed} of ${score.onsets}` },
  ], { caption, rowName: (score) => score.index });
}

/** The section; none without a detector study. */
export function rocSection(data: SuitePayload): HTMLElement | null {
  const roc = data.roc;
  if (!roc || roc.scores.length === 0) return null;
  const levels = [...new Set(roc.scores.map((score) => score.level))];
  const sets = [...new Set(roc.scores.map((score) => score.scenario ?? kPooled))];
  const names = [...new Set(roc.scores.map((score) => score.index))];
  let level = levels.includes("n100") ? "n100" : levels[0]!;
  let set = sets.includes(kPooled) ? kPooled : sets[0]!;
  const place = h("div", {});
  const draw = () => {
    const scores = roc.scores.filter((score) => score.level === level && (score.scenario ?? kPooled) === set);
    const lines = scores.filter((score) => score.curve.length > 0)
      .map((score) => lineOf(score, names.indexOf(score.index)));
    const below = Object.hasOwn(roc.equivalent_returns_below, level) ? roc.equivalent_returns_below[level] : null;
    const what = `degenerate: fewer than ${formatNumber(below)} equivalent returns`;
    place.replaceChildren(
      h("div", { class: "toolbar" },
        choice("Degenerate below", levels.map((each) => ({
          value: each, label: `${formatNumber(roc.equivalent_returns_below[each])} equivalent returns`,
        })), level, (value) => { level = value; draw(); }),
        choice("Runs", sets.map((each) => ({ value: each, label: each === kPooled ? "all, pooled" : each })), set,
          (value) => { set = value; draw(); })),
      h("div", { class: "figures" },
        lines.length > 0
          ? chart(lines, {
              label: `ROC curves of ${lines.length} indices, ${what}; the table has the areas under them`,
              xLabel: "false-alarm rate", yLabel: "detection rate",
              xEnds: [0, 1], yEnds: [0, 1.01], diagonal: true, height: 380,
              verticals: [{ x: roc.false_alarms, label: `${100 * roc.false_alarms} %` }],
            })
          : h("p", { class: "nothing" }, "At this level all scans are degenerate or none is: no curve."),
        rocTable(scores, roc, `${set === kPooled ? "All runs" : set}; ${what}: ` +
          `${scores[0]?.degenerate ?? 0} of ${scores[0]?.scans ?? 0} scans`)));
  };
  draw();
  return section("roc", `Indices of ${roc.estimator} as detectors`, place,
    h("p", { class: "soft" }, `Intervals: bootstrap over ${roc.runs.length} runs. Dashed: random guess.`));
}
