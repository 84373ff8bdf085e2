// SPDX-License-Identifier: BSD-3-Clause
/** Building elements. Text enters as text nodes only, so that no name can become markup. */

type Attribute = string | number | boolean | null | undefined | ((event: never) => void);
export type Child = Node | string | number | null | undefined | false;

/** An element; `on…` attributes are listeners, `true` is empty, null and false are left out. */
export function h<Tag extends keyof HTMLElementTagNameMap>(
  tag: Tag,
  attributes: Record<string, Attribute> = {},
  ...children: Child[]
): HTMLElementTagNameMap[Tag] {
  const element = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (typeof value === "function") {
      element.addEventListener(name.slice(2), value as EventListener);
    } else if (value !== null && value !== undefined && value !== false) {
      element.setAttribute(name, value === true ? "" : String(value));
    }
  }
  for (const child of children) {
    if (child === null || child === undefined || child === false) continue;
    element.append(child instanceof Node ? child : document.createTextNode(String(child)));
  }
  return element;
}

/** Section with a heading; `id` also makes it a target of the page's contents. */
export function section(id: string, title: string, ...children: Child[]): HTMLElement {
  const heading = h("h2", { id: `${id}-title` }, title);
  return h(
    "section",
    { id, class: "card", "aria-labelledby": `${id}-title` },
    heading,
    ...children,
  );
}

/** Own property of an object that came as JSON; a key such as `constructor` finds nothing else. */
export function own<Value>(object: unknown, key: string): Value | undefined {
  if (typeof object !== "object" || object === null || !Object.hasOwn(object, key))
    return undefined;
  return (object as Record<string, Value>)[key];
}

/** Value at a path of keys of an object that came as JSON. */
export function at(object: unknown, ...path: string[]): unknown {
  return path.reduce<unknown>((node, key) => own(node, key), object);
}
