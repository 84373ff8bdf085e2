// SPDX-License-Identifier: BSD-3-Clause
/** Tables of scores.json: the paper's form first, then what else was measured. */
import type { Estimator, RunPayload } from "../contract";
import { at, h, own, section, type Child } from "../dom";
import { formatFixed, formatNumber, isNumber, kNone } from "../format";
import { bestEnd, scoreAt } from "../scores";
import { sortableTable, type CellValue, type Column } from "../table";
import { lineSample } from "../charts/svg";
import { failureMark, kPartLegend, partText } from "../outcome";
import { expectationsOf, limitsOf } from "./verdict";

interface Row {
  name: string;
  colour: number | null;
  scores: unknown;
  /** Does the estimate lack a part of the run? */
  partial: boolean;
}

const numberAt = (object: unknown, ...path: string[]): CellValue => {
  const value = at(object, ...path);
  return isNumber(value) ? value : null;
};

/** Estimators in the payload's order, then those that only scores.json holds. */
function rows(data: RunPayload): Row[] {
  const scores = own<object>(data.scores, "estimators") ?? {};
  const known = data.estimators.map((item: Estimator): Row => ({
    name: item.name,
    colour: item.colour_index,
    scores: own(scores, item.name),
    partial: data.partial.includes(item.name),
  }));
  const names = new Set(known.map((row) => row.name));
  const others = Object.keys(scores).filter((name) => !names.has(name));
  return [
    ...known,
    ...others.map((name): Row => ({ name, colour: null, scores: own(scores, name), partial: data.partial.includes(name) })),
  ];
}

function nameCell(row: Row): Child {
  return h("span", { class: "estimator-name", title: row.name },
    row.colour === null ? null : lineSample(row.colour), h("bdi", {}, row.name));
}

const nameColumn: Column<Row> = { title: "Estimator", value: (row) => row.name, show: nameCell };
const success = (row: Row) => at(row.scores, "success") === true;

/** Column of a score, with the list's title where it gets no other; an estimator that diverged is never best. */
function score(data: RunPayload, path: string[], hint: string, title?: string): Column<Row> {
  const listed = scoreAt(data.score_list, path.join("."));
  return {
    title: title ?? listed?.title ?? path.join("."),
    unit: listed?.unit,
    hint,
    best: bestEnd(listed),
    eligible: success,
    value: (row) => numberAt(row.scores, ...path),
  };
}

/** The columns of scores with the mark of an estimate that lacks a part of the run. */
function withParts(columns: Column<Row>[]): Column<Row>[] {
  return columns.map((column) =>
    (column.best ? { ...column, show: (row) => partText(column.value(row), row.partial) } : column));
}

/** What that mark means, behind a caption; empty where none stands. */
function partLegend(list: Row[], columns: Column<Row>[]): string {
  return list.some((row) => row.partial && columns.some((column) => column.best && isNumber(column.value(row)))) ? ` ${kPartLegend}` : "";
}

/** The column in thousandths of what the score has. */
function milli(column: Column<Row>): Column<Row> {
  return {
    ...column,
    unit: `m${column.unit}`,
    value: (row) => {
      const value = column.value(row);
      return isNumber(value) ? 1000 * value : null;
    },
  };
}

function segmentNames(data: RunPayload): string[] {
  const segments = own<unknown>(data.scores, "segments");
  return Array.isArray(segments) ? segments.map((item) => String(own(item, "name") ?? "")) : [];
}

/** M_end beyond this many times the ATE yaw is that of the first pose. */
const kMuchLarger = 5;

/** Why M_end of the best is much larger than its ATE; empty if it is not. */
export function endNote(list: Pick<Row, "name" | "scores">[]): string {
  const ate = (row: Pick<Row, "scores">) => Number(at(row.scores, "ate_yaw_m") ?? NaN);
  const best = list.filter((row) => at(row.scores, "success") === true && Number.isFinite(ate(row))).sort((a, b) => ate(a) - ate(b))[0];
  const end = best ? at(best.scores, "m_end_m") : null;
  if (!best || !isNumber(end) || end < kMuchLarger * ate(best)) return "";
  return ` M_end of ${best.name} is much larger than its ATE yaw, since the first pose carries the error of the LiDAR's mounting yaw along the whole way.`;
}

