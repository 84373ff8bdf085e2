// SPDX-License-Identifier: BSD-3-Clause
/** Decodes the payload and hands it to the page of its kind. */
import "./style.css";
import type { PagePayload } from "./contract";
import { h } from "./dom";
import { usePalette } from "./palette";
import { decodePayload } from "./payload";
import { startTheme } from "./theme";

type Render = (root: HTMLElement, data: never) => void | Promise<void>;

function nextFrame(): Promise<void> {
  return new Promise((resolve) => requestAnimationFrame(() => resolve()));
}

/** Shows the payload by one of `kinds`. */
export async function startPage(kinds: Record<string, Render>): Promise<void> {
  const root = document.getElementById("page")!;
  const mark = document.documentElement.dataset;
  startTheme();
  try {
    const source = document.getElementById("aims-data")!;
    const data: PagePayload = await decodePayload(source.textContent ?? "");
    source.remove();
    const render = Object.hasOwn(kinds, data.kind) ? kinds[data.kind] : undefined;
    if (!render)
      throw new Error(`data: a page of kind ${String(data.kind)}, expected ${Object.keys(kinds).join(" or ")}`);
    usePalette(data.palette);
    if (data.title) document.title = data.title;
    root.classList.add(`${data.kind}-page`);
    await render(root, data as never);
    await nextFrame();
    await nextFrame();
    mark["ready"] = "true";
  } catch (error) {
    console.error(error);
    const text = error instanceof Error ? error.message : String(error);
    root.replaceChildren(
      h("p", { class: "failure", role: "alert" }, `This page cannot be shown. ${text}`),
    );
    mark["ready"] = "failed";
  }
}
