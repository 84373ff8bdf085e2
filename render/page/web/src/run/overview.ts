// SPDX-License-Identifier: BSD-3-Clause
/** The first screen: who is shown, position error over distance, plan. */
import { drawToFit, lineSample } from "../charts/svg";
import type { RunPayload, TimeInterval } from "../contract";
import { h } from "../dom";
import { formatFixed, isNumber } from "../format";
import { color, onTheme, seriesColor } from "../theme";
import { errorTrack, mostOf, ownTrack, thin, truePath, type Alignment, type ErrorTrack, type Path } from "./errors";
import { layered } from "./layers";
import { Panel, type PanelSpec } from "./panel";
import type { Backdrop } from "./panel_paint";
import { planView } from "./plan";
import { dashed, kLevels } from "./panels";
import { valueAt } from "./series";
import { nearestIndex, type Store } from "./store";

/** The error axis begins where all but 5 % of the errors are above it, within these limits; no error at all is this [m]. */
const kLeast = [0.001, 0.01] as const;
const kSmallest = 1e-4;
const kSamples = 2000;
const kHeight = 270;

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

/** "46 of 79 m". */
function lengthText(parts: [number, number][], path: Path): string {
  const length = parts.reduce((sum, [from, to]) => sum + to - from, 0);
  return `${length.toFixed(0)} of ${(path.travelled.at(-1) ?? 0).toFixed(0)} m`;
}

interface Shown {
  name: string;
  index: number;
  track: ErrorTrack;
}

function shownTracks(data: RunPayload, path: Path | null, store: Store): Shown[] {
  return data.estimators.flatMap((item, i): Shown[] => {
    if (store.state.hidden.has(i)) return [];
    const track = path ? errorTrack(path, item, store.state.alignment) : ownTrack(item);
    return track ? [{ name: item.name, index: item.colour_index, track }] : [];
  });
}

/** Errors of all, thinned. */
function errorSpec(shown: Shown[]): PanelSpec {
  const most = Math.max(0.1, ...shown.map(({ track }) => mostOf(track)));
  const errors = shown.flatMap(({ track }) => track.error.filter(Number.isFinite)).sort((a, b) => a - b);
  const least = Math.min(kLeast[1], Math.max(kLeast[0], errors[Math.floor(0.05 * errors.length)] ?? 0));
  const curves = layered(shown).map(({ item, width }) => {
    const { name, index, track } = item;
    const kept = thin(track, kSamples);
    return {
      label: name, color: seriesColor(index), dash: dashed(index), width, place: shown.indexOf(item),
      track: {
        times: Float32Array.from(kept, (i) => track.distance[i]!),
        values: Float32Array.from(kept, (i) => Math.max(track.error[i]!, kSmallest)),
      },
    };
  });
  return {
    id: "error_distance", title: "Position error", unit: "m", curves, log: true, range: [least, 1.4 * most],
    height: kHeight, xUnit: "m", hint: "Over the distance travelled",
  };
}

/** The error over distance; its cursor is that of the run, or the pointer, and a press moves the run there. */
class ErrorChart {
  readonly element = h("div", { class: "stage", role: "img", "aria-label": "Position error of each estimator over the distance travelled" });
  private shown: Shown[] = [];
  private panel: Panel | null = null;

  constructor(private readonly data: RunPayload, private readonly path: Path, private readonly store: Store) {
    this.element.addEventListener("pointermove", (event) => {
      const distance = this.panel?.timeAt(event.clientX) ?? NaN;
      this.show(distance, this.timeOf(distance));
    });
    this.element.addEventListener("pointerleave", () => this.showCursor());
    this.element.addEventListener("click", (event) => {
      if (this.panel) store.moveTo(this.timeOf(this.panel.timeAt(event.clientX)));
    });
    store.on(["cursor"], () => this.showCursor());
    onTheme(() => this.build());
    drawToFit(this.element, () => this.build());
  }

  draw(shown: Shown[]): void {
    this.shown = shown;
    this.build();
  }

