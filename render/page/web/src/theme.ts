// SPDX-License-Identifier: BSD-3-Clause
/** Light and dark. Colours live in style.css; what draws on a canvas reads them here. */
import { h } from "./dom";
import { styleIndex } from "./palette";

export type Theme = "light" | "dark";
const listeners: (() => void)[] = [];
const system = matchMedia("(prefers-color-scheme: dark)");
const kStored = "aims-theme";

/** The reader's choice; the store may be shut for pages from a disk. */
function stored(): Theme | null {
  try {
    const value = localStorage.getItem(kStored);
    return value === "light" || value === "dark" ? value : null;
  } catch {
    return null;
  }
}

export function theme(): Theme {
  return document.documentElement.dataset["theme"] === "dark" ? "dark" : "light";
}

function apply(next: Theme): void {
  document.documentElement.dataset["theme"] = next;
  for (const listener of listeners) listener();
}

/** Calls back after each change of theme. */
export function onTheme(listener: () => void): void {
  listeners.push(listener);
}

/** Value of a colour variable such as `--ink`. */
export function color(name: string): string {
  return getComputedStyle(document.documentElement).getPropertyValue(name).trim();
}

/** Colour of style `index` of the palette; cyclic. */
export function seriesColor(index: number): string {
  return color(`--series-${styleIndex(index)}`);
}

export function startTheme(): void {
  apply(stored() ?? (system.matches ? "dark" : "light"));
  system.addEventListener("change", () => {
    if (!stored()) apply(system.matches ? "dark" : "light");
  });
}

/** Button that changes the theme. */
export function themeButton(): HTMLElement {
  const label = () => (theme() === "dark" ? "Light" : "Dark");
  const button = h(
    "button",
    { type: "button", class: "quiet", "aria-label": "Change between light and dark" },
    label(),
  );
  button.addEventListener("click", () => {
    const next = theme() === "dark" ? "light" : "dark";
    try {
      localStorage.setItem(kStored, next);
    } catch {
      // The choice then holds for this page only.
    }
    apply(next);
  });
  onTheme(() => {
    button.textContent = label();
  });
  return button;
}
