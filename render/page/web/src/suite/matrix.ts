// SPDX-License-Identifier: BSD-3-Clause
/** The matrix scenario × estimator: value, colour, success, and links to the runs. */
import { unitScale } from "../charts/axis";
import { choice, tick, type Choice } from "../charts/controls";
import { h, section } from "../dom";
import { formatNumber, isNumber, kNone } from "../format";
import { failureCount, kPartLegend, partMark } from "../outcome";
import { details } from "./details";
import {
  estimatorsOf, firstScore, headlineOf, isWhole, kSuccessRate, labelOf, reasonsOf, runsOf, scoreKeysOf, scoreOf, summaryOf, valueOf,
  type SuitePayload, type SuiteScenario,
} from "./model";

interface View {
  score: string;
  statistic: "median" | "worst";
  shade: "matrix" | "row";
  group: string;
  text: string;
  divergedOnly: boolean;
  /** Estimator that rows are ordered by; null: as the suite has them. */
  sortBy: string | null;
  descending: boolean;
}

function scoreChoices(data: SuitePayload): Choice[] {
  const keys = scoreKeysOf(data);
  const headline = headlineOf(data).filter((each) => keys.includes(each.key))
    .map((each) => ({ value: each.key, label: labelOf(each) }));
  const others = keys.filter((key) => !data.headline.includes(key))
    .map((key) => ({ value: key, label: key, group: "all scores" }));
  return [...headline, { value: kSuccessRate, label: "success rate" }, ...others];
}

/** Families and tags of the scenarios, as what the matrix can be cut down to. */
function groupChoices(data: SuitePayload): Choice[] {
  const families = new Set<string>();
  const tags = new Set<string>();
  for (const each of data.suite.scenarios) {
    if (each.family) families.add(each.family);
    for (const tag of each.tags ?? []) tags.add(tag);
  }
  return [
    { value: "", label: `all ${data.suite.scenarios.length}` },
    ...[...families].map((each) => ({ value: `family:${each}`, label: each, group: "family" })),
    ...[...tags].map((each) => ({ value: `tag:${each}`, label: each, group: "tag" })),
  ];
}

function anyDiverged(scenario: SuiteScenario): boolean {
  return Object.values(scenario.estimators).some((each) => each.successes < each.runs);
}

/** Scenarios of a family together, in the place of its first one, by level. */
function inOrder(scenarios: SuiteScenario[]): SuiteScenario[] {
  const group = (each: SuiteScenario) => (each.family ? `family:${each.family}` : `scenario:${each.name}`);
  const groups = [...new Set(scenarios.map(group))];
  const place = new Map(groups.map((each, i) => [each, i]));
  const level = (each: SuiteScenario) => (isNumber(each.level) ? each.level : 0);
  return [...scenarios].sort((a, b) => place.get(group(a))! - place.get(group(b))! || level(a) - level(b));
}

function rowsOf(data: SuitePayload, view: View): SuiteScenario[] {
  const wanted = view.text.toLowerCase();
  const rows = inOrder(data.suite.scenarios).filter((each) =>
    (!view.group || view.group === `family:${each.family}` ||
      (each.tags ?? []).some((tag) => view.group === `tag:${tag}`)) &&
    each.name.toLowerCase().includes(wanted) && (!view.divergedOnly || anyDiverged(each)));
  const { sortBy } = view;
  if (sortBy === null) return rows;
  const key = (each: SuiteScenario) => valueOf(each, sortBy, view.score, view.statistic);
  return rows.sort((a, b) => {
    const x = key(a);
    const y = key(b);
    if (x === null || y === null) return Number(x === null) - Number(y === null);
    return view.descending ? y - x : x - y;
  });
}

function numbers(rows: SuiteScenario[], estimators: string[], view: View): number[] {
  return rows.flatMap((row) => estimators.map((each) => valueOf(row, each, view.score, view.statistic)))
    .filter(isNumber);
}

/** The name, which may break after an underscore. */
function breakable(name: string): (string | HTMLElement)[] {
  return name.split(/(?<=_)/).flatMap((part, i) => (i === 0 ? [part] : [h("wbr"), part]));
}

function levelText(row: SuiteScenario): string | null {
  return row.family && isNumber(row.level) ? `${row.family} ${row.level} ${row.level_unit ?? ""}` : null;
}

/** Scores of entire runs, whatever part of them an estimate has. */
const kOfWholeRuns = new Set([kSuccessRate, "success", "success_1_percent", "coverage"]);

/** Whether its value is of all that those of others are. */
function isComparable(data: SuitePayload, scenario: string, estimator: string, view: View): boolean {
  return kOfWholeRuns.has(view.score) || isWhole(data, scenario, estimator);
}

