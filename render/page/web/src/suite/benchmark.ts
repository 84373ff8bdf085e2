// SPDX-License-Identifier: BSD-3-Clause
/** What a benchmark leads with: the score of the authors per sequence, here and as published, and what it rests on. */
import { notes } from "../charts/controls";
import { h, section } from "../dom";
import { isNumber } from "../format";
import { sortableTable, type Column } from "../table";
import { scoreOf, type Benchmark, type SuitePayload } from "./model";

type Sequence = Benchmark["sequences"][number];

/** Names in the order in which the sequences have them. */
function namesIn(benchmark: Benchmark, part: "ours" | "published"): string[] {
  return [...new Set(benchmark.sequences.flatMap((each) => Object.keys(each[part] ?? {})))];
}

function scoreColumn(part: "ours" | "published", name: string): Column<Sequence> {
  const value = (row: Sequence) => {
    const found = Object.hasOwn(row[part] ?? {}, name) ? row[part][name] : null;
    return isNumber(found) ? found : null;
  };
  return {
    title: part === "ours" ? name : `${name} (published)`, value,
    show: (row) => (value(row) === null ? "–" : value(row)!.toFixed(3)),
  };
}

/** The table of benchmark.md; a row per sequence. */
function table(benchmark: Benchmark): HTMLElement {
  const columns: Column<Sequence>[] = [
    { title: "sequence", value: (row) => row.name },
    ...namesIn(benchmark, "ours").map((name) => scoreColumn("ours", name)),
    ...namesIn(benchmark, "published").map((name) => scoreColumn("published", name)),
    {
      title: "truth", value: (row) => row.lack || (row.truth_text ?? ""),
      show: (row) => (row.lack ? `not scored: ${row.lack}` : row.truth_text || "pose of the end"),
    },
  ];
  return sortableTable(benchmark.sequences, columns, {
    caption: `${benchmark.score} [${benchmark.unit}], ${benchmark.better === "larger" ? "larger" : "smaller"} is better`,
    rowName: (row) => row.name,
  });
}

/** Where one sequence was scored: the best estimator in one sentence; null where there is nothing to compare. */
function verdict(data: SuitePayload, benchmark: Benchmark): HTMLElement | null {
  const scored = benchmark.sequences.filter((each) => Object.values(each.ours).some(isNumber));
  const only = scored[0];
  if (scored.length !== 1 || !only) return null;
  const large = benchmark.better === "larger";
  const found = Object.entries(only.ours).filter((each): each is [string, number] => isNumber(each[1]))
    .sort((a, b) => (large ? b[1] - a[1] : a[1] - b[1]));
  const { title } = scoreOf(data, benchmark.score);
  const text = found.map(([name, value]) => `${name} ${value.toFixed(3)}`).join(", ");
  return h("div", { class: "verdict", "data-verdict": "plain", role: "status" },
    h("p", {}, h("strong", {}, `${title} [${benchmark.unit}] on ${only.name}: ${text}.`)));
}

/** The sentence above everything; null without a benchmark or with several sequences. */
export function benchmarkVerdict(data: SuitePayload): HTMLElement | null {
  return data.benchmark ? verdict(data, data.benchmark) : null;
}

/** Table and notes; null without a benchmark. */
export function benchmarkSection(data: SuitePayload): HTMLElement | null {
  const { benchmark } = data;
  if (!benchmark) return null;
  return section("benchmark", "Score of the data set",
    benchmark.score_text ? h("p", {}, `${benchmark.score}: ${benchmark.score_text}.`) : null,
    table(benchmark), h("h3", {}, "What it rests on"), notes(benchmark.notes));
}