function paperTable(data: RunPayload, list: Row[]): HTMLElement {
  const columns: Column<Row>[] = [
    nameColumn,
    score(data, ["ate_yaw_m"],
      "RMSE of position after alignment by heading and translation, which LiDAR-inertial odometry cannot observe"),
    score(data, ["m_list_percent", "all"], "Error of the distances between reference points, eq. (13)"),
    score(data, ["m_end_m"], "Error of the displacement from start to end, eq. (14)"),
    score(data, ["max_error_z_m"], "Largest height error"),
    { title: "Success", hint: "Or when it diverged, in seconds after the start", value: (row) => outcome(data, row) },
    ...(list.some((row) => at(row.scores, "health", "worst") !== undefined) ? [healthColumn] : []),
  ];
  const shown = columns.filter((column) => column.show || column === nameColumn || list.some((row) => column.value(row) !== null));
  return sortableTable(list, withParts(shown), {
    caption:
      "ATE yaw: aligned by heading and translation; M_end and max |z|: by the first pose. –: no value. " +
      `✕: when it diverged, after the start.${partLegend(list, shown)}${endNote(list)}`,
    bestLegend: "Bold: best of those that succeeded.",
    rowName: (row) => row.name,
  });
}

/** "never started" is what the terminal says, too. */
function healthWord(worst: unknown): string {
  return worst === "starting" ? "never started" : String(worst ?? kNone);
}

/** Least time of being healthy while wrong that is said, as on the terminal [s]. */
const kLeastUnnoticed = 1;

/** Whether and how long it called itself healthy while its error exceeded the limit of a success; empty if not. */
function unnoticedText(row: Row): string {
  const seconds = at(row.scores, "health", "healthy_while_wrong_s");
  if (isNumber(seconds) && seconds >= kLeastUnnoticed) return `healthy for ${formatFixed(seconds, 1)} s while wrong`;
  const worst = at(row.scores, "health", "worst");
  return row.scores !== undefined && !success(row) && worst === "healthy" ? "healthy, but wrong" : "";
}

/** What the estimator says of itself beside what the truth says of it. */
const healthColumn: Column<Row> = {
  title: "Reports itself",
  hint: "Worst state that the estimator reported, without the truth",
  value: (row) => String(at(row.scores, "health", "worst") ?? ""),
  show: (row) => {
    const worst = healthWord(at(row.scores, "health", "worst"));
    const unnoticed = unnoticedText(row);
    if (unnoticed === "") return worst;
    const text = worst === "healthy" ? unnoticed : `${worst}; ${unnoticed}`;
    return h("span", { class: "unnoticed", title: "Time for which it called itself healthy after its error exceeded the limit of a success" }, text);
  },
};

function outcome(data: RunPayload, row: Row): string {
  if (row.scores === undefined) return kNone;
  if (data.scenario.robot?.valid === false) return "invalid run";
  const divergedAt = at(row.scores, "diverged_at_s");
  const reason = at(row.scores, "diverged_reason");
  if (isNumber(divergedAt)) return failureMark(reason, divergedAt - (data.t0_s ?? 0));
  if (at(row.scores, "diverged_reason") === "no_poses") return "no poses";
  return success(row) ? "yes" : "no";
}

