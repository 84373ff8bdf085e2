// SPDX-License-Identifier: BSD-3-Clause
/** The 3D view in its frame: presets, colours, legend; a picture where WebGL is missing. */
import type { CloudMap, RunPayload } from "../contract";
import { h } from "../dom";
import { formatFixed, formatNumber } from "../format";
import { color, onTheme, seriesColor, theme } from "../theme";
import { heightRange } from "./parts3d";
import { pictureImage } from "../pictures";
import { ramp, rampGradient } from "./ramps";
import { ScanPlacer } from "./scan";
import { Surface } from "./surface";
import { indexAt, valueAt, vectorAt, track } from "./series";
import type { Coloring, Preset, ScanColoring, State, Store } from "./store";
import { View3D, webGlKind } from "./view3d";

function fallback(data: RunPayload): HTMLElement {
  const pictures = data.pictures ?? [];
  const best = pictures.filter((item) => item.name.includes("trajector"));
  const shown = best.length > 0 ? best : pictures.slice(0, 2);
  return h(
    "div",
    { class: "view-fallback", "data-view": "fallback" },
    h(
      "p",
      { class: "soft" },
      shown.length > 0 ? "This browser offers no WebGL: pictures in place of the 3D view."
        : "This browser offers no WebGL, and the folder holds no picture.",
    ),
    ...shown.map(pictureImage),
  );
}

/** Group of buttons of which one is pressed. */
function presets(store: Store): HTMLElement {
  const names: [Preset, string][] = [
    ["orbit", "Orbit"],
    ["top", "Top"],
    ["side", "Side"],
  ];
  const buttons = names.map(([preset, text]) =>
    h(
      "button",
      {
        type: "button",
        "data-preset": preset,
        "aria-pressed": String(preset === store.state.preset),
        onclick: () => store.set({ preset }),
      },
      text,
    ),
  );
  store.on(["preset"], ({ preset }) => {
    for (const button of buttons)
      button.setAttribute("aria-pressed", String(button.dataset["preset"] === preset));
  });
  return h("span", { class: "segmented", role: "group", "aria-label": "View from" }, ...buttons);
}

function controls(
  data: RunPayload,
  store: Store,
  view: View3D,
  placer: ScanPlacer,
): HTMLElement {
  const follow = h(
    "button",
    {
      type: "button",
      "aria-pressed": String(store.state.follow),
      onclick: () => store.set({ follow: !store.state.follow }),
    },
    "Follow",
  );
  store.on(["follow"], (state) => follow.setAttribute("aria-pressed", String(state.follow)));
  const stretch = h("input", {
    type: "checkbox",
    checked: true,
    "data-control": "stretch",
    onchange: () => view.setStretches(stretch.checked),
  });
  const stretched = h("span", {});
  const sayStretch = () => {
    stretched.textContent = view.stretch > 1.05 ? ` ${formatNumber(view.stretch, 2)}×` : "";
    stretchLabel.hidden = store.state.preset === "orbit";
  };
  const stretchLabel = h("label", { title: "Flat views draw what lies across the longer side larger, so that it fills the window" },
    stretch, " stretch across", stretched);
  stretch.addEventListener("change", sayStretch);
  store.on(["preset", "follow"], () => requestAnimationFrame(sayStretch));
  requestAnimationFrame(sayStretch);
  const coloring = h(
    "select",
    {
      "data-control": "coloring",
      onchange: () => store.set({ coloring: coloring.value as Coloring }),
    },
    ...(["height", "error"] as const).map((name) =>
      h("option", { value: name, selected: name === store.state.coloring }, name)),
  );
  const heightScale = h(
    "select",
    { "data-control": "height-scale", onchange: () => view.setHeightScale(Number(heightScale.value)) },
    ...[1, 5, 20].map((factor) => h("option", { value: factor }, `${factor}×`)),
  );
  const scanColoring = h(
    "select",
    {
      "data-control": "scan-coloring",
      onchange: () => store.set({ scanColoring: scanColoring.value as ScanColoring }),
    },
    ...placer
      .colorings()
      .map((name) => h("option", { value: name, selected: name === store.state.scanColoring }, name === "none" ? "not shown" : name)),
  );
  const ceiling = h("input", {
    type: "checkbox",
    checked: store.state.ceiling,
    "data-control": "ceiling",
    onchange: () => store.set({ ceiling: ceiling.checked }),
  });
  const roofed =
    (data.scene?.roof_edges?.length ?? 0) > 0 ||
    data.estimators.some(({ map }) => map && (map.below ?? map.n) < map.n);
  const maps = data.estimators.some((item) => item.map && item.map.n > 0);
  return h(
    "div",
    { class: "view-controls" },
    presets(store),
    follow,
    stretchLabel,
    maps ? h("label", {}, "map colour ", coloring) : null,
    data.scans ? h("label", {}, "scan colour ", scanColoring) : null,
    h("label", {}, "height scale ", heightScale),
    roofed ? h("label", {}, ceiling, " ceiling") : null,
  );
}