  private distanceAt(seconds: number): number {
    return this.path.travelled[nearestIndex(this.path.t, seconds)] ?? NaN;
  }

  private timeOf(distance: number): number {
    return this.path.t[nearestIndex(this.path.travelled, distance)] ?? 0;
  }

  private show(distance: number, seconds: number): void {
    const valueOf = ({ label }: { label: string }) => {
      const { t, error } = this.shown.find(({ name }) => name === label)!.track;
      return valueAt({ times: Float32Array.from(t), values: Float32Array.from(error) }, seconds);
    };
    this.panel?.showCursor(distance, `at ${formatFixed(seconds, 1)} s, ${formatFixed(distance, 1)} m`, valueOf);
  }

  private showCursor(): void {
    const { cursor } = this.store.state;
    this.show(this.distanceAt(cursor), cursor);
  }

  private build(): void {
    this.panel?.destroy();
    this.panel = null;
    const width = this.element.clientWidth;
    if (width === 0) return;
    const behind: Backdrop = {
      shaded: shaded(this.data, this.path, this.store),
      marks: (this.data.waypoint_times ?? []).flatMap(({ name, t }) =>
        isNumber(t) ? [{ t: this.distanceAt(t), text: name, color: color("--ink-soft") }] : []),
    };
    const window = { from: 0, to: Math.max(this.path.travelled.at(-1) ?? 1, 1) };
    this.panel = new Panel(errorSpec(this.shown), behind, width, window, true, true);
    this.element.append(this.panel.element);
    requestAnimationFrame(() => this.showCursor());
  }
}

const kAlignments: Record<Alignment, string> = { heading: "start and fitted heading", start: "start alone" };

function alignmentChoice(store: Store): HTMLElement {
  const select = h("select", {
    "data-control": "alignment",
    onchange: () => store.set({ alignment: select.value as Alignment }),
  },
  ...Object.entries(kAlignments).map(([value, text]) =>
    h("option", { value, selected: store.state.alignment === value }, text)));
  return h("label", {}, "aligned by ", select);
}

/** The plan; without a truth, of the estimates in their own frame. */
function planCard(plan: HTMLElement): HTMLElement {
  return h("section", { class: "card overview-plan", "aria-label": "Plan" }, h("h2", {}, "Plan"), plan);
}

/** Both charts; no errors without a truth, null without any path. */
export function overviewCharts(
  data: RunPayload, store: Store,
): { errors: HTMLElement | null; plan: HTMLElement } | null {
  const path = truePath(data);
  const plan = h("div", {});
  const aligned = path ? h("p", { class: "soft", "data-aligned": true }) : null;
  const drawPlan = () => {
    if (aligned) aligned.textContent = `Estimates aligned by ${kAlignments[store.state.alignment]}.`;
    plan.replaceChildren(planView(data, shownTracks(data, path, store)) ?? "", aligned ?? "");
  };
  if (!path) {
    if (shownTracks(data, null, store).length === 0) return null;
    drawPlan();
    store.on(["hidden"], drawPlan);
    return { errors: null, plan: planCard(plan) };
  }
  const chart = new ErrorChart(data, path, store);
  const choices = h("div", { class: "choices" });
  const draw = () => {
    const level = kLevels.find(({ level: name }) => name === store.state.level);
    const degenerate = data.localizability
      ? h("span", { class: "legend-item" }, h("i", { class: "swatch shade" }),
        `degenerate, below ${level?.returns ?? 100} equivalent returns: ${lengthText(shaded(data, path, store), path)}`) : null;
    choices.replaceChildren(alignmentChoice(store), degenerate ?? "");
    chart.draw(shownTracks(data, path, store));
    drawPlan();
  };
  draw();
  store.on(["hidden", "alignment", "level"], draw);
  return {
    errors: h("section", { class: "card overview-errors", "aria-label": "Position error over distance" },
      h("h2", {}, "Position error over distance"), choices, chart.element),
    plan: planCard(plan),
  };
}
