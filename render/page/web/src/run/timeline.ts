// SPDX-License-Identifier: BSD-3-Clause
/** Strips over time under one cursor and one zoom. */
import "uplot/dist/uPlot.min.css";
import type { RunPayload } from "../contract";
import { h } from "../dom";
import { formatFixed, formatTime } from "../format";
import { onTheme } from "../theme";
import { Panel } from "./panel";
import type { Backdrop } from "./panel_paint";
import { backdrop, kLevels, panelSpecs } from "./panels";
import type { ErrorScale, Level, Store, Tab } from "./store";

const kPlaySpeed = 8;
const kHint =
  "Drag: cursor; with Shift, or Ctrl and wheel: zoom. Keys: ← → a scan, with Shift ten; + − 0 zoom.";
const kTouchHint = "Drag: cursor. Two fingers: zoom.";

/** Buttons and the slider above the strips. */
function controls(store: Store): HTMLElement {
  const slider = h("input", {
    type: "range",
    class: "scrubber",
    min: store.times[0] ?? 0,
    max: store.times[store.times.length - 1] ?? 0,
    step: "any",
    "aria-label": "Cursor",
    oninput: () => store.moveTo(Number(slider.value)),
  });
  const clock = h("output", { class: "clock", "data-clock": true });
  const play = h("button", { type: "button", class: "quiet", "aria-pressed": "false" }, "Play");
  player(store, play);
  const show = () => {
    slider.value = String(store.state.cursor);
    const text = store.times.length > 0 ? `${formatFixed(store.state.cursor, 1)} s` : "no samples";
    slider.setAttribute("aria-valuetext", text);
    clock.textContent = text;
    clock.title = formatTime(store.state.cursor);
    clock.dataset["value"] = String(store.state.cursor);
  };
  store.on(["cursor"], show);
  show();
  const middle = () => {
    const { from, to, cursor } = store.state;
    return cursor >= from && cursor <= to ? cursor : (from + to) / 2;
  };
  const button = (text: string, label: string, press: () => void) =>
    h(
      "button",
      { type: "button", class: "quiet", "aria-label": label, title: label, onclick: press },
      text,
    );
  return h(
    "div",
    { class: "transport" },
    play,
    slider,
    clock,
    h(
      "span",
      { class: "buttons" },
      button("−", "Zoom out (−)", () => store.zoomBy(2, middle())),
      button("+", "Zoom in (+)", () => store.zoomBy(0.5, middle())),
      button("All", "Show the full run (0)", () => store.zoomAll()),
    ),
  );
}

/** Lets a button move the cursor on its own, at eight times real time. */
function player(store: Store, button: HTMLElement): void {
  let position: number | null = null;
  let before = 0;
  const stop = () => {
    position = null;
    button.textContent = "Play";
    button.setAttribute("aria-pressed", "false");
  };
  const frame = (now: number) => {
    if (position === null) return;
    position += (kPlaySpeed * (now - before)) / 1000;
    before = now;
    store.moveTo(position);
    if (position >= store.span[1]) stop();
    else requestAnimationFrame(frame);
  };
  button.addEventListener("click", () => {
    if (position !== null) return stop();
    position = store.state.cursor >= store.span[1] - 0.2 ? store.span[0] : store.state.cursor;
    before = performance.now();
    button.textContent = "Pause";
    button.setAttribute("aria-pressed", "true");
    requestAnimationFrame(frame);
  });
}

/** What is measured from outside, errors where there is a truth, or what the chosen estimator computes by itself. */
function tabs(data: RunPayload, store: Store): HTMLElement {
  const names: [Tab, string][] = [
    ["errors", data.truth ? "Errors over time, aligned by the start alone" : "Over time"],
    ["internals", "Internals of the estimator"],
  ];
  const buttons = names.map(([tab, text]) =>
    h(
      "button",
      { type: "button", role: "tab", "data-tab": tab, "aria-selected": String(tab === store.state.tab), onclick: () => store.set({ tab }) },
      text,
    ),
  );
  store.on(["tab"], (state) => {
    for (const button of buttons) button.setAttribute("aria-selected", String(button.dataset["tab"] === state.tab));
  });
  return h("div", { class: "tabs", role: "tablist", "aria-label": "Strips" }, ...buttons);
}