/** How much of a map is shown, where it is not all. */
function thinned(map: CloudMap): string {
  if (!map.points || map.points <= map.n) return "";
  const count = (n: number) => n.toLocaleString("en");
  return `, ${count(map.n)} of its ${count(map.points)} points, to 1 cm`;
}

/** Ramp of the map's colours with its ends. */
function mapKey(data: RunPayload, state: Readonly<State>): HTMLElement | null {
  const map = data.estimators[state.chosen]?.map;
  if (!map || !(map.n > 0)) return null;
  const byError = state.coloring === "error" && map.error !== null;
  const [low, high] = byError ? [0, 0.5] : heightRange(map, state.ceiling);
  const bar = h("i", { class: "ramp" });
  bar.style.background = rampGradient(ramp(byError ? "error" : "height", theme() === "dark"));
  return h(
    "span",
    { class: "legend-item", "data-key": byError ? "error" : "height" },
    byError ? "map error" : "map height",
    " ",
    formatFixed(low, 2),
    bar,
    `${formatFixed(high, 2)}${byError ? "+" : ""} m`,
    thinned(map),
  );
}

/** What the scan at the cursor shows, and by whose pose it is placed. */
function scanKey(placer: ScanPlacer, state: Readonly<State>): HTMLElement | null {
  const scan = placer.place(state);
  if (!scan) return null;
  const residual = state.scanColoring === "residual";
  const bar = h("i", { class: "ramp" });
  bar.style.background = rampGradient(ramp(residual ? "error" : "scan", theme() === "dark"));
  const names = { intensity: "intensity", range: "range", residual: "distance to the true surface", none: "" };
  const unit = state.scanColoring === "intensity" ? "" : " m";
  return h(
    "span",
    { class: "legend-item", "data-key": "scan" },
    `scan, ${names[state.scanColoring]} ${formatFixed(scan.low, 1)}`,
    bar,
    `${formatFixed(scan.high, 1)}${residual ? "+" : ""}${unit}: ${scan.values.length} of `,
    `${scan.returns.toLocaleString("en")} returns at ${formatFixed(scan.t, 1)} s, placed by `,
    h("bdi", {}, scan.by),
  );
}

function inkKey(text: string, ink: string, kind = ""): HTMLElement {
  const swatch = h("i", { class: `swatch ${kind}`.trim() });
  swatch.style.background = ink;
  return h("span", { class: "legend-item" }, swatch, h("bdi", {}, text));
}

