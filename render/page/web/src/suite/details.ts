// SPDX-License-Identifier: BSD-3-Clause
/** What is behind one cell of the matrix: its runs by seed, and all of its scores. */
import { h } from "../dom";
import { isNumber } from "../format";
import { failureMark, kPartLegend, partText, reasonName } from "../outcome";
import { bestEnd } from "../scores";
import { sortableTable, type Column } from "../table";
import { headlineOf, runsOf, scoreOf, summaryOf, type Run, type ScoreSummary, type SuitePayload, type SuiteScenario } from "./model";

function outcome(run: Run, estimator: string): Record<string, unknown> {
  return Object.hasOwn(run.estimators, estimator) ? run.estimators[estimator]! : {};
}

function numberAt(record: Record<string, unknown>, key: string): number | null {
  const value = Object.hasOwn(record, key) ? record[key] : null;
  return isNumber(value) ? value : null;
}

function runTable(data: SuitePayload, scenario: SuiteScenario, estimator: string): HTMLElement {
  const runs = runsOf(data, scenario.name);
  const isPart = (run: Run) => run.partial.includes(estimator);
  const columns: Column<Run>[] = [
    {
      title: "seed", value: (run) => run.seed,
      show: (run) => (run.href ? h("a", { href: run.href }, `${run.seed}, open run`) : String(run.seed)),
    },
    {
      title: "outcome", value: (run) => String(outcome(run, estimator)["success"]),
      show: (run) => {
        if (run.invalid) return `✕ invalid run: ${run.invalid}`;
        const found = outcome(run, estimator);
        if (found["success"] === true) return "success";
        if (found["success"] !== false) return "unknown";
        const at = numberAt(found, "diverged_at_s");
        const why = found["diverged_reason"];
        if (reasonName(why) !== "diverged") return failureMark(why, at);
        return `✕ diverged${at === null ? "" : ` at ${at.toFixed(1)} s`}${why ? `: ${why}` : ""}`;
      },
    },
    ...headlineOf(data).map((score): Column<Run> => ({
      title: score.title, unit: score.unit, best: bestEnd(score), eligible: (run) => !run.invalid && !isPart(run),
      value: (run) => numberAt(outcome(run, estimator), score.key),
      show: (run) => partText(numberAt(outcome(run, estimator), score.key), isPart(run)),
    })),
  ];
  return sortableTable(runs, columns, {
    caption: runs.some(isPart) ? `Runs. ${kPartLegend}` : "Runs", rowName: (run) => String(run.seed),
  });
}

function scoreTable(data: SuitePayload, scenario: SuiteScenario, estimator: string): HTMLElement {
  const scores = Object.entries(summaryOf(scenario, estimator)?.scores ?? {});
  type Row = [string, ScoreSummary];
  return sortableTable<Row>(scores, [
    { title: "score", value: ([key]) => key },
    { title: "unit", value: ([key]) => scoreOf(data, key).unit },
    {
      title: "median", value: ([, score]) => score.median,
      interval: ([, score]) => isNumber(score.median_low) && isNumber(score.median_high)
        ? [score.median_low, score.median_high] : null,
    },
    { title: "worst", value: ([, score]) => score.worst },
    { title: "runs with a value", value: ([, score]) => score.count, show: ([, score]) => String(score.count) },
  ], { caption: "All scores, over seeds", rowName: ([key]) => key });
}

export function details(
  data: SuitePayload, scenario: SuiteScenario, estimator: string, close: () => void
): HTMLElement {
  const level = isNumber(scenario.level) && scenario.family
    ? `${scenario.family} ${scenario.level} ${scenario.level_unit ?? ""}` : null;
  const invalid = scenario.invalid?.length ?? 0;
  return h("div", { class: "card inner" },
    h("div", { class: "page-head" }, h("h3", {}, `${scenario.name}, ${estimator}`),
      h("button", { type: "button", onclick: close }, "Close")),
    level ? h("p", { class: "soft" }, `Level: ${level}`) : null,
    invalid > 0
      ? h("p", { class: "soft" }, `${invalid} of ${scenario.seeds.length} runs are invalid and left out of the statistics.`)
      : null,
    runTable(data, scenario, estimator),
    h("details", {}, h("summary", {}, "All scores"), scoreTable(data, scenario, estimator)));
}
