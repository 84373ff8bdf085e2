// SPDX-License-Identifier: BSD-3-Clause
/** Curves over the level of a family of scenarios, the severity above all. */
import { chart, type Line, type Mark } from "../charts/chart";
import { choice } from "../charts/controls";
import { h, own, section } from "../dom";
import { isNumber } from "../format";
import { kPartLegend, partText } from "../outcome";
import { sortableTable, type Column } from "../table";
import { estimatorsOf, styleOf, type Family, type FamilyPoint, type SuitePayload } from "./model";

interface Quantity {
  value: "ate_yaw_m" | "m_list_percent" | "success_rate";
  low: "ate_yaw_low_m" | "m_list_low_percent" | "success_low";
  high: "ate_yaw_high_m" | "m_list_high_percent" | "success_high";
  label: string;
}

const kQuantities: Quantity[] = [
  { value: "ate_yaw_m", low: "ate_yaw_low_m", high: "ate_yaw_high_m", label: "ATE yaw [m]" },
  { value: "m_list_percent", low: "m_list_low_percent", high: "m_list_high_percent", label: "M_list [%]" },
  { value: "success_rate", low: "success_low", high: "success_high", label: "success rate" },
];

/** Place of each point: its level, or the equivalent returns of its truth. */
function places(family: Family, overTruth: boolean, count: number): (number | null)[] {
  const returns = family.median_equivalent_returns ?? [];
  return Array.from({ length: count }, (_, i) => {
    const value = returns[i];
    return overTruth ? (isNumber(value) ? Math.max(1, value) : null) : null;
  });
}

function lineOf(family: Family, name: string, index: number, quantity: Quantity, overTruth: boolean): Line {
  const points = own<{ points: FamilyPoint[] }>(family.estimators, name)?.points ?? [];
  const truth = places(family, overTruth, points.length);
  const marks = points.flatMap((point, i): Mark[] => {
    const y = point[quantity.value];
    const x = overTruth ? truth[i]! : point.level;
    if (point.runs === 0 || !isNumber(x)) return [];
    const rate = point.success_rate ?? 0;
    return [{
      x, y: isNumber(y) ? y : NaN,
      low: point[quantity.low] ?? NaN,
      high: point[quantity.high] ?? NaN,
      cross: quantity.value !== "success_rate" && rate < 0.5,
      note: `${Math.round(rate * point.runs)} of ${point.runs} runs succeeded` +
        `${overTruth ? `, level ${point.level}` : ""}`,
    }];
  });
  return { name, index, marks: marks.sort((a, b) => a.x - b.x) };
}

interface TableRow {
  level: number;
  returns: number | null;
  of: Map<string, FamilyPoint>;
}

function table(family: Family, names: string[], quantity: Quantity): HTMLElement {
  const rows: TableRow[] = [];
  for (const name of names) {
    (own<{ points: FamilyPoint[] }>(family.estimators, name)?.points ?? []).forEach((point, i) => {
      rows[i] ??= { level: point.level, returns: family.median_equivalent_returns?.[i] ?? null, of: new Map() };
      rows[i]!.of.set(name, point);
    });
  }
  const isPart = (point: FamilyPoint | undefined) => quantity.value !== "success_rate" && point?.partial === true;
  const marked = rows.some(({ of }) => [...of.values()].some((point) => isPart(point) && isNumber(point[quantity.value])));
  const columns: Column<TableRow>[] = [
    { title: "level", unit: family.level_unit, value: (row) => row.level, show: (row) => String(row.level) },
    { title: "equivalent returns", value: (row) => row.returns, hint: "along the weak axis, median over scans, from the truth" },
    ...names.map((name): Column<TableRow> => ({
      title: name, value: (row) => row.of.get(name)?.[quantity.value],
      show: (row) => partText(row.of.get(name)?.[quantity.value], isPart(row.of.get(name))),
      interval: (row) => {
        const point = row.of.get(name);
        const low = point?.[quantity.low];
        const high = point?.[quantity.high];
        return isNumber(low) && isNumber(high) ? [low, high] : null;
      },
    })),
  ];
  return sortableTable(rows, columns, { caption: `${quantity.label} over ${family.name}${marked ? `. ${kPartLegend}` : ""}`, rowName: (row) => String(row.level) });
}