function choices(data: RunPayload, store: Store): HTMLElement {
  const level = h(
    "select",
    { "data-control": "level", onchange: () => store.set({ level: level.value as Level }) },
    ...kLevels.map(({ level: name, returns }) =>
      h(
        "option",
        { value: name, selected: name === store.state.level },
        `below ${returns} equivalent returns`,
      ),
    ),
  );
  const scale = h(
    "select",
    {
      "data-control": "error-scale",
      onchange: () => store.set({ errorScale: scale.value as ErrorScale }),
    },
    h(
      "option",
      { value: "chosen", selected: store.state.errorScale === "chosen" },
      "the chosen estimator",
    ),
    h("option", { value: "all", selected: store.state.errorScale === "all" }, "all"),
  );
  return h(
    "div",
    { class: "choices" },
    data.localizability
      ? h("label", {}, h("i", { class: "swatch shade" }), "degenerate ", level)
      : null,
    data.truth && data.estimators.length > 1 ? h("label", {}, "error axis fits ", scale) : null,
  );
}

/** Dragging moves the cursor, with shift it marks where to zoom; so do two fingers, ctrl+wheel. */
function pointer(
  stack: HTMLElement,
  store: Store,
  hold: (clientX: number) => void,
  timeAt: (clientX: number) => number,
): void {
  const down = new Map<number, number>();
  const selection = h("div", { class: "selection", hidden: true });
  stack.append(selection);
  let anchor: number | null = null;
  let spread: { distance: number; from: number; to: number; center: number } | null = null;
  const mark = (a: number, b: number) => {
    const box = stack.getBoundingClientRect();
    selection.hidden = false;
    selection.style.left = `${Math.min(a, b) - box.left}px`;
    selection.style.width = `${Math.abs(a - b)}px`;
  };
  stack.addEventListener("pointerdown", (event) => {
    if (event.button !== 0 || !(event.target as Element).closest(".u-over")) return;
    if (down.size === 0) hold(event.clientX);
    down.set(event.pointerId, event.clientX);
    stack.setPointerCapture(event.pointerId);
    if (down.size === 2) {
      const [a, b] = [...down.values()] as [number, number];
      spread = {
        distance: Math.abs(a - b),
        from: store.state.from,
        to: store.state.to,
        center: timeAt((a + b) / 2),
      };
    } else if (event.shiftKey) {
      anchor = event.clientX;
    } else {
      store.moveTo(timeAt(event.clientX));
    }
  });
  stack.addEventListener("pointermove", (event) => {
    if (!down.has(event.pointerId)) return;
    down.set(event.pointerId, event.clientX);
    if (spread && down.size === 2) {
      const [a, b] = [...down.values()] as [number, number];
      const factor = spread.distance / Math.max(Math.abs(a - b), 10);
      store.zoomTo(
        spread.center - (spread.center - spread.from) * factor,
        spread.center + (spread.to - spread.center) * factor,
      );
    } else if (anchor !== null) {
      mark(anchor, event.clientX);
    } else if (!spread) {
      store.moveTo(Math.min(Math.max(timeAt(event.clientX), store.state.from), store.state.to));
    }
  });
  const up = (event: PointerEvent) => {
    if (!down.delete(event.pointerId)) return;
    if (anchor !== null && Math.abs(event.clientX - anchor) > 4) {
      const [a, b] = [timeAt(anchor), timeAt(event.clientX)];
      store.zoomTo(Math.min(a, b), Math.max(a, b));
    }
    anchor = null;
    selection.hidden = true;
    if (down.size === 0) spread = null;
  };
  stack.addEventListener("pointerup", up);
  stack.addEventListener("pointercancel", up);
  stack.addEventListener("dblclick", () => store.zoomAll());
  stack.addEventListener(
    "wheel",
    (event) => {
      if (!(event.ctrlKey || event.shiftKey || event.metaKey)) return;
      event.preventDefault();
      hold(event.clientX);
      const amount = event.deltaY || event.deltaX;
      store.zoomBy(
        Math.exp(Math.sign(amount) * Math.min(Math.abs(amount), 100) * 0.003),
        timeAt(event.clientX),
      );
    },
    { passive: false },
  );
}