/** Text of the best value of a row, of those whose estimates are whole; null of a score of which neither end is better. */
function bestOf(data: SuitePayload, row: SuiteScenario, estimators: string[], view: View): string | null {
  const comparable = estimators.filter((name) => isComparable(data, row.name, name, view));
  const values = numbers([row], comparable, view);
  const { better } = scoreOf(data, view.score);
  if (values.length < 2 || better === "neither") return null;
  return formatNumber(better === "larger" ? Math.max(...values) : Math.min(...values));
}

function intervalText(row: SuiteScenario, estimator: string, view: View): string | null {
  const score = summaryOf(row, estimator)?.scores[view.score];
  if (view.statistic !== "median" || !score) return null;
  const { median_low: low, median_high: high } = score;
  return isNumber(low) && isNumber(high) ? `${formatNumber(low)} to ${formatNumber(high)}` : null;
}

interface Cells {
  data: SuitePayload;
  row: SuiteScenario;
  view: View;
  shade: (value: number) => number;
  best: string | null;
  open: (scenario: SuiteScenario, estimator: string) => void;
}

function cell({ data, row, view, shade, best, open }: Cells, estimator: string): HTMLElement {
  const summary = summaryOf(row, estimator);
  if (!summary) {
    const why = (row.invalid?.length ?? 0) > 0 ? "no valid run" : "not run";
    return h("td", { class: "matrix-cell none" }, h("span", { class: "soft" }, why));
  }
  const value = valueOf(row, estimator, view.score, view.statistic);
  const diverged = summary.runs - summary.successes;
  const text = formatNumber(value);
  const comparable = isComparable(data, row.name, estimator, view);
  const part = partMark(value, !comparable);
  const why = failureCount(reasonsOf(data, row.name, estimator), diverged, summary.runs);
  const of = diverged > 0 ? `✕ ${why}` : `${summary.runs} of ${summary.runs}`;
  const interval = intervalText(row, estimator, view);
  const amount = isNumber(value) ? Math.round(100 * shade(value)) : view.score === kSuccessRate ? 100 : 0;
  const button = h("button", {
    type: "button", class: "cell", tabindex: -1,
    "aria-label": `${row.name}, ${estimator}: ${text === kNone ? "no value" : text + part}` +
      `${interval ? `, ${interval}` : ""}; ${diverged > 0 ? why : "none diverged"}`,
    onclick: () => open(row, estimator),
  }, h("span", { class: "value" }, text + part),
    interval ? h("span", { class: "interval" }, interval) : null,
    diverged > 0 || summary.runs > 1 ? h("span", { class: "runs" }, of) : null);
  return h("td", {
    class: ["matrix-cell", diverged > 0 ? "diverged" : "", text === best && comparable ? "best" : ""].join(" ").trim(),
    style: `--shade: ${view.score === kSuccessRate ? 100 - amount : amount}%`,
    "data-value": isNumber(value) ? value : null, "data-estimator": estimator,
  }, button);
}

/** Whether a cell has the mark of a part. */
function anyPart(data: SuitePayload, rows: SuiteScenario[], estimators: string[], view: View): boolean {
  return rows.some((row) => estimators.some((name) =>
    isNumber(valueOf(row, name, view.score, view.statistic)) && !isComparable(data, row.name, name, view)));
}

/** Seeds as links to their pages, where there are any. */
function links(data: SuitePayload, row: SuiteScenario): HTMLElement {
  const runs = runsOf(data, row.name).filter((run) => run.href);
  return h("td", { class: "text runs-links" }, ...runs.flatMap((run) => [
    h("a", { href: run.href, "aria-label": `run of ${row.name}, seed ${run.seed}` }, run.seed), " "]));
}

function head(data: SuitePayload, estimators: string[], view: View, changed: () => void): HTMLElement {
  const sortHead = (name: string | null, title: string) => {
    const on = view.sortBy === name;
    const press = () => {
      view.descending = on && name !== null ? !view.descending : false;
      view.sortBy = name;
      changed();
    };
    return h("th", { scope: "col", "aria-sort": on && name !== null ? (view.descending ? "descending" : "ascending") : "none" },
      h("button", { type: "button", class: "sort", onclick: press }, title));
  };
  return h("thead", {}, h("tr", {}, sortHead(null, "scenario"),
    ...estimators.map((each) => sortHead(each, each)),
    data.runs.some((run) => run.href) ? h("th", { scope: "col", class: "plain" }, "runs, by seed") : null));
}

/** One tab stop for all cells; arrow keys go between them. */
function moveByArrows(table: HTMLElement): void {
  const rows = () => [...table.querySelectorAll<HTMLElement>("tbody tr")]
    .map((row) => [...row.querySelectorAll<HTMLElement>("button.cell")]);
  rows()[0]?.[0]?.setAttribute("tabindex", "0");
  table.addEventListener("focusin", (event) => {
    const target = event.target as HTMLElement;
    if (!target.classList.contains("cell")) return;
    for (const each of rows().flat()) each.setAttribute("tabindex", each === target ? "0" : "-1");
  });
  table.addEventListener("keydown", (event) => {
    const grid = rows();
    const y = grid.findIndex((row) => row.includes(event.target as HTMLElement));
    if (y < 0) return;
    const x = grid[y]!.indexOf(event.target as HTMLElement);
    const step = { ArrowUp: [0, -1], ArrowDown: [0, 1], ArrowLeft: [-1, 0], ArrowRight: [1, 0] }[event.key];
    if (!step) return;
    event.preventDefault();
    const row = grid[Math.min(grid.length - 1, Math.max(0, y + step[1]!))]!;
    row[Math.min(row.length - 1, Math.max(0, x + step[0]!))]?.focus();
  });
}

