// SPDX-License-Identifier: BSD-3-Clause
/** The view's state in the address, so that a link shows what its sender saw. */
import type { RunPayload } from "../contract";
import type { State, Store } from "./store";

const kWords = {
  level: ["n10", "n100", "n1000"],
  coloring: ["height", "error"],
  scanColoring: ["intensity", "range", "residual", "none"],
  errorScale: ["chosen", "all"],
  alignment: ["heading", "start"],
  tab: ["errors", "internals"],
  preset: ["orbit", "top", "side"],
} as const;

type Word = keyof typeof kWords;

/** What an address says of the state; what it does not understand is left out. */
export function stateIn(hash: string, data: RunPayload): Partial<State> {
  const given = new URLSearchParams(hash.replace(/^#/, ""));
  const index = (name: string) => data.estimators.findIndex((item) => item.name === name);
  const state: Partial<State> = {};
  const chosen = index(given.get("estimator") ?? "");
  if (chosen >= 0) state.chosen = chosen;
  const hidden = given.getAll("hide").map(index).filter((each) => each >= 0);
  if (hidden.length > 0) state.hidden = new Set(hidden);
  for (const key of ["cursor", "from", "to"] as const) {
    const value = Number(given.get(key) ?? NaN);
    if (Number.isFinite(value)) state[key] = value;
  }
  if (state.from === undefined || state.to === undefined || !(state.to > state.from)) {
    delete state.from;
    delete state.to;
  }
  if (given.has("ceiling")) state.ceiling = given.get("ceiling") === "1";
  if (given.has("follow")) state.follow = given.get("follow") === "1";
  for (const key of Object.keys(kWords) as Word[]) {
    const value = given.get(key);
    if (value !== null && (kWords[key] as readonly string[]).includes(value))
      (state as Record<string, unknown>)[key] = value;
  }
  return state;
}

/** What differs from `first`, as an address ends; empty where nothing does. */
export function hashOf(state: Readonly<State>, first: Readonly<State>, data: RunPayload): string {
  const said = new URLSearchParams();
  if (state.chosen !== first.chosen) said.set("estimator", data.estimators[state.chosen]?.name ?? "");
  for (const index of [...state.hidden].sort((a, b) => a - b)) said.append("hide", data.estimators[index]?.name ?? "");
  if (state.cursor !== first.cursor) said.set("cursor", state.cursor.toFixed(2));
  if (state.from !== first.from || state.to !== first.to) {
    said.set("from", state.from.toFixed(2));
    said.set("to", state.to.toFixed(2));
  }
  for (const key of ["ceiling", "follow"] as const) if (state[key] !== first[key]) said.set(key, state[key] ? "1" : "0");
  for (const key of Object.keys(kWords) as Word[]) if (state[key] !== first[key]) said.set(key, state[key]);
  return said.toString();
}

/** Keeps the address at the state, not more often than a reader can act. */
export function keepInAddress(store: Store, first: Readonly<State>, data: RunPayload): void {
  let waiting = false;
  const write = () => {
    waiting = false;
    const hash = hashOf(store.state, first, data);
    try {
      history.replaceState(null, "", hash ? `#${hash}` : location.pathname + location.search);
    } catch {
      // The page may lie where its address must not change.
    }
  };
  store.on(Object.keys(first) as (keyof State)[], () => {
    if (waiting) return;
    waiting = true;
    setTimeout(write, 300);
  });
}