/** Columns in which at least one estimator has a value. */
function errorTable(data: RunPayload, list: Row[]): HTMLElement {
  const rmse = (axis: string, hint: string, title = axis) => score(data, ["drift_m", "rmse", axis], hint, title);
  const scores: Column<Row>[] = [
    ...segmentNames(data).map((name) => {
      const column = score(data, ["m_list_percent", name], "Error of the straight distance between reference points, eq. (13)");
      return { ...column, title: `${column.title}(${name})` };
    }),
    score(data, ["ate_m"], "RMSE of position, aligned by the first pose alone"),
    score(data, ["ate_se3_m"], "RMSE after SE(3) alignment"),
    score(data, ["max_error_m"], "Largest position error, anchored at the start", "max"),
    score(data, ["rpe_1m", "translation_m"], "Relative pose error over 1 m travelled"),
    score(data, ["rpe_10m", "translation_m"],
      "Relative pose error over 10 m travelled; –: the path is below 20 m, the first piece begins after 10 m"),
    score(data, ["heading_error_mrad"], "RMSE of the yaw after the alignment by heading"),
    rmse("longitudinal", "RMSE along the true heading"),
    rmse("lateral", "RMSE across the true heading"),
    rmse("vertical", "RMSE of the height"),
    milli(rmse("heading_rad", "RMSE of the heading, aligned at the start", "heading, start")),
    milli(rmse("tilt_rad", "RMSE of roll and pitch together", "tilt")),
  ];
  const known = scores.filter((column) => list.some((row) => column.value(row) !== null));
  return sortableTable(list, [nameColumn, ...withParts(known)], {
    caption: `Errors against the truth.${partLegend(list, known)}`,
    rowName: (row) => row.name,
  });
}

function timeTable(data: RunPayload, list: Row[]): HTMLElement | null {
  const p99 = (column: Column<Row>) => ({ ...column, title: `${column.title} p99` });
  const scores: Column<Row>[] = [
    score(data, ["cpu_per_scan_ms", "mean"], "Processor time from one scan to the next"),
    p99(score(data, ["cpu_per_scan_ms", "p99"], "99th percentile of the processor time")),
    p99(score(data, ["time_per_scan_ms", "p99"], "99th percentile of the wall time, which grows on a busy machine")),
  ];
  const known = scores.filter((column) => list.some((row) => column.value(row) !== null));
  if (known.length === 0) return null;
  return sortableTable(list, [nameColumn, ...known], {
    caption: "Time from one scan to the next",
    rowName: (row) => row.name,
  });
}

function weakTable(list: Row[]): HTMLElement | null {
  const levels = ["all", "n1000", "n100", "n10"].filter((level) =>
    list.some((row) => Number(at(row.scores, "weak_axis", level, "scans")) > 0),
  );
  if (levels.length === 0) return null;
  const words: Record<string, string> = {
    all: "all scans",
    n1000: "< 1000 returns",
    n100: "< 100 returns",
    n10: "< 10 returns",
  };
  interface Cell extends Row {
    level: string;
  }
  const cells: Cell[] = levels
    .flatMap((level) => list.map((row) => ({ ...row, level })))
    .filter((row) => at(row.scores, "weak_axis", row.level) !== undefined);
  const get = (name: string) => (row: Cell) => numberAt(row.scores, "weak_axis", row.level, name);
  const columns: Column<Cell>[] = [
    { title: "Estimator", value: (row) => row.name, show: nameCell },
    { title: "Scans", value: (row) => `${words[row.level] ?? row.level}` },
    { title: "count", value: get("scans"), show: (row) => formatFixed(get("scans")(row), 0) },
    { title: "error rms", unit: "m", value: get("error_rms_m") },
    {
      title: "bound rms",
      unit: "m",
      value: get("bound_rms_m"),
      hint: "Posterior Cramér–Rao bound with an unknown map",
    },
    {
      title: "efficiency",
      value: get("efficiency"),
      hint: "Bound divided by error; 1 is optimal",
    },
    {
      title: "NEES",
      value: get("nees"),
      hint: "Error² divided by the stated variance; 1 is consistent, above 1 overconfident",
    },
  ];
  return sortableTable(cells, columns, {
    caption: "Error along the weakest axis of each scan, for all scans and for degenerate scans",
    rowName: (row) => `${row.name} ${row.level}`,
  });
}

/** What each estimator reported of itself, without the truth. */
function healthTable(data: RunPayload): HTMLElement | null {
  const list = data.estimators.filter((item) => item.health);
  if (list.length === 0) return null;
  const seconds = (title: string, key: string, hint: string): Column<Estimator> => ({
    title,
    unit: "s",
    hint,
    value: (item) => numberAt(item.health, key),
    show: (item) => formatFixed(Number(at(item.health, key)), 1),
  });
  return sortableTable(
    list,
    [
      { title: "Estimator", value: (item) => item.name },
      { title: "reports of itself", value: (item) => String(at(item.health, "text") || at(item.health, "worst") || "") },
      seconds("healthy", "healthy_s", "Every source arrives and agrees with the others"),
      seconds("degraded", "degraded_s", "A source is missing or contradicts another"),
      seconds("invalid", "invalid_s", "The estimate must not be used"),
    ],
    { caption: "Health, as each estimator reports it", rowName: (item) => item.name },
  );
}

