// SPDX-License-Identifier: BSD-3-Clause
/** Entry: decodes the payload and hands it to the page of its kind. */
import "./style.css";
import type { PagePayload } from "./contract";
import { h } from "./dom";
import { usePalette } from "./palette";
import { decodePayload } from "./payload";
import { renderRun } from "./run/page";
import { renderSuite } from "./suite/suite";
import { startTheme } from "./theme";
import { renderTuning } from "./tuning/tuning";

type Render = (root: HTMLElement, data: never) => void | Promise<void>;
const kPages = new Map<string, Render>([
  ["run", renderRun],
  ["suite", renderSuite],
  ["tuning", renderTuning],
]);

function nextFrame(): Promise<void> {
  return new Promise((resolve) => requestAnimationFrame(() => resolve()));
}

async function start(): Promise<void> {
  const root = document.getElementById("page")!;
  const mark = document.documentElement.dataset;
  startTheme();
  try {
    const source = document.getElementById("aims-data")!;
    const data: PagePayload = await decodePayload(source.textContent ?? "");
    source.remove();
    const render = kPages.get(data.kind);
    if (!render)
      throw new Error(`data: a page of kind ${String(data.kind)}, expected run, suite or tuning`);
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

void start();
