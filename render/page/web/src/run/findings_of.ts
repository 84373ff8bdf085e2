// SPDX-License-Identifier: BSD-3-Clause
/** What a run's scores and time series say of each estimator. */
import type { RunPayload } from "../contract";
import { at, own } from "../dom";
import type { Finding, Route } from "../findings";
import { isNumber } from "../format";
import { errorTrack, isScaled, lossOf, missingText, truePath, type Path } from "./errors";

/** Mean of the signed errors of the segments [%]. */
function signedPercent(scores: unknown): number | null {
  const list = Object.values(own<object>(scores, "m_list_signed_percent") ?? {}).filter(isNumber);
  return list.length > 0 ? list.reduce((a, b) => a + b, 0) / list.length : null;
}

/** Median of the equivalent returns over the ten seconds after an instant; null: not known. */
export function returnsAfter(data: RunPayload, seconds: number): number | null {
  const local = data.localizability;
  const values: number[] = [];
  local?.t.forEach((t, i) => {
    const value = local.equivalent_returns?.[i];
    if (t >= seconds && t <= seconds + 10 && isNumber(value)) values.push(value);
  });
  if (values.length === 0) return null;
  values.sort((a, b) => a - b);
  return values[Math.floor(values.length / 2)]!;
}

/** The direction that fails, where it is not the one along the way. */
function asideOf(scores: unknown): Finding["aside"] {
  const rmse = (axis: string) => Number(at(scores, "drift_m", "rmse", axis) ?? 0);
  const [along, across, up] = [rmse("longitudinal"), rmse("lateral"), rmse("vertical")];
  if (up > across && up > along) return { direction: "height", most: Math.max(up, Number(at(scores, "max_error_z_m") ?? 0)) };
  const most = at(scores, "drift_m", "max", "lateral");
  return across > along ? { direction: "sideways", most: isNumber(most) ? most : across } : null;
}

function findingOf(data: RunPayload, path: Path | null, name: string, scores: unknown): Finding {
  const estimator = data.estimators.find((item) => item.name === name);
  const track = path && estimator ? errorTrack(path, estimator, "heading") : null;
  const loss = track ? lossOf(track) : null;
  const numberAt = (...keys: string[]) => {
    const value = at(scores, ...keys);
    return isNumber(value) ? value : null;
  };
  return {
    name,
    success: at(scores, "success") === true,
    percent: numberAt("m_list_percent", "all"),
    worst: null,
    signed: signedPercent(scores),
    ate: numberAt("ate_yaw_m"),
    loss: loss ? { from: loss.from, distance: loss.distance, most: loss.most, scaled: isScaled(path!, track!) } : null,
    aside: asideOf(scores),
    returns: loss ? returnsAfter(data, loss.from) : null,
    missing: missingText(data, name),
    healthy: at(scores, "health", "worst") === "healthy",
  };
}

/** Empty without scores. */
export function findingsOf(data: RunPayload): { list: Finding[]; route: Route } {
  const path = truePath(data);
  const scores = Object.entries(own<object>(data.scores, "estimators") ?? {});
  return {
    list: scores.map(([name, each]) => findingOf(data, path, name, each)),
    route: {
      corridor: data.scenario.corridor === true,
      length: path?.travelled[path.travelled.length - 1] ?? Infinity,
    },
  };
}
