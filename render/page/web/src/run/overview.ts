// SPDX-License-Identifier: BSD-3-Clause
/** The first screen: who is shown, position error over distance, plan. */
import { chart } from "../charts/chart";
import { lineSample } from "../charts/svg";
import type { RunPayload, TimeInterval } from "../contract";
import { h } from "../dom";
import { formatFixed, isNumber } from "../format";
import { errorTrack, thin, truePath, type Alignment, type ErrorTrack, type Path } from "./errors";
import { planView } from "./plan";
import { kLevels } from "./panels";
import { nearestIndex, type Store } from "./store";

/** Errors are drawn from here on [m]. */
const kLeast = 0.01;
const kSamples = 500;

/** A box per estimator: is it shown? */
export function visibility(data: RunPayload, store: Store): HTMLElement | null {
  if (data.estimators.length === 0) return null;
  const items = data.estimators.map((item, index) => {
    const box = h("input", {
      type: "checkbox",
      checked: !store.state.hidden.has(index),
      "data-shown": item.name,
      onchange: () => store.show(index, box.checked),
    });
    return h("label", { class: "shown" }, box, lineSample(item.colour_index), h("bdi", {}, item.name));
  });
  return h("fieldset", { class: "visibility" }, h("legend", {}, "Shown"), ...items);
}

/** Degenerate parts of the route as intervals of the distance travelled [m]. */
function shaded(data: RunPayload, path: Path, store: Store): [number, number][] {
  const list = data.localizability?.degenerate?.[store.state.level];
  if (!Array.isArray(list)) return [];
  const at = (seconds: number) => path.travelled[nearestIndex(path.t, seconds)] ?? 0;
  return list
    .filter((pair): pair is TimeInterval => isNumber(pair?.[0]) && isNumber(pair?.[1]))
    .map(([from, to]): [number, number] => [at(from), at(to)])
    .filter(([from, to]) => to > from);
}

interface Shown {
  name: string;
  index: number;
  track: ErrorTrack;
}

function shownTracks(data: RunPayload, path: Path, store: Store): Shown[] {
  return data.estimators.flatMap((item, i): Shown[] => {
    if (store.state.hidden.has(i)) return [];
    const track = errorTrack(path, item, store.state.alignment);
    return track ? [{ name: item.name, index: item.colour_index, track }] : [];
  });
}

function errorChart(data: RunPayload, path: Path, store: Store, shown: Shown[]): HTMLElement {
  const end = Math.max(path.travelled[path.travelled.length - 1] ?? 1, 1);
  const most = Math.max(0.1, ...shown.map(({ track }) => track.error.reduce((a, b) => Math.max(a, b), 0)));
  return chart(
    shown.map(({ name, index, track }) => ({
      name, index, bare: true,
      marks: thin(track, kSamples).map((i) => ({
        x: track.distance[i]!, y: Math.max(track.error[i]!, kLeast), note: `${formatFixed(track.t[i]!, 1)} s`,
      })),
    })),
    {
      label: "Position error of each estimator over the distance travelled",
      xLabel: "distance travelled [m]", yLabel: "position error [m]", yLog: true, quiet: true, height: 300,
      xEnds: [0, end], yEnds: [kLeast, 1.4 * most],
      areas: shaded(data, path, store),
      verticals: (data.waypoint_times ?? []).flatMap(({ name, t }) =>
        isNumber(t) ? [{ x: path.travelled[nearestIndex(path.t, t)] ?? NaN, label: name }] : []),
    });
}

function alignmentChoice(store: Store): HTMLElement {
  const select = h("select", {
    "data-control": "alignment",
    onchange: () => store.set({ alignment: select.value as Alignment }),
  },
  h("option", { value: "heading", selected: store.state.alignment === "heading" }, "start and fitted heading"),
  h("option", { value: "start", selected: store.state.alignment === "start" }, "start alone"));
  return h("label", {}, "aligned by ", select);
}

/** Both charts; null without a truth. */
export function overviewCharts(data: RunPayload, store: Store): { errors: HTMLElement; plan: HTMLElement } | null {
  const path = truePath(data);
  if (!path) return null;
  const errors = h("div", {});
  const plan = h("div", {});
  const draw = () => {
    const shown = shownTracks(data, path, store);
    const level = kLevels.find(({ level: name }) => name === store.state.level);
    const degenerate = data.localizability
      ? h("span", { class: "legend-item" }, h("i", { class: "swatch shade" }), `below ${level?.returns ?? 100} equivalent returns`) : null;
    errors.replaceChildren(
      h("div", { class: "choices" }, alignmentChoice(store), degenerate),
      errorChart(data, path, store, shown));
    plan.replaceChildren(planView(data, shown) ?? "");
  };
  draw();
  store.on(["hidden", "alignment", "level"], draw);
  return {
    errors: h("section", { class: "card overview-errors", "aria-label": "Position error over distance" },
      h("h2", {}, "Position error over distance"), errors),
    plan: h("section", { class: "card overview-plan", "aria-label": "Plan" }, h("h2", {}, "Plan"), plan),
  };
}
