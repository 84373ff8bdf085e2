// SPDX-License-Identifier: BSD-3-Clause
/** Pairs of estimators: on how many sequences one alone succeeds, and whether that can be chance. */
import { section } from "../dom";
import { sortableTable, type Column } from "../table";
import type { SuccessPair, SuitePayload } from "./model";

function columns(key: string, limit: string): Column<SuccessPair>[] {
  const of = (row: SuccessPair) => row.tests[key];
  const count = (title: string, value: (row: SuccessPair) => number | undefined): Column<SuccessPair> =>
    ({ title, value, show: (row) => String(value(row) ?? "–") });
  return [
    count(`${limit}: first alone`, (row) => of(row)?.only_first), count(`${limit}: second alone`, (row) => of(row)?.only_second),
    {
      title: `${limit}: seeds`, hint: "seeds on which the first succeeds on more sequences, and on which the second does",
      value: (row) => of(row)?.seeds_first, show: (row) => `${of(row)?.seeds_first ?? "–"}, ${of(row)?.seeds_second ?? "–"}`,
    },
    { title: `${limit}: p`, hint: "sign test over seeds", value: (row) => of(row)?.p },
  ];
}

/** None with fewer than two estimators, where no pair differs, and in results of an earlier version, which counted sequences. */
export function pairsSection(data: SuitePayload): HTMLElement | null {
  const pairs = (data.suite.success_pairs ?? []).filter((pair) => pair.tests !== undefined);
  const differing = pairs.filter((pair) => Object.values(pair.tests).some(({ only_first: a, only_second: b }) => a + b > 0));
  if (differing.length === 0) return null;
  return section("pairs", "Pairs of estimators", sortableTable(differing, [
    { title: "pair", value: (row) => `${row.first}, ${row.second}` },
    { title: "sequences", value: (row) => row.sequences, show: (row) => String(row.sequences) },
    { title: "seeds", value: (row) => row.seeds, show: (row) => String(row.seeds) },
    ...columns("success", "5 %"), ...columns("success_1_percent", "1 %"),
  ], { caption: "Sequences on which one of two estimators alone stays within 5 % (1 %) of the distance; seeds on which the first, or the second, " +
      "succeeds on more sequences, since those of one seed have the same sensors; p by the sign test over seeds. Pairs without a difference are left out.",
    rowName: (row) => `${row.first}/${row.second}` }));
}