function legend(
  data: RunPayload,
  state: Readonly<State>,
  placer: ScanPlacer,
  scale: number,
): HTMLElement {
  const chosen = data.estimators[state.chosen];
  const covariance = chosen?.series?.position_covariance;
  return h(
    "div",
    { class: "view-legend" },
    data.truth ? inkKey("truth", color("--truth")) : null,
    chosen ? inkKey(chosen.name, seriesColor(chosen.colour_index)) : null,
    data.localizability?.weak_axis ? inkKey("weak axis", color("--weak")) : null,
    data.scene?.people?.length ? inkKey("people", color("--person"), "dot") : null,
    covariance && chosen
      ? inkKey(
          `3σ ellipsoid${scale > 1 ? `, drawn ${scale}×` : ""}`,
          seriesColor(chosen.colour_index),
          "dot",
        )
      : null,
    mapKey(data, state),
    scanKey(placer, state),
  );
}

/** True and estimated position at the cursor. */
function readout(data: RunPayload, state: Readonly<State>): HTMLElement {
  const chosen = data.estimators[state.chosen];
  const truthIndex = indexAt(data.truth?.t, state.cursor);
  const truth = vectorAt(data.truth?.p, truthIndex);
  const index = indexAt(chosen?.series?.t, state.cursor);
  const estimate = vectorAt(chosen?.series?.p, index);
  const returns = track(data.localizability?.t, data.localizability?.equivalent_returns);
  const place = (point: number[] | null) =>
    point ? point.map((value) => formatFixed(value, 2)).join(", ") : "–";
  const error =
    truth && estimate ? Math.hypot(...truth.map((value, i) => value - estimate[i]!)) : NaN;
  const item = (name: string, key: string, text: string) =>
    h(
      "span",
      {},
      h("span", { class: "soft" }, `${name} `),
      h("output", { "data-readout": key }, text),
    );
  return h(
    "div",
    { class: "readout" },
    data.truth ? item("truth", "truth", `${place(truth)} m`) : null,
    chosen ? item("estimate", "estimate", `${place(estimate)} m`) : null,
    chosen && data.truth ? item("error, aligned by the start alone,", "error", `${formatNumber(error)} m`) : null,
    returns
      ? item("equivalent returns", "returns", formatNumber(valueAt(returns, state.cursor)))
      : null,
  );
}

/** The view; `start` draws it once it is in the document. */
export function viewCard(
  data: RunPayload,
  store: Store,
): { element: HTMLElement; start: () => void } {
  const words = h("div", {}, readout(data, store.state));
  store.on(["cursor", "chosen"], () => words.replaceChildren(readout(data, store.state)));
  const element = h("section", { class: "card view", "aria-label": "3D view" });
  const placer = new ScanPlacer(data, data.scene ? new Surface(data.scene) : null);
  const view = create(data, store, placer);
  if (!view) {
    element.append(fallback(data), words);
    return { element, start: () => {} };
  }
  const frame = h("div", { class: "view-frame", "data-view": "webgl" }, view.canvas, view.axes.element);
  view.canvas.setAttribute("role", "img");
  view.canvas.setAttribute("aria-label", "Scene, map, trajectories and the robot at the cursor");
  const key = h("div");
  const showKey = () => key.replaceChildren(legend(data, store.state, placer, view.ellipsoidScale));
  showKey();
  element.append(controls(data, store, view, placer), frame, key, words);
  store.on(["cursor", "scanColoring"], () => {
    view.update(store.state, false);
    showKey();
  });
  store.on(["preset"], ({ preset }) => view.show(preset));
  store.on(["follow"], ({ follow }) => view.follow(follow));
  store.on(["chosen", "coloring", "ceiling", "hidden"], () => {
    view.update(store.state, true);
    showKey();
  });
  onTheme(() => {
    view.update(store.state, true);
    showKey();
  });
  const fit = () => view.resize(frame.clientWidth, frame.clientHeight);
  return {
    element,
    start: () => {
      fit();
      if (store.state.follow) view.follow(true);
      new ResizeObserver(fit).observe(frame);
    },
  };
}

function create(data: RunPayload, store: Store, placer: ScanPlacer): View3D | null {
  try {
    const kind = webGlKind();
    return kind ? new View3D(data, store.state, placer, kind === "card") : null;
  } catch {
    return null;
  }
}
