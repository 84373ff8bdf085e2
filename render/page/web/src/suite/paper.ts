// SPDX-License-Identifier: BSD-3-Clause
/** The paper's tables beside what the same systems reach here. */
import { h, section } from "../dom";
import { formatFixed } from "../format";
import { pictureGrid } from "../pictures";
import { sortableTable, type Column } from "../table";
import type { PaperExperiment, PaperSystem, SuitePayload } from "./model";

/** Columns of one score: the paper's figure and the median here with the worst. */
function columnsOf(experiment: PaperExperiment, index: number): Column<PaperSystem>[] {
  const title = experiment.columns[index]!.title;
  return [
    { title: `${title}, paper`, value: (row) => row.scores[index]!.paper, show: (row) => formatFixed(row.scores[index]!.paper, 2), best: "low" },
    {
      title: "here", hint: "median over seeds, and the worst", value: (row) => row.scores[index]!.median,
      show: (row) => `${formatFixed(row.scores[index]!.median, 2)} (${formatFixed(row.scores[index]!.worst, 2)})`, best: "low",
    },
  ];
}

function experimentTable(experiment: PaperExperiment): HTMLElement {
  return sortableTable(experiment.systems, [
    { title: "system", value: (row) => row.estimator },
    { title: "in the paper", value: (row) => row.method ?? "–" },
    { title: "success", value: (row) => row.successes, show: (row) => `${row.successes}/${row.runs}` },
    ...experiment.columns.flatMap((_, index) => columnsOf(experiment, index)),
  ], {
    caption: `Seeds ${experiment.seeds.join(", ")}: the paper's figure beside the median here (the worst)`,
    rowName: (row) => row.estimator,
  });
}

function orderTable(experiment: PaperExperiment): HTMLElement {
  return sortableTable(experiment.columns, [
    { title: "score", value: (row) => row.title },
    { title: "systems", value: (row) => row.systems, show: (row) => String(row.systems) },
    {
      title: "Kendall's tau", hint: "1: the paper's order, 0: unrelated, −1: the opposite", value: (row) => row.tau,
      show: (row) => formatFixed(row.tau, 2),
      interval: (row) => row.tau_low === null || row.tau_high === null ? null : [row.tau_low, row.tau_high],
    },
  ], { caption: "Agreement with the paper's order, 95 % interval over seeds", rowName: (row) => row.key });
}

/** The section; none in other suites. */
export function paperSection(data: SuitePayload): HTMLElement | null {
  const paper = data.paper;
  if (!paper) return null;
  return section("paper", "The paper's tables",
    ...paper.experiments.flatMap((each) => [h("h3", {}, each.title), experimentTable(each), orderTable(each)]),
    pictureGrid(paper.pictures));
}
