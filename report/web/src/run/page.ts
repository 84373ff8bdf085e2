// SPDX-License-Identifier: BSD-3-Clause
import type { RunPayload } from "../contract";
import { h } from "../dom";
import { themeButton } from "../theme";

export function renderRun(root: HTMLElement, data: RunPayload): void {
  root.append(h("header", { class: "page-head" }, h("h1", {}, data.title), themeButton()));
}
