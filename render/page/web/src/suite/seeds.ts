// SPDX-License-Identifier: BSD-3-Clause
/** Over the seeds of a scenario: the table of its scores, and how they scatter. */
import { boxPlot, type BoxGroup } from "../charts/box_plot";
import { choice } from "../charts/controls";
import { lineSample } from "../charts/svg";
import type { ListedScore } from "../contract";
import { at, h, own, section } from "../dom";
import { finding, type Finding } from "../findings";
import { formatNumber, isNumber, kNone } from "../format";
import { failureCount, kPartLegend, partMark, reasonName } from "../outcome";
import { bestEnd } from "../scores";
import { sortableTable, type Column } from "../table";
import {
  estimatorsOf, failuresOf, firstScore, headlineOf, isWhole, labelOf, reasonsOf, runsOf, scoreOf, styleOf, summaryOf,
  type EstimatorSummary, type SuitePayload, type SuiteScenario,
} from "./model";

interface Row {
  name: string;
  summary: EstimatorSummary;
  /** Seeds on which it failed, of all. */
  failed: number;
  seeds: number;
}

/** Whether it is a median over runs of which none succeeded, which says nothing. */
function isLost(row: Row, median: unknown): boolean {
  return row.summary.runs > 0 && row.summary.successes === 0 && isNumber(median);
}

/** Median and worst; marked where no run succeeded, and where they are of parts of the runs. */
function scoreColumn(data: SuitePayload, scenario: string, score: ListedScore): Column<Row> {
  const of = (row: Row) => own<{ median: unknown; worst: unknown }>(row.summary.scores, score.key);
  const whole = (row: Row) => isWhole(data, scenario, row.name);
  return {
    title: score.title, unit: score.unit, best: bestEnd(score), eligible: (row) => !isLost(row, of(row)?.median) && whole(row),
    hint: "median over seeds (worst)",
    value: (row) => {
      const median = of(row)?.median;
      return isNumber(median) ? median : null;
    },
    show: (row) => {
      const { median, worst } = of(row) ?? {};
      const text = formatNumber(median) + (row.summary.runs > 1 && isNumber(worst) ? ` (${formatNumber(worst)})` : "");
      return text + (isLost(row, median) ? " ✕" : "") + partMark(median, !whole(row));
    },
  };
}

function successText(row: Row): string {
  const { successes, runs, success_low: low, success_high: high } = row.summary;
  if (runs === 0 && row.failed === 0) return kNone;  // the truth says nothing of the way
  if (runs === 0) return `failed on ${row.failed} of ${row.seeds} seeds`;
  const rate = isNumber(low) && isNumber(high) ? ` (${Math.round(100 * low)}–${Math.round(100 * high)} %)` : "";
  return `${successes} of ${runs}${rate}${row.failed > 0 ? `, failed on ${row.failed} of ${row.seeds} seeds` : ""}`;
}

/** Why runs are no success, where that is not their error. */
function reasonText(data: SuitePayload, scenario: string, { name, summary }: Row): string {
  const reasons = reasonsOf(data, scenario, name);
  if (reasons.every((each) => ["diverged", "failed"].includes(reasonName(each)))) return "";
  return ` ✕ ${failureCount(reasons, summary.runs - summary.successes, summary.runs)}`;
}

function table(data: SuitePayload, scenario: SuiteScenario): HTMLElement {
  const invalid = new Set<unknown>(runsOf(data, scenario.name).filter((run) => run.invalid).map((run) => run.seed));
  const failures = failuresOf(data).filter((each) => each.scenario === scenario.name && each.estimator);
  const failed = failures.flatMap((each) => each.estimator!.split(", "));
  const names = new Set([...Object.keys(scenario.estimators), ...failed]);
  const rows = [...names].map((name): Row => ({
    name, summary: summaryOf(scenario, name) ?? { runs: 0, successes: 0, success_rate: null, scores: {} },
    failed: failed.filter((each) => each === name).length, seeds: scenario.seeds.length - invalid.size,
  }));
  const columns: Column<Row>[] = [
    {
      title: "estimator", value: (row) => row.name,
      show: (row) => h("span", { class: "estimator-name", title: row.name }, lineSample(styleOf(data, row.name)), h("bdi", {}, row.name)),
    },
    ...headlineOf(data).map((score) => scoreColumn(data, scenario.name, score)),
    {
      title: "within 5 %", value: (row) => row.summary.successes,
      hint: "95 % interval of the rate (Wilson)", show: (row) => successText(row) + reasonText(data, scenario.name, row),
    },
    {
      title: "within 1 %", value: (row) => row.summary.successes_1_percent,
      show: (row) => (row.summary.runs === 0 ? kNone : `${row.summary.successes_1_percent ?? "–"} of ${row.summary.runs}`),
    },
  ];
  const scored = rows.filter((row) => data.headline.some((key) => isNumber(at(row.summary.scores, key, "median"))));
  const legend = [
    "Median over seeds (worst).", scored.some((row) => row.summary.runs > 0 && row.summary.successes === 0) ? "✕: no run succeeded." : "",
    scored.some((row) => !isWhole(data, scenario.name, row.name)) ? kPartLegend : "",
    "Within 5 % (success), 1 %: position error of the distance travelled so far; interval: 95 %.",
  ];
  return sortableTable(rows, columns.filter((column, i) => i === 0 || rows.some((row) => column.value(row) !== null)), {
    caption: legend.filter((each) => each !== "").join(" "), rowName: (row) => row.name,
    bestLegend: "Bold: best of those with a success whose estimates lack no part of a run.",
  });
}