/** Strips stand in two columns where each is at least this wide [px]. */
const kLeastColumn = 480;
const kColumnGap = 18;

/** The timeline, filled once it is in the document and has a width; `controls` move its cursor. */
export function timeline(
  data: RunPayload,
  store: Store,
): { controls: HTMLElement; element: HTMLElement; start: () => void } {
  const stack = h("div", {
    class: "strips",
    tabindex: 0,
    role: "group",
    "aria-label": "Timeline: arrow keys move the cursor, plus and minus zoom",
  });
  const strips = h("div", { class: "columns" });
  stack.append(strips);
  const element = h(
    "section",
    { class: "card timeline", "aria-label": "Timeline" },
    tabs(data, store),
    choices(data, store),
    stack,
    h("p", { class: "soft hint" }, matchMedia("(pointer: coarse)").matches ? kTouchHint : kHint),
  );
  const window = { from: store.state.from, to: store.state.to };
  const behind: Backdrop = { shaded: [], marks: [] };
  let panels: Panel[] = [];
  /** The strip in which a drag began: its column counts, wherever the pointer goes. */
  let held: Panel | undefined;
  const columns = () => (stack.clientWidth >= 2 * kLeastColumn + kColumnGap ? 2 : 1);
  const width = () =>
    Math.max(Math.floor((stack.clientWidth - (columns() - 1) * kColumnGap) / columns()), 160);
  const cursor = () => {
    for (const panel of panels) panel.showCursor(store.state.cursor);
  };
  const build = () => {
    for (const panel of panels) panel.destroy();
    held = undefined;
    Object.assign(behind, backdrop(data, store.state));
    const specs = panelSpecs(data, store.state);
    const side = columns();
    strips.style.gridTemplateColumns = `repeat(${side}, minmax(0, 1fr))`;
    panels = specs.map(
      (spec, i) =>
        new Panel(spec, behind, width(), window, i < side, i >= specs.length - side),
    );
    strips.replaceChildren(...panels.map((panel) => panel.element));
    if (panels.length === 0)
      strips.append(h("p", { class: "nothing" }, "Nothing over time was recorded."));
    requestAnimationFrame(cursor);
  };
  const redraw = () => {
    Object.assign(window, { from: store.state.from, to: store.state.to });
    for (const panel of panels) panel.showWindow();
  };
  pointer(
    stack,
    store,
    (clientX) => {
      held = panels.find((panel) => panel.spans(clientX)) ?? panels[0];
    },
    (clientX) => (held ?? panels[0])?.timeAt(clientX) ?? store.state.cursor,
  );
  store.on(["chosen", "errorScale", "level", "hidden", "tab"], build);
  store.on(["from", "to"], () => {
    redraw();
    requestAnimationFrame(cursor);
  });
  store.on(["cursor"], cursor);
  onTheme(build);
  let drawn = { width: 0, columns: 0 };
  const fit = () => {
    const before = drawn;
    drawn = { width: width(), columns: columns() };
    if (drawn.columns !== before.columns) return build();
    if (drawn.width === before.width) return;
    for (const panel of panels) panel.resize(drawn.width);
    requestAnimationFrame(cursor);
  };
  return {
    controls: controls(store),
    element,
    start: () => {
      drawn = { width: width(), columns: columns() };
      build();
      new ResizeObserver(fit).observe(stack);
    },
  };
}
