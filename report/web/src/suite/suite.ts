// SPDX-License-Identifier: BSD-3-Clause
import type { PagePayload } from "../contract";
import { h } from "../dom";

export function renderSuite(root: HTMLElement, data: PagePayload): void {
  root.append(h("h1", {}, data.title));
}
