// SPDX-License-Identifier: BSD-3-Clause
/** The suite against other results: before, after, and whether the change is significant. */
import { choice, notes } from "../charts/controls";
import { h, section } from "../dom";
import { formatNumber, isNumber } from "../format";
import { sortableTable } from "../table";
import { labelOf, scoreOf, type Comparison, type ScoreChange, type SuitePayload } from "./model";

const kVerdicts: Record<string, string> = {
  better: "▲ better", worse: "▼ worse", "too few": "? too few seeds", small: "= below the relevant change",
  none: "= within noise", same: "= same",
};
const kRank = ["worse", "better", "too few", "small", "none", "same"];

function verdictText(verdict: string): string {
  return Object.hasOwn(kVerdicts, verdict) ? kVerdicts[verdict]! : verdict;
}

function signed(value: number): string {
  return `${value > 0 ? "+" : ""}${formatNumber(value)}`;
}

function changeTable(data: SuitePayload, rows: ScoreChange[], caption: string): HTMLElement {
  return sortableTable(rows, [
    { title: "scenario", value: (row) => row.scenario },
    { title: "estimator", value: (row) => row.estimator },
    {
      title: "score", value: (row) => row.score,
      show: (row) => labelOf(scoreOf(data, row.score)),
    },
    { title: "seeds", value: (row) => row.seeds, show: (row) => String(row.seeds) },
    { title: "before", value: (row) => row.before },
    { title: "after", value: (row) => row.after },
    {
      title: "change", hint: "mean of the paired differences, after − before, with its 95 % interval",
      value: (row) => row.change,
      show: (row) => (isNumber(row.change) ? signed(row.change) : formatNumber(row.change)),
      interval: (row) => isNumber(row.change_low) && isNumber(row.change_high) ? [row.change_low, row.change_high] : null,
    },
    {
      title: "verdict", value: (row) => kRank.indexOf(row.verdict),
      show: (row) => h("span", { class: `verdict-${row.verdict === "better" || row.verdict === "worse" ? row.verdict : "none"}` },
        verdictText(row.verdict)),
    },
    {
      title: "false alarm", hint: "probability of such a verdict when the signs of the paired differences are random",
      value: (row) => row.false_alarm,
    },
  ], { caption, rowName: (row) => `${row.scenario}/${row.estimator}/${row.score}` });
}

function only(title: string, names: string[]): HTMLElement | null {
  if (names.length === 0) return null;
  return h("details", {}, h("summary", {}, `${title}: ${names.length}`), notes(names));
}

/** The section; none without other results. */
export function compareSection(data: SuitePayload): HTMLElement | null {
  const compare: Comparison | null = data.compare;
  if (!compare) return null;
  const decided = (row: ScoreChange) => row.verdict === "better" || row.verdict === "worse";
  let verdict = compare.changes.some(decided) ? "decided"
    : compare.changes.some((row) => row.verdict === "too few") ? "too few" : "all";
  let score = "";
  const place = h("div", {});
  const scores = [...new Set(compare.changes.map((row) => row.score))];
  const draw = () => {
    const rows = compare.changes.filter((row) =>
      (verdict === "all" || (verdict === "decided" ? decided(row) : row.verdict === verdict)) &&
      (!score || row.score === score));
    place.replaceChildren(rows.length > 0
      ? changeTable(data, rows, `${rows.length} of ${compare.changes.length} comparisons`)
      : h("p", { class: "nothing" }, compare.changes.length > 0
          ? "No comparison has this verdict." : "The two have no scenario, seed and estimator in common."));
  };
  draw();
  return section("compare", `${compare.after} against ${compare.before}`,
    compare.summary ? h("p", {}, compare.summary) : null,
    compare.differs ? h("div", { class: "banner", role: "alert" }, compare.differs) : null,
    h("div", { class: "toolbar" },
      choice("Verdict", [
        { value: "decided", label: "better or worse" },
        ...kRank.map((each) => ({ value: each, label: verdictText(each) })), { value: "all", label: "all" },
      ], verdict, (value) => { verdict = value; draw(); }),
      choice("Score", [{ value: "", label: "all" },
        ...scores.map((each) => ({ value: each, label: scoreOf(data, each).title }))], "",
      (value) => { score = value; draw(); })),
    place, only(`Fails in ${compare.after} alone`, compare.fails_now ?? []), only(`Fails in ${compare.before} alone`, compare.fails_no_more ?? []), only("Success alone compared: an estimate lacks a part of the run", compare.partial ?? []), only(`Only in ${compare.before}`, compare.only_before), only(`Only in ${compare.after}`, compare.only_after));
}
