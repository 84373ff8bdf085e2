// SPDX-License-Identifier: BSD-3-Clause
/** What the pages' toolbars are made of. */
import { h } from "../dom";

export interface Choice {
  value: string;
  label: string;
  group?: string;
}

/** A labelled choice; calls back with the chosen value. */
export function choice(
  label: string, choices: Choice[], chosen: string, changed: (value: string) => void
): HTMLElement {
  const select = h("select", {});
  const groups = new Map<string, HTMLElement>();
  for (const each of choices) {
    const option = h("option", { value: each.value, selected: each.value === chosen }, each.label);
    if (!each.group) {
      select.append(option);
      continue;
    }
    if (!groups.has(each.group)) {
      const group = h("optgroup", { label: each.group });
      groups.set(each.group, group);
      select.append(group);
    }
    groups.get(each.group)!.append(option);
  }
  select.addEventListener("change", () => changed(select.value));
  return h("label", {}, label, select);
}

/** A labelled box that is ticked or not. */
export function tick(label: string, on: boolean, changed: (on: boolean) => void): HTMLElement {
  const box = h("input", { type: "checkbox", checked: on });
  box.addEventListener("change", () => changed(box.checked));
  return h("label", {}, box, label);
}

/** Facts of a page in one line; what has no value is left out. */
export function facts(items: [string, string | number | null | undefined][]): HTMLElement {
  const known = items.filter(([, value]) => value !== null && value !== undefined && value !== "");
  return h("ul", { class: "facts" }, ...known.map(([name, value]) => h("li", {}, `${name} `, h("b", {}, value))));
}

/** Sentences under each other; nothing for none. */
export function notes(texts: unknown): HTMLElement | null {
  const known = Array.isArray(texts) ? texts.filter((each) => typeof each === "string") : [];
  return known.length > 0 ? h("ul", { class: "notes" }, ...known.map((each) => h("li", {}, each))) : null;
}
