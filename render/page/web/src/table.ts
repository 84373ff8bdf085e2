// SPDX-License-Identifier: BSD-3-Clause
/** A table whose columns sort, with the best of a column in bold. */
import { h, type Child } from "./dom";
import { formatNumber, isNumber } from "./format";

export type CellValue = number | string | boolean | null | undefined;

export interface Column<Row> {
  title: string;
  /** Shown behind the title, in a fainter ink. */
  unit?: string;
  /** Longer explanation, as a tooltip. */
  hint?: string;
  /** What is sorted by; a number also lands in the cell's `data-value`, in full. */
  value: (row: Row) => CellValue;
  /** What is shown; a number with three digits if left out. */
  show?: (row: Row) => Child;
  /** 95 % interval, shown small behind the value. */
  interval?: (row: Row) => [number, number] | null | undefined;
  /** Which end of the column is best; `zero` is the least absolute value. */
  best?: "low" | "high" | "zero";
  /** May this row be best? All rows if left out. */
  eligible?: (row: Row) => boolean;
}

export interface TableOptions<Row> {
  caption: string;
  /** What bold means; stands behind the caption where a cell is bold. */
  bestLegend?: string;
  /** `data-row` of a row, for those who look for it. */
  rowName?: (row: Row) => string;
  /** Column first sorted by. */
  sortBy?: number;
  /** CSS class of a row. */
  rowClass?: (row: Row) => string;
}

type Order = "ascending" | "descending";

function compare(a: CellValue, b: CellValue): number {
  if (typeof a === "number" && typeof b === "number") return a - b;
  return String(a).localeCompare(String(b), "en", { numeric: true });
}

function isMissing(value: CellValue): boolean {
  return (
    value === null || value === undefined || (typeof value === "number" && Number.isNaN(value))
  );
}

/** Rows in order; those without a value come last either way, equal ones keep their order. */
function sorted<Row>(rows: Row[], column: Column<Row>, order: Order): Row[] {
  const keyed = rows.map((row) => ({ row, key: column.value(row) }));
  keyed.sort((a, b) => {
    const missing = Number(isMissing(a.key)) - Number(isMissing(b.key));
    if (missing !== 0 || isMissing(a.key)) return missing;
    return order === "ascending" ? compare(a.key, b.key) : compare(b.key, a.key);
  });
  return keyed.map(({ row }) => row);
}

function shown<Row>(row: Row, column: Column<Row>): Child {
  if (column.show) return column.show(row);
  const value = column.value(row);
  if (typeof value === "string") return value;
  if (typeof value === "boolean") return value ? "yes" : "no";
  return formatNumber(value);
}

/** Text of the best cell of a column: all that show the same are best. */
function bestText<Row>(rows: Row[], column: Column<Row>): string | null {
  if (!column.best || rows.length < 2) return null;
  const rank = (value: number) =>
    column.best === "high" ? -value : column.best === "zero" ? Math.abs(value) : value;
  let best: { rank: number; text: string } | null = null;
  for (const row of rows) {
    const value = column.value(row);
    if (!isNumber(value) || (column.eligible && !column.eligible(row))) continue;
    if (!best || rank(value) < best.rank)
      best = { rank: rank(value), text: String(shown(row, column)) };
  }
  return best ? best.text : null;
}

function cell<Row>(
  row: Row,
  column: Column<Row>,
  first: boolean,
  best: string | null,
): HTMLElement {
  const value = column.value(row);
  const content = shown(row, column);
  const isBest =
    best !== null &&
    isNumber(value) &&
    String(content) === best &&
    (!column.eligible || column.eligible(row));
  const interval = column.interval?.(row);
  return h(
    first ? "th" : "td",
    {
      class: [typeof value === "string" ? "text" : "number", isBest ? "best" : ""].join(" ").trim(),
      scope: first ? "row" : null,
      "data-value": isNumber(value) ? value : null,
      "data-label": first ? null : `${column.title}${column.unit ? ` ${column.unit}` : ""}`,
    },
    content,
    interval &&
      h(
        "span",
        { class: "interval" },
        `${formatNumber(interval[0])} to ${formatNumber(interval[1])}`,
      ),
  );
}

/** The table below its caption, in a frame that scrolls sideways where the window is narrow. */
export function sortableTable<Row>(
  rows: Row[],
  columns: Column<Row>[],
  options: TableOptions<Row>,
): HTMLElement {
  const body = h("tbody");
  const heads: HTMLElement[] = [];
  const best = columns.map((column) => bestText(rows, column));
  const fill = (order: Row[]) => {
    body.replaceChildren(
      ...order.map((row) =>
        h(
          "tr",
          {
            "data-row": options.rowName?.(row),
            class: options.rowClass?.(row) || null,
          },
          ...columns.map((column, i) => cell(row, column, i === 0, best[i] ?? null)),
        ),
      ),
    );
  };
  const sortBy = (index: number, order: Order) => {
    heads.forEach((head, i) => head.setAttribute("aria-sort", i === index ? order : "none"));
    fill(sorted(rows, columns[index]!, order));
  };
  columns.forEach((column, index) => {
    const press = () => {
      const ascending = heads[index]!.getAttribute("aria-sort") === "ascending";
      sortBy(index, ascending ? "descending" : "ascending");
    };
    const words = rows.length > 0 && typeof column.value(rows[0]!) === "string";
    heads.push(
      h(
        "th",
        { scope: "col", "aria-sort": "none", title: column.hint, class: words ? "text" : null },
        h(
          "button",
          { type: "button", class: "sort", onclick: press },
          column.title,
          column.unit ? h("span", { class: "unit" }, ` ${column.unit}`) : null,
        ),
      ),
    );
  });
  const caption = best.some((each) => each !== null) && options.bestLegend ? `${options.caption} ${options.bestLegend}` : options.caption;
  fill(rows);
  if (options.sortBy !== undefined) sortBy(options.sortBy, "ascending");
  const table = h(
    "table",
    { class: columns.length > 3 ? "stacks" : null, "aria-label": caption },
    h("thead", {}, h("tr", {}, ...heads)),
    body,
  );
  return h(
    "div",
    { class: "table-block" },
    h("p", { class: "caption" }, caption),
    h(
      "div",
      { class: "table-frame", tabindex: 0, role: "region", "aria-label": caption },
      table,
    ),
  );
}
