// SPDX-License-Identifier: BSD-3-Clause
/** The page of `aims watch`: asks for the state of a live estimate and shows it. */
import "uplot/dist/uPlot.min.css";
import "../style.css";
import "../run/run.css";
import "./watch.css";
import { h, section } from "../dom";
import { formatFixed, formatNumber } from "../format";
import { usePalette } from "../palette";
import { Panel, type PanelSpec } from "../run/panel";
import { onTheme, seriesColor, startTheme, themeButton } from "../theme";
import { Plan } from "./plan";
import { kMinutes, LiveState, type Answer } from "./state";

const kPeriod = 500;
/** Without odometry for longer, the estimate is silent [s]. */
const kSilent = 2;
const kLevels = ["healthy", "not healthy", "invalid", "unknown"];

const state = new LiveState();
const plan = new Plan(state);
const status = h("p", { class: "watch-state", role: "status" });
const reasons = h("ul", { class: "watch-reasons" });
const figures = h("tbody", {});
const charts = h("div", {});
const name = h("span", { class: "soft" });
let panels: Panel[] = [];

function panelSpecs(): PanelSpec[] {
  return [
    {
      id: "latency",
      title: "Latency",
      unit: "ms",
      hint: "From the arrival of a scan to its odometry, since the start",
      curves: [
        { label: "median", track: state.track("latency median [ms]"), color: seriesColor(0) },
        { label: "99 %", track: state.track("latency 99 % [ms]"), color: seriesColor(0), dash: [5, 3] },
      ],
    },
    {
      id: "rate",
      title: "Scans",
      unit: "per second",
      curves: [{ label: "scans", track: state.track("scans per second"), color: seriesColor(0) }],
    },
  ];
}

function showCharts(): void {
  for (const panel of panels) panel.destroy();
  const now = state.history.at(-1)?.t ?? 0;
  const window = { from: Math.max(0, now - kMinutes * 60), to: Math.max(now, 10) };
  const specs = panelSpecs().filter(({ curves }) => curves[0]!.track.times.length > 0);
  panels = specs.map((spec, i) => {
    const last = i === specs.length - 1;
    const panel = new Panel(spec, { shaded: [], marks: [] }, charts.clientWidth, window, false, last);
    panel.showCursor(now);
    return panel;
  });
  charts.replaceChildren(...panels.map(({ element }) => element));
}

function showHealth(answer: Answer): void {
  const [first, ...rest] = answer.health.text.split(": ");
  const silent = answer.silent_s === null || answer.silent_s > kSilent;
  const since = answer.silent_s === null ? "" : `, last ${formatFixed(answer.silent_s, 0)} s ago`;
  status.textContent = silent ? `no odometry${since}` : first || kLevels[answer.health.level] || "unknown";
  status.className = `watch-state ${silent || answer.health.level > 0 ? "bad" : "good"}`;
  const texts = rest.join(": ").split("; ").filter((each) => each !== "");
  reasons.replaceChildren(...texts.map((each) => h("li", {}, each)));
}

function showFigures(answer: Answer): void {
  const rows: [string, string][] = [];
  if (answer.pose) {
    const [x, y, z, heading] = answer.pose;
    rows.push(["position [m]", [x, y, z].map((each) => formatFixed(each, 2)).join(", ")]);
    rows.push(["heading [deg]", formatFixed((heading * 180) / Math.PI, 1)]);
  }
  rows.push(...answer.health.values);
  if (answer.malformed > 0) rows.push(["messages that cannot be read", formatNumber(answer.malformed)]);
  figures.replaceChildren(...rows.map(([name, value]) => h("tr", {}, h("th", {}, name), h("td", {}, value))));
}

function fail(error: unknown): void {
  status.textContent = "aims watch has ended";
  status.className = "watch-state bad";
  reasons.replaceChildren(h("li", {}, error instanceof Error ? error.message : String(error)));
}

async function update(start: number): Promise<void> {
  try {
    const response = await fetch(state.query);
    const answer = (await response.json()) as Answer;
    state.take(answer, (performance.now() - start) / 1000);
    name.textContent = answer.node;
    showHealth(answer);
    showFigures(answer);
    plan.draw();
    showCharts();
    document.documentElement.dataset["ready"] = "true";
  } catch (error) {
    fail(error);
  }
}

function start(): void {
  startTheme();
  usePalette(null);
  document.title = "aims watch";
  const root = document.getElementById("page")!;
  root.classList.add("run-page");
  root.append(
    h("header", { class: "page-head" }, h("h1", {}, "Live estimate"), name, themeButton()),
    h(
      "div",
      { class: "watch-columns" },
      h(
        "div",
        {},
        section("plan", "Path and last scan", plan.element),
        section("charts", `Last ${kMinutes} minutes`, charts),
      ),
      h(
        "div",
        {},
        section("health", "Health", status, reasons),
        section("figures", "Figures", h("table", { class: "watch-figures" }, figures)),
      ),
    ),
  );
  onTheme(showCharts);
  const begin = performance.now();
  const next = () => void update(begin).then(() => setTimeout(next, kPeriod));
  next();
}

start();