function boxes(data: SuitePayload, scenario: SuiteScenario, score: string): HTMLElement {
  const runs = runsOf(data, scenario.name).filter((run) => !run.invalid);
  const groups = estimatorsOf(data).filter((name) => Object.hasOwn(scenario.estimators, name)).map((name): BoxGroup => ({
    name, index: styleOf(data, name),
    values: runs.flatMap((run) => {
      const value = at(run.estimators, name, score);
      return isNumber(value) ? [{ value: Math.abs(value), failed: at(run.estimators, name, "success") === false, note: `seed ${run.seed}` }] : [];
    }),
  }));
  const shown = scoreOf(data, score);
  return boxPlot(groups, { label: `${shown.title} of each estimator over the seeds of ${scenario.name}`, xLabel: labelOf(shown) });
}

const kVerbs: Record<string, string> = {
  failed: "failed to run", gap: "has a gap", starts_late: "starts late", ends_early: "ends early", no_poses: "has no poses",
  invalid_pose: "returns poses that are none",
};

/** "has a gap on 4 of 4 seeds", "failed to run on 1 and diverges on 2 of 4 seeds"; null where estimates are whole. */
function missingText(data: SuitePayload, scenario: string, name: string, runs: number): string | null {
  const reasons = reasonsOf(data, scenario, name);
  if (reasons.every((each) => reasonName(each) === "diverged")) return null;
  const verbs = reasons.map((each) => (reasonName(each) === "diverged" ? "diverges" : kVerbs[String(each)] ?? "is incomplete"));
  const texts = [...new Set(verbs)].map((verb) => `${verb} on ${verbs.filter((each) => each === verb).length}`);
  return `${texts.join(" and ")} of ${runs} seeds`;
}

/** Whether the scores of some run are of a part of it; a run that failed has none. */
function hasParts(data: SuitePayload, scenario: string, name: string): boolean {
  return runsOf(data, scenario).some((run) => run.partial.includes(name) && Object.hasOwn(run.estimators, name));
}

type ScoreOf = (key: string, statistic: "median" | "worst") => number | null;

/** The direction that fails, where by the medians it is not the one along the way; its largest error on any seed. */
function asideOf(number: ScoreOf): Finding["aside"] {
  const rmse = (axis: string) => number(`drift_m.rmse.${axis}`, "median") ?? 0;
  const [along, across, up] = [rmse("longitudinal"), rmse("lateral"), rmse("vertical")];
  if (up > across && up > along) return { direction: "height", most: Math.max(up, number("max_error_z_m", "worst") ?? 0) };
  return across > along ? { direction: "sideways", most: number("drift_m.max.lateral", "worst") ?? across } : null;
}

function findingOf(data: SuitePayload, scenario: SuiteScenario, name: string): Finding {
  const summary = summaryOf(scenario, name)!;
  const number: ScoreOf = (key, statistic) => {
    const value = own<Record<string, unknown>>(summary.scores, key)?.[statistic];
    return isNumber(value) ? value : null;
  };
  const failures = summary.runs - summary.successes;
  const whole = !hasParts(data, scenario.name, name);
  return {
    name, success: summary.successes > summary.runs / 2, percent: whole ? number("m_list_percent.all", "median") : null,
    worst: summary.runs > 1 ? number("m_list_percent.all", "worst") : null, signed: null,
    ate: whole ? number("ate_yaw_m", "median") : null, loss: null, aside: asideOf(number), returns: null, healthy: false,
    successes: summary.successes,
    fails: failures > 0 ? `${failures} of ${summary.runs} seeds` : null,
    missing: missingText(data, scenario.name, name, summary.runs),
  };
}

/** What a page of one scenario leads with: one sentence, over the medians; null for none. */
export function seedsVerdict(data: SuitePayload): HTMLElement | null {
  const only = data.suite.scenarios[0];
  if (data.suite.scenarios.length !== 1 || !only) return null;
  const text = finding(Object.keys(only.estimators).map((name) => findingOf(data, only, name)), { corridor: data.corridor === true, length: Infinity });
  if (!text) return null;
  const runs = only.seeds.length - (only.invalid?.length ?? 0);
  return h("div", { class: "verdict", "data-verdict": "plain", role: "status" },
    h("p", {}, h("strong", {}, text), runs > 1 ? ` Over ${runs} seeds.` : ""));
}

/** Table and box plots of the chosen scenario; null without runs. */
export function seedsSection(data: SuitePayload): HTMLElement | null {
  const scenarios = data.suite.scenarios.filter((each) => Object.keys(each.estimators).length > 0);
  if (scenarios.length === 0 || data.headline.length === 0) return null;
  let scenario = scenarios[0]!;
  let score = firstScore(data);
  const place = h("div", {});
  const draw = () => place.replaceChildren(
    h("div", { class: "seeds-parts" }, table(data, scenario),
      runsOf(data, scenario.name).length > 1 ? boxes(data, scenario, score) : ""));
  draw();
  const title = data.benchmark ? "All scores of a sequence" : scenarios.length === 1 ? "Over seeds" : "One scenario over its seeds";
  return section("seeds", title,
    h("div", { class: "toolbar" },
      scenarios.length > 1 ? choice("Scenario", scenarios.map((each) => ({ value: each.name, label: each.name })), scenario.name, (name) => {
        scenario = scenarios.find((each) => each.name === name) ?? scenario;
        draw();
      }) : null,
      choice("Box plot of", headlineOf(data).map((each) => ({ value: each.key, label: labelOf(each) })), score, (key) => {
        score = key;
        draw();
      })),
    place);
}
