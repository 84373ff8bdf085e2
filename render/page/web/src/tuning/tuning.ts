// SPDX-License-Identifier: BSD-3-Clause
/** The page of a sweep or a tuning: best values, sensitivity, curves, a map, every point. */
import "../charts/charts.css";
import "./tuning.css";
import { choice, facts, notes } from "../charts/controls";
import { h, section } from "../dom";
import { themeButton } from "../theme";
import { curves, type Shown } from "./curves";
import { firstPair, map, type Pair } from "./map";
import { pointsOf, scenariosOf, type TunedEstimator, type TuningPayload } from "./model";
import { bestTable, outcome, pointTable, sensitivity } from "./tables";

interface View {
  estimator: TunedEstimator;
  score: string;
  shown: Shown;
  pair: Pair | null;
  scenario: string | null;
  heldOut: boolean;
}

function analysisOf(view: View) {
  return view.estimator.analyses.find((each) => each.score === view.score);
}

function scoreChoices(data: TuningPayload, view: View) {
  const analysed = view.estimator.analyses.map((each) => each.score);
  return [
    ...analysed.map((value) => ({ value, label: value })),
    ...data.scores.filter((each) => !analysed.includes(each)).map((value) => ({ value, label: value, group: "points only" })),
  ];
}

function bestSection(data: TuningPayload, view: View): HTMLElement {
  const analysis = analysisOf(view);
  if (!analysis) {
    return section("best", "Best values", h("p", { class: "nothing" },
      `Best values and sensitivity exist for ${view.estimator.analyses.map((each) => each.score).join(", ")}; for ${view.score} only the points are shown.`));
  }
  return section("best", "Best values", outcome(analysis, { tuned: data.source === "tune", front: data.front ?? null, interrupted: data.interrupted === true }),
    data.looked ? h("p", { class: "verdict undecided", "data-looked": "" }, data.looked) : null, bestTable(view.estimator, analysis));
}

function sensitivitySection(view: View): HTMLElement | null {
  const analysis = analysisOf(view);
  return analysis && view.estimator.parameters.length > 1 ? section("sensitivity", "Sensitivity", sensitivity(view.estimator, analysis)) : null;
}

function curveSection(data: TuningPayload, view: View, redraw: () => void): HTMLElement {
  const analysis = analysisOf(view);
  const shown = analysis ? view.shown : "cloud";
  const kinds = [{ value: "cloud", label: "score of every point, by scenario" }];
  if (analysis) kinds.unshift(
    { value: "slice", label: "objective, one parameter at a time" }, { value: "points", label: "objective of every point" });
  return section("curves", "By parameter",
    h("div", { class: "toolbar" }, choice("Show", kinds, shown, (value) => {
      view.shown = value as Shown;
      redraw();
    })), curves(data, view.estimator, analysis, view.score, shown),
    h("p", { class: "soft" }, shown === "cloud" ? "Median over the seeds of a scenario; ✕: a run diverged."
      : shown === "points" ? (view.estimator.parameters.length > 1 ? "All other parameters differ, too." : "")
      : "Markers: measured, with 95 % intervals over seeds. Thin lines: fits with the interval of their error, where cross-validation supports them. A press on a name shows or hides it."));
}

function mapSection(view: View, redraw: () => void): HTMLElement | null {
  const analysis = analysisOf(view);
  if (!analysis || view.estimator.parameters.length < 2) return null;
  const pair = view.pair ?? firstPair(analysis) ?? { first: 0, second: 1 };
  return section("map", "Two parameters", map(view.estimator, analysis, pair, (next) => {
    view.pair = next;
    redraw();
  }));
}

function pointSection(data: TuningPayload, view: View, redraw: () => void): HTMLElement {
  const scenarios = scenariosOf(data);
  const anyHeldOut = (data.held_out_jobs["done"] ?? 0) > 0;
  return section("points", "Every point",
    h("div", { class: "toolbar" },
      choice("Scenario", [{ value: "", label: "all" }, ...scenarios.map((each, i) => ({ value: String(i), label: each }))],
        view.scenario === null ? "" : String(scenarios.indexOf(view.scenario)), (value) => {
          view.scenario = value === "" ? null : scenarios[Number(value)] ?? null;
          redraw();
        }),
      anyHeldOut ? choice("Sequences", [{ value: "tuned", label: "tuning" }, { value: "held", label: "held out" }],
        view.heldOut ? "held" : "tuned", (value) => {
          view.heldOut = value === "held";
          redraw();
        }) : null),
    h("div", { class: "tall" }, pointTable(data, view.estimator, analysisOf(view), view.score, view)));
}

/** Replaces a part by a new drawing of itself, whenever it is asked to. */
function part(make: (redraw: () => void) => HTMLElement | null): HTMLElement {
  const place = h("div", {});
  const redraw = () => place.replaceChildren(...[make(redraw)].filter((each) => each !== null));
  redraw();
  return place;
}

function jobText(jobs: Record<string, number>): string {
  const bad = ["invalid", "failed", "crashed", "timed_out", "missing"].filter((key) => (jobs[key] ?? 0) > 0)
    .map((key) => `${jobs[key]} ${key.replace("_", " ")}`);
  return `${jobs["done"] ?? 0} of ${jobs["total"] ?? 0} done${bad.length > 0 ? `, ${bad.join(", ")}` : ""}`;
}

/** Fills `root` with the page of a sweep or a tuning. */
export function renderTuning(root: HTMLElement, data: TuningPayload): void {
  root.append(h("header", { class: "page-head" }, h("h1", {}, data.title), themeButton()));
  root.append(facts([
    ["jobs", jobText(data.jobs)],
    ["held out", (data.held_out_jobs["total"] ?? 0) > 0 ? jobText(data.held_out_jobs) : null],
    ["scenarios", scenariosOf(data).length], ["sequences", data.sequences.length],
    ["points", data.estimators[0] ? pointsOf(data, data.estimators[0], "", { scenario: null, heldOut: false }).length : 0],
  ]));
  const noted = notes(data.notes);
  const plan = section("plan", "Plan", noted, h("pre", { class: "plan" }, data.plan));
  const first = data.estimators[0];
  if (!first) {
    root.append(section("best", "Best values", h("p", { class: "nothing" }, "No job is done yet.")), plan);
    return;
  }
  const view: View = {
    estimator: first, score: first.analyses[0]?.score ?? data.scores[0] ?? "", shown: first.analyses[0]?.curves.length === 0 ? "points" : "slice",
    pair: null, scenario: null, heldOut: false,
  };
  const body = h("div", {});
  const bar = h("div", { class: "toolbar" });
  const draw = () => {
    bar.replaceChildren(...[
      data.estimators.length > 1 ? choice("Estimator", data.estimators.map((each, i) => ({ value: String(i), label: each.name })),
        String(data.estimators.indexOf(view.estimator)), (value) => {
          view.estimator = data.estimators[Number(value)] ?? view.estimator;
          draw();
        }) : h("span", { class: "soft" }, `Estimator ${view.estimator.name}`),
      choice("Score", scoreChoices(data, view), view.score, (value) => {
        view.score = value;
        draw();
      }),
    ]);
    body.replaceChildren(
      h("div", view.estimator.parameters.length > 1 ? { class: "pair" } : {},
        part(() => bestSection(data, view)), part(() => sensitivitySection(view))),
      part((redraw) => curveSection(data, view, redraw)), part((redraw) => mapSection(view, redraw)),
      part((redraw) => pointSection(data, view, redraw)));
  };
  draw();
  root.append(bar, body, plan);
}
