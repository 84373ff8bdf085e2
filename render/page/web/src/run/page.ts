// SPDX-License-Identifier: BSD-3-Clause
/** The page of one run. */
import "./run.css";
import type { RunPayload } from "../contract";
import { lineSample } from "../charts/svg";
import { h, section } from "../dom";
import { formatFixed, isNumber } from "../format";
import { pictureGrid } from "../pictures";
import { onTheme, themeButton } from "../theme";
import { configSection } from "./config";
import { missingText } from "./errors";
import { overviewCharts, visibility } from "./overview";
import { detailSection, leadSection } from "./results";
import { cursorTimes, timeSpan } from "./series";
import { keepInAddress, stateIn } from "./state_url";
import { nearestIndex, Store, type State } from "./store";
import { timeline } from "./timeline";
import { failureBox, hintBox, readingBox, verdictBox, warningBox } from "./verdict";
import { viewCard } from "./view";

function badge(text: string, kind: "good" | "bad" | "plain"): HTMLElement {
  return h("span", { class: `badge ${kind}` }, text);
}

function header(data: RunPayload): HTMLElement {
  const scenario = data.scenario;
  const robot = scenario.robot;
  const badges = [
    isNumber(scenario.seed) ? badge(`seed ${scenario.seed}`, "plain") : null,
    isNumber(scenario.simulated_s)
      ? badge(`${formatFixed(scenario.simulated_s, 1)} s`, "plain")
      : null,
    scenario.complete === false ? badge("interrupted", "bad") : null,
    robot?.fell ? badge("the robot fell", "bad") : null,
    robot?.touched_wall ? badge("touched a wall", "bad") : null,
    data.version ? badge(`aims ${data.version}`, "plain") : null,
  ];
  return h(
    "header",
    { class: "page-head" },
    h("h1", {}, data.title || scenario.name),
    h("span", { class: "badges" }, ...badges),
    themeButton(),
    scenario.description ? h("p", { class: "soft description" }, scenario.description) : null,
    ...(data.notes ?? []).map((note) => h("p", { class: "note description" }, String(note))),
  );
}

/** Radio buttons, so that arrow keys switch between estimators as the platform does. */
function chooser(data: RunPayload, store: Store): HTMLElement | null {
  if (data.estimators.length === 0) return null;
  const items = data.estimators.map((item, index) => {
    return h(
      "label",
      { class: "chip" },
      h("input", {
        type: "radio",
        name: "estimator",
        value: index,
        checked: index === store.state.chosen,
        "data-estimator": item.name,
        onchange: () => store.set({ chosen: index }),
      }),
      lineSample(item.colour_index),
      h("bdi", {}, item.name),
      isNumber(item.diverged_at)
        ? h("span", { class: "diverged" }, ` ${missingText(data, item.name) ?? `diverged at ${formatFixed(item.diverged_at, 0)} s`}`)
        : null,
    );
  });
  return h("fieldset", { class: "chooser" }, h("legend", {}, "Details of"), ...items);
}

const kKeys: Record<string, (store: Store, large: boolean) => void> = {
  ArrowLeft: (store, large) => store.step(large ? -10 : -1),
  ArrowRight: (store, large) => store.step(large ? 10 : 1),
  PageUp: (store) => store.step(100),
  PageDown: (store) => store.step(-100),
  Home: (store) => store.moveTo(store.span[0]),
  End: (store) => store.moveTo(store.span[1]),
  "+": (store) => store.zoomBy(0.5, store.state.cursor),
  "=": (store) => store.zoomBy(0.5, store.state.cursor),
  "-": (store) => store.zoomBy(2, store.state.cursor),
  "0": (store) => store.zoomAll(),
};
/** Keys that scroll the page unless the timeline has the focus. */
const kScrolling = new Set(["PageUp", "PageDown", "Home", "End"]);

function keyboard(store: Store): void {
  document.addEventListener("keydown", (event) => {
    const target = event.target as Element;
    if (
      event.ctrlKey ||
      event.altKey ||
      event.metaKey ||
      target.closest("input, select, textarea, .table-frame, pre")
    )
      return;
    const act = kKeys[event.key];
    if (!act || (kScrolling.has(event.key) && !target.closest(".strips"))) return;
    event.preventDefault();
    act(store, event.shiftKey);
  });
}

/** The chosen one at first: the first that did not diverge, else the first. */
function firstChoice(data: RunPayload): number {
  const intact = data.estimators.findIndex((item) => !isNumber(item.diverged_at));
  return intact >= 0 ? intact : data.estimators.length - 1 < 0 ? -1 : 0;
}

/** Of the cursor's instants the one next to the middle of the truth, where errors are known; else of themselves. */
function middleOf(data: RunPayload, times: number[]): number | undefined {
  const truth = data.truth?.t;
  const whole = truth && truth.length > 0 ? truth : times;
  return times[nearestIndex(times, (whole[0]! + whole[whole.length - 1]!) / 2)];
}

/** What is drawn again in the colours of each theme. */
function themed(make: () => HTMLElement | null): HTMLElement {
  const frame = h("div", {}, make() ?? "");
  onTheme(() => frame.replaceChildren(make() ?? ""));
  return frame;
}

export function renderRun(root: HTMLElement, data: RunPayload): void {
  data.estimators ??= [];
  const times = cursorTimes(data);
  const span = timeSpan(data);
  const first: State = {
      cursor: middleOf(data, times) ?? span[0],
      from: span[0],
      to: span[1],
      chosen: firstChoice(data),
      level: "n100",
      coloring: "height",
      ceiling: false,
      scanColoring: "intensity",
      errorScale: "chosen",
      hidden: new Set(),
      alignment: "heading",
      tab: "errors",
      preset: "orbit",
      follow: false,
  };
  const store = new Store({ ...first, ...stateIn(location.hash, data) }, times, span);
  const view = viewCard(data, store);
  const strips = timeline(data, store);
  const lead = themed(() => leadSection(data));
  const charts = overviewCharts(data, store);
  const overview = h("div", { class: charts?.errors ? "overview" : "" }, lead, charts?.errors ?? "");
  const rest = themed(() => detailSection(data));
  const grid = pictureGrid(data.pictures);
  const pictures = grid ? section("pictures", "Pictures", grid) : null;
  root.append(
    header(data),
    verdictBox(data),
    failureBox(data) ?? "",
    warningBox(data) ?? "",
    readingBox(data) ?? "",
    hintBox(data) ?? "",
    (charts && visibility(data, store)) ?? "",
    overview,
    charts?.plan ?? "",
    h("div", { class: "explore" }, strips.controls, chooser(data, store) ?? "", strips.element, view.element),
    rest,
    configSection(data) ?? "",
    ...(pictures ? [pictures] : []),
  );
  keyboard(store);
  keepInAddress(store, first, data);
  view.start();
  strips.start();
}