/** How far each estimate of a recording goes; null of a simulated run. */
function summaryTable(data: RunPayload): HTMLElement | null {
  const list = data.estimators.filter((item) => item.summary);
  if (list.length === 0) return null;
  const metres = (title: string, key: string, hint: string): Column<Estimator> => ({
    title, unit: "m", hint,
    value: (item) => numberAt(item.summary, key),
    show: (item) => formatFixed(Number(at(item.summary, key)), 2),
  });
  return sortableTable(
    list,
    [
      { title: "Estimator", value: (item) => item.name },
      { title: "poses", value: (item) => numberAt(item.summary, "poses"), show: (item) => formatFixed(Number(at(item.summary, "poses")), 0) },
      metres("path", "path_m", "Length of the estimated path"),
      metres("displacement", "displacement_m", "Straight distance from the first pose to the last"),
    ],
    { caption: "Estimated paths", rowName: (item) => item.name },
  );
}

function expectationTable(data: RunPayload): HTMLElement | null {
  const all = expectationsOf(data);
  if (all.length === 0) return null;
  return sortableTable(
    all,
    [
      { title: "Expected of", value: (row) => row.estimator || "the run itself" },
      { title: "Score", value: (row) => row.score ?? "" },
      { title: "Limits", value: limitsOf },
      { title: "Value", value: (row) => row.value },
      { title: "Holds", value: (row) => row.holds, show: (row) => (row.holds ? "yes" : "✕ no") },
    ],
    { caption: "Expectations of the scenario" },
  );
}

/** Localizability from the simulated truth; the same for every estimator. */
function truthLine(data: RunPayload): HTMLElement | null {
  const truth = own<unknown>(data.scores, "localizability");
  if (truth === undefined || truth === null) return null;
  const fraction = (level: string) => {
    const value = at(truth, "degenerate_fraction", level);
    return isNumber(value) ? `${formatFixed(100 * value, 0)} %` : kNone;
  };
  const bound = (axis: string) => formatNumber(at(truth, "bound_end_m", axis));
  return h(
    "p",
    { class: "soft" },
    `From the truth: ${formatNumber(at(truth, "median_equivalent_returns"))} equivalent returns ` +
      `along the weakest axis (median); fewer than 10 in ${fraction("n10")} of the scans, ` +
      `fewer than 100 in ${fraction("n100")}, fewer than 1000 in ${fraction("n1000")}. ` +
      "Lower bound by the noise of the sensors (posterior Cramér–Rao, for legs that do not slip and without the " +
      "knowledge that the floor is level), standard deviation of the position at the end: " +
      `${bound("longitudinal")} m along the corridor, ${bound("lateral")} m across, ${bound("vertical")} m up.`,
  );
}

/** What the page leads with: the paper's scores with the expectations, or the health without scores. */
export function leadSection(data: RunPayload): HTMLElement | null {
  const list = data.scores ? rows(data) : [];
  const health = healthTable(data);
  if (list.length === 0) {
    const tables = [summaryTable(data), health].filter((table) => table !== null);
    return tables.length > 0 ? section("results", "Results", h("div", { class: "tables" }, ...tables)) : null;
  }
  return section(
    "results",
    "Results",
    h(
      "div",
      { class: "tables" },
      h("div", { "data-table": "paper" }, paperTable(data, list)),
      expectationTable(data),
    ),
  );
}

/** What else was scored; null without scores. */
export function detailSection(data: RunPayload): HTMLElement | null {
  const list = data.scores ? rows(data) : [];
  if (list.length === 0) return null;
  return section(
    "details",
    "Details",
    h(
      "div",
      { class: "tables" },
      h("div", { "data-table": "errors" }, errorTable(data, list)),
      weakTable(list),
      h("div", { "data-table": "times" }, timeTable(data, list)),
      healthTable(data),
    ),
    truthLine(data),
  );
}
