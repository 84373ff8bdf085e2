// SPDX-License-Identifier: BSD-3-Clause
/** Which strips the timeline has, for the chosen estimator. */
import type { Estimator, RunPayload, TimeInterval } from "../contract";
import { isNumber } from "../format";
import { seriesDash } from "../palette";
import { color, seriesColor } from "../theme";
import type { Curve, PanelSpec } from "./panel";
import type { Backdrop, Mark } from "./panel_paint";
import { missingText } from "./errors";
import { column, track } from "./series";
import type { Level, State } from "./store";

export const kLevels: { level: Level; returns: number }[] = [
  { level: "n10", returns: 10 },
  { level: "n100", returns: 100 },
  { level: "n1000", returns: 1000 },
];

/** Curves of several columns of one estimator; those that the folder lacks are left out. */
function parts(
  estimator: Estimator | undefined,
  list: [name: string, label: string, color: string, dash?: number[]][],
): Curve[] {
  return list.flatMap(([name, label, ink, dash]) => {
    const found = column(estimator, name);
    return found ? [{ label, track: found, color: ink, dash }] : [];
  });
}

/** Dash of a style; none for a solid line. */
export function dashed(index: number): number[] | undefined {
  const dash = seriesDash(index);
  return dash.length > 0 ? dash : undefined;
}

/** The same column of every estimator, the chosen one last, so that it lies on top. */
function everyone(data: RunPayload, state: Readonly<State>, name: string, all: boolean): Curve[] {
  const { chosen, hidden } = state;
  const order = data.estimators
    .map((_, index) => index)
    .filter((index) => index === chosen || !hidden.has(index))
    .sort((a, b) => Number(a === chosen) - Number(b === chosen));
  const curves = order.flatMap((index): Curve[] => {
    const estimator = data.estimators[index]!;
    const found = column(estimator, name);
    if (!found) return [];
    return [
      {
        label: estimator.name,
        track: found,
        color: seriesColor(estimator.colour_index),
        dash: dashed(estimator.colour_index),
        width: index === chosen ? 1.75 : 1,
        place: index === chosen ? -1 : index,
        counts: all || index === chosen,
      },
    ];
  });
  if (!curves.some((curve) => curve.counts)) for (const curve of curves) curve.counts = true;
  return curves;
}

function truthPanels(data: RunPayload, chosenLevel: Level): PanelSpec[] {
  const truth = data.localizability;
  const returns = track(truth?.t, truth?.equivalent_returns);
  const panels: PanelSpec[] = [];
  if (returns) {
    panels.push({
      id: "localizability",
      title: "Localizability, truth",
      unit: "equivalent returns",
      log: true,
      hint: "Returns of a facing surface that would constrain the weak axis as strongly as this scan, from the truth",
      curves: [{ label: "truth", track: returns, color: color("--truth") }],
      levels: kLevels.filter(({ level }) => level === chosenLevel).map(({ returns: n }) => n),
    });
  }
  return panels;
}

function indexPanels(estimator: Estimator | undefined): PanelSpec[] {
  const blue = seriesColor(0),
    orange = seriesColor(1),
    green = seriesColor(2),
    pink = seriesColor(3);
  return [
    {
      id: "index",
      title: "Degeneracy index",
      range: [-0.03, 1.03],
      hint: "D_k, its smoothed value, and O_lidar, eqs. (4), (7), (12)",
      curves: parts(estimator, [
        ["O_lidar", "O_lidar", green, [5, 3]],
        ["D", "D", orange],
        ["D_smoothed", "D smoothed", blue],
      ]),
    },
    {
      id: "consistency",
      title: "C_IL",
      log: true,
      hint: "Squared innovation normalised by the predicted covariance, eq. (6)",
      curves: parts(estimator, [["C_IL", "C_IL", pink]]),
    },
    {
      id: "weights",
      title: "Weights",
      range: [-0.03, 1.03],
      hint: "Reliabilities of LiDAR and legs, eqs. (8), (10); real fraction of the information along the weakest axis",
      curves: parts(estimator, [
        ["gamma_lidar", "γ lidar", blue],
        ["gamma_leg", "γ leg", orange],
        ["weak_weight", "real fraction", green, [5, 3]],
      ]),
    },
    {
      id: "eigenvalue",
      title: "Smallest eigenvalue",
      log: true,
      hint: "Of the scan's information matrix, from the estimator's diagnostics",
      curves: parts(estimator, [["lambda_min", "λ min", blue]]),
    },
    {
      id: "imu_noise",
      title: "IMU noise",
      log: true,
      hint: "White noise that the estimator finds: gyro in rad/s/√Hz, accelerometer in m/s²/√Hz",
      curves: parts(estimator, [
        ["gyro_noise", "gyro", blue],
        ["accelerometer_noise", "accelerometer", orange],
      ]),
    },
    {
      id: "delay",
      title: "IMU delay",
      unit: "s",
      hint: "Delay of the IMU's stamps that the estimator finds",
      curves: parts(estimator, [["delay", "delay", pink]]),
    },
  ];
}