function scaleBar(values: number[], view: View, unit: string): HTMLElement | null {
  if (view.shade === "row" || values.length === 0) return null;
  const { low, high, law } = unitScale(values);
  const [from, to] = view.score === kSuccessRate ? [high, low] : [low, high];
  return h("div", { class: "scale" }, `${formatNumber(from)} ${unit}`, h("span", { class: "scale-bar heat" }),
    `${formatNumber(to)} ${unit}${law}`);
}

function matrix(data: SuitePayload, view: View, open: Cells["open"], changed: () => void): HTMLElement {
  const estimators = estimatorsOf(data);
  const rows = rowsOf(data, view);
  const score = scoreOf(data, view.score);
  if (rows.length === 0) return h("p", { class: "nothing" }, "No scenario matches this choice.");
  const all = numbers(rows, estimators, view);
  const byMatrix = unitScale(all).at;
  const anyLink = data.runs.some((run) => run.href);
  const body = rows.map((row) => {
    const shade = view.shade === "row" ? unitScale(numbers([row], estimators, view)).at : byMatrix;
    const cells: Cells = { data, row, view, shade, best: bestOf(data, row, estimators, view), open };
    return h("tr", { "data-row": row.name }, h("th", { scope: "row", title: levelText(row) }, ...breakable(row.name)),
      ...estimators.map((each) => cell(cells, each)), anyLink ? links(data, row) : null);
  });
  const what = view.score === kSuccessRate ? score.title : `${view.statistic} of ${labelOf(score)}`;
  const caption = `${what}${view.score === kSuccessRate ? "" : " over seeds, with 95 % interval where available (too narrow below ten seeds)"}; ` +
    (anyPart(data, rows, estimators, view) ? `${kPartLegend.replace(/\.$/, "; ")}` : "") +
    `${rows.length} scenario${rows.length === 1 ? "" : "s"}`;
  const table = h("table", { class: "matrix", "aria-label": caption },
    head(data, estimators, view, changed), h("tbody", {}, ...body));
  moveByArrows(table);
  return h("div", {}, h("p", { class: "soft" }, caption), h("div", { class: "table-frame matrix-frame" }, table), scaleBar(all, view, score.unit));
}

/** The section with the matrix, its choices and the details of the chosen cell. */
export function matrixSection(data: SuitePayload): HTMLElement {
  if (data.suite.scenarios.length === 0) {
    return section("matrix", "Scenarios and estimators",
      h("p", { class: "nothing" }, "No scenario of this suite has a finished run yet."));
  }
  const scores = scoreChoices(data);
  const first = scores.find((each) => each.value === firstScore(data)) ?? scores[0]!;
  const view: View = {
    score: first.value, statistic: "median", shade: "matrix", group: "", text: "", divergedOnly: false,
    sortBy: null, descending: false,
  };
  const place = h("div", {});
  const shown = h("div", { class: "cell-details", "aria-live": "polite" });
  const open: Cells["open"] = (scenario, estimator) => {
    shown.replaceChildren(details(data, scenario, estimator, () => shown.replaceChildren()));
    shown.scrollIntoView({ block: "nearest" });
  };
  const draw = () => place.replaceChildren(matrix(data, view, open, draw));
  const change = <Key extends keyof View>(key: Key) => (value: View[Key]) => {
    view[key] = value;
    draw();
  };
  const search = h("input", { type: "search", placeholder: "part of a name", "aria-label": "Scenarios with this in their name" });
  search.addEventListener("input", () => change("text")(search.value));
  draw();
  return section("matrix", data.benchmark ? "Sequences and estimators" : "Scenarios and estimators",
    h("div", { class: "toolbar" },
      choice("Score", scores, first.value, change("score")),
      choice("Statistic", [{ value: "median", label: "median" }, { value: "worst", label: "worst" }], "median",
        (value) => change("statistic")(value === "worst" ? "worst" : "median")),
      choice("Colour", [{ value: "matrix", label: "over all" }, { value: "row", label: "row by row" }], "matrix",
        (value) => change("shade")(value === "row" ? "row" : "matrix")),
      choice("Scenarios", groupChoices(data), "", change("group")), search,
      tick("only with diverged runs", false, change("divergedOnly"))),
    place, shown,
    h("p", { class: "soft" }, "Bold: best of the row of those whose estimates lack no part of a run. ✕ and hatching: runs without success, which diverged where no other reason is named; the value is over the runs that have one."));
}
