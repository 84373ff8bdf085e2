// SPDX-License-Identifier: BSD-3-Clause
/** The page of a suite: matrix, runs, families, detectors, before and after, expectations. */
import "./suite.css";
import { facts, notes } from "../charts/controls";
import { h, section } from "../dom";
import { firstLine, isNumber } from "../format";
import { sortableTable } from "../table";
import { themeButton } from "../theme";
import { benchmarkSection, benchmarkVerdict } from "./benchmark";
import { compareSection } from "./compare";
import { consistencySection } from "./consistency";
import { familySection } from "./families";
import { matrixSection } from "./matrix";
import { estimatorsOf, failuresOf, isOfInvalidRun, type Expectation, type SuitePayload } from "./model";
import { multiplesSection } from "./multiples";
import { pairsSection } from "./pairs";
import { paperSection } from "./paper";
import { seedsSection, seedsVerdict } from "./seeds";
import { rocSection } from "./roc";

type ExpectationRow = Expectation & { scenario: string };

function limit(row: Expectation): string {
  const parts = [row.min === null ? null : `at least ${row.min}`, row.max === null ? null : `at most ${row.max}`];
  return parts.filter((part) => part !== null).join(", ");
}

function expectationSection(data: SuitePayload): HTMLElement | null {
  const all: ExpectationRow[] = data.suite.scenarios.flatMap((scenario) =>
    (scenario.expectations ?? []).map((each) => ({ ...each, scenario: scenario.name })));
  if (all.length === 0) return null;
  const failed = all.filter((row) => !row.holds);
  const table = (rows: ExpectationRow[], caption: string) => sortableTable(rows, [
    { title: "scenario", value: (row) => row.scenario },
    { title: "estimator", value: (row) => row.estimator || "the run itself" },
    { title: "score", value: (row) => row.score },
    { title: "statistic", value: (row) => row.statistic },
    { title: "expected", value: limit },
    { title: "value", value: (row) => row.value },
    { title: "met", value: (row) => row.holds, show: (row) => (row.holds ? "yes" : "✕ no") },
  ], { caption });
  return section("expectations", "Expectations",
    h("p", {}, `${all.length - failed.length} of ${all.length} are met.`),
    failed.length > 0 ? table(failed, "Not met") : null,
    h("details", {}, h("summary", {}, "All"), table(all, "All expectations")));
}

function failureSection(data: SuitePayload): HTMLElement | null {
  const failures = data.suite.failures ?? [];
  if (failures.length === 0) return null;
  return section("failures", "Failed to run", notes(failures.map((each) => {
    const seed = isNumber(each.seed) ? `, seed ${each.seed}` : "";
    const estimator = each.estimator ? `, ${each.estimator}` : "";
    const invalid = isOfInvalidRun(data, each) ? " (on an invalid run)" : "";
    return `${each.scenario ?? ""}${seed}${estimator}${invalid}: ${firstLine(each.message)}`;
  })));
}

/** Who failed on valid runs, above the results that lack it; null for none. */
function failureBanner(data: SuitePayload): HTMLElement | null {
  const failures = failuresOf(data);
  if (failures.length === 0) return null;
  const names = [...new Set(failures.map((each) => each.estimator || each.scenario || ""))];
  return h("div", { class: "banner", role: "alert", "data-failures": failures.length },
    h("strong", {}, `${failures.length === 1 ? "One failure" : `${failures.length} failures`}: ${names.join(", ")}. `),
    h("a", { href: "#failures" }, "Failed to run"));
}

/** How many there are, and how many more failed on every run. */
function estimatorText(data: SuitePayload): string {
  const names = estimatorsOf(data);
  const failed = new Set(failuresOf(data).map((each) => each.estimator ?? "").filter((each) => each && !names.includes(each)));
  return failed.size === 0 ? `${names.length}` : `${names.length}, and ${failed.size} that failed on every run`;
}

/** What was set on top of the scenarios; null for nothing. */
function settingsLine(data: SuitePayload): HTMLElement | null {
  const settings = data.suite.settings ?? [];
  if (settings.length === 0) return null;
  return h("p", { "data-settings": settings.length }, "Set on top of the scenario: ",
    ...settings.flatMap((each, i) => [i > 0 ? ", " : "", h("code", {}, each)]));
}

/** What stands above everything else when runs are invalid. */
function invalidBanner(data: SuitePayload): HTMLElement | null {
  const invalid = data.suite.scenarios.flatMap((scenario) =>
    (scenario.invalid ?? []).map((run) => `${scenario.name}, seed ${run.seed}: ${run.reason}`));
  if (invalid.length === 0) return null;
  return h("div", { class: "banner", role: "alert" },
    h("strong", {}, `${invalid.length} of ${data.runs.length} runs are invalid and left out of every statistic.`),
    h("ul", {}, ...invalid.map((each) => h("li", {}, each))));
}

/** Fills `root` with the page of a suite. */
export function renderSuite(root: HTMLElement, data: SuitePayload): void {
  const runs = data.runs.length;
  const banner = invalidBanner(data);
  const one = data.suite.scenarios.length === 1;
  const sections = [benchmarkSection(data), paperSection(data), one ? seedsSection(data) : matrixSection(data), one ? matrixSection(data) : seedsSection(data),
    pairsSection(data), multiplesSection(data), familySection(data), rocSection(data), consistencySection(data), compareSection(data),
    expectationSection(data), failureSection(data)].filter((each) => each !== null);
  root.append(
    h("header", { class: "page-head" }, h("h1", {}, data.title), themeButton()),
    facts([
      [data.benchmark ? "sequences" : "scenarios", data.suite.scenarios.length], ["estimators", estimatorText(data)], ["runs", runs],
      ["", data.suite.complete === false ? "unfinished: runs are missing" : null],
      ["aims", data.version], ["code", data.suite.code],
    ]),
    data.description ? h("p", { class: "soft" }, data.description) : "",
    settingsLine(data) ?? "",
    ...(banner ? [banner] : []),
    failureBanner(data) ?? "",
    (data.benchmark ? benchmarkVerdict(data) : seedsVerdict(data)) ?? "",
    h("nav", { class: "contents", "aria-label": "Contents" }, ...sections.map((each) =>
      h("a", { href: `#${each.id}` }, each.querySelector("h2")?.textContent ?? each.id))),
    ...sections);
  const noted = notes(data.notes);
  if (noted) root.append(section("notes", "Notes", noted));
}
