// SPDX-License-Identifier: BSD-3-Clause
/** The page of a suite: matrix, families, detectors, before and after, expectations. */
import "./suite.css";
import { facts, notes } from "../charts/controls";
import { h, section } from "../dom";
import { sortableTable } from "../table";
import { themeButton } from "../theme";
import { compareSection } from "./compare";
import { familySection } from "./families";
import { matrixSection } from "./matrix";
import { estimatorsOf, type Gate, type SuitePayload } from "./model";
import { rocSection } from "./roc";

type GateRow = Gate & { scenario: string };

function limit(gate: Gate): string {
  const parts = [gate.min === null ? null : `at least ${gate.min}`, gate.max === null ? null : `at most ${gate.max}`];
  return parts.filter((part) => part !== null).join(", ");
}

function gateSection(data: SuitePayload): HTMLElement | null {
  const gates: GateRow[] = data.suite.scenarios.flatMap((scenario) =>
    (scenario.gates ?? []).map((gate) => ({ ...gate, scenario: scenario.name })));
  if (gates.length === 0) return null;
  const failed = gates.filter((gate) => !gate.holds);
  const table = (rows: GateRow[], caption: string) => sortableTable(rows, [
    { title: "scenario", value: (row) => row.scenario },
    { title: "estimator", value: (row) => row.estimator },
    { title: "score", value: (row) => row.score },
    { title: "statistic", value: (row) => row.statistic },
    { title: "expected", value: limit },
    { title: "value", value: (row) => row.value },
    { title: "met", value: (row) => row.holds, show: (row) => (row.holds ? "yes" : "✕ no") },
  ], { caption });
  return section("expectations", "Expectations",
    h("p", {}, `${gates.length - failed.length} of ${gates.length} are met.`),
    failed.length > 0 ? table(failed, "Not met") : null,
    h("details", {}, h("summary", {}, "All"), table(gates, "All expectations")));
}

function failureSection(data: SuitePayload): HTMLElement | null {
  const failures = data.suite.failures ?? [];
  if (failures.length === 0) return null;
  return section("failures", "Failed to run", notes(failures.map((each) =>
    `${each.scenario ?? ""}${each.seed === null || each.seed === undefined ? "" : `, seed ${each.seed}`}: ${each.message ?? ""}`)));
}

/** Fills `root` with the page of a suite. */
export function renderSuite(root: HTMLElement, data: SuitePayload): void {
  const runs = data.runs.length;
  const sections = [matrixSection(data), familySection(data), rocSection(data), compareSection(data),
    gateSection(data), failureSection(data)].filter((each) => each !== null);
  root.append(
    h("header", { class: "page-head" }, h("h1", {}, data.title), themeButton()),
    facts([
      ["scenarios", data.suite.scenarios.length], ["estimators", estimatorsOf(data).length], ["runs", runs],
      ["", data.suite.complete === false ? "unfinished: runs are missing" : null],
      ["aims", data.version], ["code", data.suite.code],
    ]),
    h("nav", { class: "contents", "aria-label": "Contents" }, ...sections.map((each) =>
      h("a", { href: `#${each.id}` }, each.querySelector("h2")?.textContent ?? each.id))),
    ...sections);
  const noted = notes(data.notes);
  if (noted) root.append(section("notes", "Notes", noted));
}