function legPanel(data: RunPayload): PanelSpec {
  const legs = data.legs;
  const loss = track(legs?.t, legs?.loss);
  const slip = track(legs?.t, legs?.slip);
  const curves: Curve[] = [];
  if (loss)
    curves.push({ label: "loss", track: loss, color: seriesColor(3), area: true, width: 0.75 });
  if (slip) curves.push({ label: "slip m/s", track: slip, color: seriesColor(0), width: 1 });
  return {
    id: "legs",
    title: "Legs, truth",
    hint: "Fraction of samples lost per 0.1 s; true speed of the stance foot that slips most",
    curves,
  };
}

function errorPanels(data: RunPayload, state: Readonly<State>): PanelSpec[] {
  const chosen = data.estimators[state.chosen];
  return ["longitudinal", "lateral", "vertical"].map((axis) => {
    const sigma = column(chosen, `sigma_${axis}`);
    return {
      id: `error_${axis}`,
      title: `${axis[0]!.toUpperCase()}${axis.slice(1)} error`,
      unit: "m",
      hint: "Estimate minus truth, anchored at the start; band: three stated standard deviations",
      curves: everyone(data, state, `error_${axis}`, state.errorScale === "all"),
      ...(sigma && chosen ? { band: { sigma, color: seriesColor(chosen.colour_index) } } : {}),
    };
  });
}

/**
 * Strips of a tab; those without data are left out. Errors: what is measured against the truth, and time.
 * Internals: what the chosen estimator computes by itself.
 */
export function panelSpecs(data: RunPayload, state: Readonly<State>): PanelSpec[] {
  const chosen = data.estimators[state.chosen];
  const innovations = parts(chosen, [
    ["innovation", "position m", seriesColor(0)],
    ["innovation_rotation", "rotation rad", seriesColor(1)],
  ]);
  const innovation: PanelSpec = {
    id: "innovation",
    title: "Innovation",
    hint: "LiDAR-updated minus predicted, eq. (5)",
    curves: innovations,
  };
  const time: PanelSpec = {
    id: "time",
    title: "Time per scan",
    unit: "ms",
    log: true,
    hint: "From one scan to the next",
    curves: everyone(data, state, "time_ms", true),
  };
  const localizability = truthPanels(data, state.level);
  const panels = state.tab === "internals"
    ? [...localizability, ...indexPanels(chosen), innovation]
    : [...errorPanels(data, state), ...localizability, legPanel(data), time];
  return panels.filter((panel) => panel.curves.length > 0);
}

/** Degenerate intervals at the chosen level, waypoints, and when the chosen estimator diverged. */
export function backdrop(data: RunPayload, state: Readonly<State>): Backdrop {
  const intervals = data.localizability?.degenerate?.[state.level];
  const shaded = Array.isArray(intervals)
    ? intervals.filter((pair): pair is TimeInterval => isNumber(pair?.[0]) && isNumber(pair?.[1]))
    : [];
  const marks: Mark[] = (data.waypoint_times ?? [])
    .filter((waypoint_time) => isNumber(waypoint_time.t))
    .map((waypoint_time) => ({ t: waypoint_time.t!, text: waypoint_time.name, color: color("--ink-soft") }));
  const divergedAt = data.estimators[state.chosen]?.diverged_at;
  if (isNumber(divergedAt)) marks.push({ t: divergedAt, text: missingText(data, data.estimators[state.chosen]!.name) ? "no poses" : "diverged", color: color("--bad") });
  return { shaded, marks };
}