/** Whether another level may be as mild; empty if not, and in older results. */
function alikeText(family: Family): string {
  const { alike_levels: alike } = family;
  if (alike === null) return " Too few seeds tell whether another level is as mild.";
  if (!alike || alike.length === 0) return "";
  return ` Not told apart from the mildest: ${alike.join(", ")}.`;
}

function breaksText(family: Family, names: string[]): string {
  const levels = names.map((name) => {
    const breaks = own<{ breaks_at: number[] }>(family.estimators, name)?.breaks_at;
    if (!breaks) return null;
    return `${name} ${breaks.length > 0 ? breaks.join(" and ") : "none"}`;
  }).filter((each) => each !== null);
  return `Breakdown level: ${levels.join(", ")}. An estimator breaks at the first level, counted from the mildest ` +
    `(${family.mildest_level}), at which more than half of the runs diverge or the median ATE yaw is over both twice that of the mildest and 0.5 % of the route's length.${alikeText(family)}`;
}

/** The section; none without a family. */
export function familySection(data: SuitePayload): HTMLElement | null {
  const families = data.suite.families ?? [];
  if (families.length === 0) return null;
  const order = estimatorsOf(data);
  let family = families.find((each) => each.name === "severity") ?? families[0]!;
  let quantity = kQuantities[0]!;
  let overTruth = false;
  const place = h("div", {});
  const draw = () => {
    const names = order.filter((name) => Object.hasOwn(family.estimators, name));
    const lines = names.map((name) => lineOf(family, name, styleOf(data, name), quantity, overTruth));
    const known = (family.median_equivalent_returns ?? []).some(isNumber);
    const xLabel = overTruth ? "equivalent returns along the weak axis, at least 1"
      : `${family.name}${family.level_unit ? ` [${family.level_unit}]` : ""}`;
    place.replaceChildren(
      h("div", { class: "toolbar" },
        choice("Family", families.map((each) => ({ value: each.name, label: each.name })), family.name, (name) => {
          family = families.find((each) => each.name === name) ?? family;
          overTruth = false;
          draw();
        }),
        choice("Score", kQuantities.map((each) => ({ value: each.value, label: each.label })), quantity.value, (value) => {
          quantity = kQuantities.find((each) => each.value === value) ?? quantity;
          draw();
        }),
        known ? choice("x axis", [{ value: "level", label: "level" }, { value: "truth", label: "equivalent returns" }],
          overTruth ? "truth" : "level", (value) => {
            overTruth = value === "truth";
            draw();
          }) : null),
      chart(lines, {
        label: `${quantity.label} of each estimator over ${xLabel}; the table below has the numbers`,
        xLabel, yLabel: quantity.label, xLog: overTruth,
        xWhole: !overTruth && lines.every(({ marks }) => marks.every(({ x }) => Number.isInteger(x))), yLog: quantity.value !== "success_rate", height: 340,
        dodge: overTruth ? 0 : 5,
        ...(quantity.value === "success_rate" ? { yEnds: [-0.03, 1.05] as [number, number] } : {}),
        verticals: overTruth ? [] : [{ x: family.mildest_level, label: "mildest" }],
      }),
      h("p", { class: "soft" }, `Median over seeds with its 95 % interval; ✕: more than half of the runs diverged. ${breaksText(family, names)}`),
      h("details", {}, h("summary", {}, "Numbers"), table(family, names, quantity)));
  };
  draw();
  return section("families", families.length === 1 ? `By ${family.name}` : "By level of a scenario family", place);
}
