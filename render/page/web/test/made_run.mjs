// SPDX-License-Identifier: BSD-3-Clause
// A made-up run along a corridor: truth, estimators that drift, maps, scores.
import { picture } from "./made_picture.mjs";
import { kScoreList } from "./score_list.mjs";

/** Uniform numbers in [0, 1), the same every time. */
export function generator(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296;
  };
}

const kLength = 78.6;

/** Where the robot is: out along x, a turn, back; `fraction` of the run in [0, 1]. */
function poseAt(fraction) {
  const out = Math.min(fraction, 0.49) / 0.49;
  const back = Math.max(fraction - 0.51, 0) / 0.49;
  const yaw = Math.PI * Math.min(Math.max((fraction - 0.49) / 0.02, 0), 1);
  return {
    x: kLength * (fraction < 0.5 ? out : 1 - back),
    y: 0.05 * Math.sin(40 * fraction),
    z: 0.42 + 0.004 * Math.sin(900 * fraction),
    yaw,
  };
}

function boxEdges([x0, y0, z0], [x1, y1, z1]) {
  const c = (i) => [i & 1 ? x1 : x0, i & 2 ? y1 : y0, i & 4 ? z1 : z0];
  const pairs = [
    [0, 1],
    [2, 3],
    [4, 5],
    [6, 7],
    [0, 2],
    [1, 3],
    [4, 6],
    [5, 7],
    [0, 4],
    [1, 5],
    [2, 6],
    [3, 7],
  ];
  return pairs.flatMap(([a, b]) => [...c(a), ...c(b)]);
}

function scene() {
  const edges = boxEdges([-3, -1.1, 0], [kLength + 3, 1.1, 2.6]);
  for (let x = 4; x < kLength; x += 8)
    edges.push(...boxEdges([x, -1.25, 0], [x + 0.9, -1.1, 2.05]));
  const [x0, x1] = [-3, kLength + 3];
  const wall = (y) => [x0, y, 0, x1, y, 0, x1, y, 2.6, x0, y, 0, x1, y, 2.6, x0, y, 2.6];
  return {
    floor: null,
    edges: Float32Array.from(edges),
    triangles: Float32Array.from([...wall(-1.1), ...wall(1.1)]),
    roof_edges: Float32Array.from([x0, -1.1, 2.6, x1, 1.1, 2.6]),
    roof_triangles: Float32Array.from([x0, -1.1, 2.6, x1, -1.1, 2.6, x1, 1.1, 2.6]),
    bounds: null,
    people: [{ from: [10, -0.5], to: [20, -0.5], speed: 1, start: 3, radius: 0.25, height: 1.75 }],
  };
}

function map(count, drift, random) {
  const places = Array.from({ length: count }, () => {
    const x = -3 + (kLength + 6) * random();
    const wall = random();
    const lift = drift * (x / kLength) ** 2;
    const y = wall < 0.35 ? -1.1 : wall < 0.7 ? 1.1 : -1.1 + 2.2 * random();
    const z = (wall < 0.7 ? 2.6 * random() : wall < 0.9 ? 0 : 2.6) + lift;
    return { p: [x, y, z], lift };
  }).sort((a, b) => (a.p[2] > 2) - (b.p[2] > 2));
  return {
    n: count,
    points: 5 * count,
    below: places.filter(({ p }) => p[2] <= 2).length,
    p: Float32Array.from(places.flatMap(({ p }) => p)),
    error: Uint8Array.from(places, ({ lift }) => Math.min(255, (255 * Math.abs(lift)) / 0.5)),
  };
}

/** Columns of an estimator that drifts by so much [m] and stops when it diverges. */
function estimator(name, index, drift, count, end, random, divergedAt, points) {
  const series = {
    t: new Float32Array(count),
    p: new Float32Array(3 * count),
    q: new Float32Array(4 * count),
    position_covariance: new Float32Array(6 * count),
  };
  const names = [
    "D",
    "D_smoothed",
    "O_lidar",
    "C_IL",
    "gamma_lidar",
    "gamma_leg",
    "lambda_min",
    "innovation",
    "innovation_rotation",
    "weak_weight",
    "error_longitudinal",
    "error_lateral",
    "error_vertical",
    "sigma_longitudinal",
    "sigma_lateral",
    "sigma_vertical",
    "time_ms",
  ];
  for (const column of names) series[column] = new Float32Array(count);
  let smooth = 0;
  for (let i = 0; i < count; ++i) {
    const fraction = count > 1 ? i / (count - 1) : 0.3;
    const t = count > 1 ? 2 + (end - 2) * fraction : 2;
    const inside = fraction > 0.1 && fraction < 0.9 && Math.abs(fraction - 0.5) > 0.03;
    const pose = poseAt(fraction);
    const grown = drift * fraction ** 1.5;
    const noise = () => random() - 0.5;
    const D = Math.min(1, Math.max(0, (inside ? 0.62 : 0.12) + 0.2 * noise()));
    smooth = i === 0 ? D : 0.9 * smooth + 0.1 * D;
    const error = {
      longitudinal: grown + 0.01 * noise(),
      lateral: 0.1 * grown + 0.004 * noise(),
      vertical: 0.4 * grown * Math.sin(6 * fraction) + 0.004 * noise(),
    };
    const sigma = {
      longitudinal: 0.01 + 0.06 * fraction,
      lateral: 0.004 + 0.01 * fraction,
      vertical: 0.004 + 0.02 * fraction,
    };
    series.t[i] = t;
    series.p.set(
      [pose.x + error.longitudinal * Math.cos(pose.yaw), pose.y + error.lateral, pose.z + error.vertical],
      3 * i,
    );
    series.q.set([0, 0, Math.sin(pose.yaw / 2), Math.cos(pose.yaw / 2)], 4 * i);
    series.position_covariance.set(
      [sigma.longitudinal ** 2, 0, 0, sigma.lateral ** 2, 0, sigma.vertical ** 2],
      6 * i,
    );
    for (const axis of ["longitudinal", "lateral", "vertical"]) {
      series[`error_${axis}`][i] = error[axis];
      series[`sigma_${axis}`][i] = sigma[axis];
    }
    Object.entries({
      D,
      D_smoothed: smooth,
      O_lidar: 1 - 0.8 * D,
      C_IL: 10 ** (2 * noise() + (inside ? 1 : 0)),
      gamma_lidar: Math.exp(-3 * smooth),
      gamma_leg: fraction > 0.6 && fraction < 0.65 ? 0.1 : 0.95,
      lambda_min: (inside ? 3e3 : 4e4) * (1 + 0.4 * noise()),
      innovation: 0.01 * random() * (inside ? 2 : 1),
      innovation_rotation: 0.002 * random(),
      weak_weight: inside ? 0.2 + 0.1 * random() : 1,
      time_ms: 5 + 3 * random() + index,
    }).forEach(([key, value]) => {
      series[key][i] = value;
    });
  }
  return {
    name,
    diverged_at: divergedAt,
    colour_index: index,
    series,
    map: points > 0 ? map(points, drift, random) : null,
  };
}

function scoresOf(item, random) {
  const value = () => 0.3 * random();
  return {
    success: item.diverged_at === null,
    diverged_at_s: item.diverged_at,
    m_list_percent: { "a-b": value(), "b-a": item.diverged_at === null ? value() : null, all: value() },
    m_end_m: value(),
    ate_m: value(),
    ate_yaw_m: value(),
    ate_se3_m: value(),
    max_error_m: value(),
    max_error_z_m: value(),
    rpe_1m: { translation_m: value(), rotation_rad: value() },
    rpe_10m: { translation_m: value(), rotation_rad: value() },
    drift_m: {
      rmse: { longitudinal: value(), lateral: value(), vertical: value(), heading_rad: value() },
    },
    weak_axis: {
      all: { scans: 2000, error_rms_m: value(), bound_rms_m: 0.02, efficiency: 0.3, nees: 1.2 },
      n100: { scans: 900, error_rms_m: value(), bound_rms_m: 0.02, efficiency: 0.3, nees: 1.4 },
    },
    time_per_scan_ms: { mean: 5 + value(), p50: 5, p99: 8 + value() },
    cpu_per_scan_ms: { mean: 4 + value(), p50: 4, p99: 6 + value() },
  };
}

/** A scan every two seconds: both walls and the floor, seen from the body. */
function scans(seconds, random) {
  const each = 60;
  const t = Float32Array.from({ length: Math.floor(seconds / 2) }, (_, i) => 2 + 2 * i);
  const points = Array.from({ length: t.length * each }, () => [
    10 * random() - 5,
    random() < 0.5 ? -1.1 : 1.1,
    1.5 * random() - 0.4,
  ]);
  return {
    t,
    first: t.map((_, i) => i * each),
    returns: t.map(() => 28000),
    below: t.map(() => each - 10),
    p: Float32Array.from(points.flat()),
    intensity: Uint8Array.from(points, () => 255 * random()),
  };
}

/** A run along a corridor; options: names, count of samples, points per map. */
export function run({
  names = ["aims_d", "aims", "lio", "tfs"],
  count = 2380,
  points = 20000,
  title = "corridor, seed 1",
  seconds = 240,
} = {}) {
  const random = generator(7);
  const drifts = [0.05, 0.16, 0.4, 6, 11, 2];
  const estimators = names.map((name, i) =>
    estimator(
      name,
      i,
      drifts[i % 6],
      count,
      seconds,
      random,
      i === 3 ? 181.4 : null,
      i === 3 ? 0 : points,
    ),
  );
  const samples = Math.max(count, 1);
  const truth = {
    t: new Float32Array(samples),
    p: new Float32Array(3 * samples),
    q: new Float32Array(4 * samples),
  };
  const local = {
    t: new Float32Array(samples),
    equivalent_returns: new Float32Array(samples),
    lambda_min: new Float32Array(samples),
    weak_axis: new Float32Array(3 * samples),
  };
  for (let i = 0; i < samples; ++i) {
    const fraction = samples > 1 ? i / (samples - 1) : 0.3;
    const pose = poseAt(fraction);
    const inside = fraction > 0.1 && fraction < 0.9 && Math.abs(fraction - 0.5) > 0.03;
    truth.t[i] = local.t[i] = samples > 1 ? 2 + (seconds - 2) * fraction : 2;
    truth.p.set([pose.x, pose.y, pose.z], 3 * i);
    truth.q.set([0, 0, Math.sin(pose.yaw / 2), Math.cos(pose.yaw / 2)], 4 * i);
    local.equivalent_returns[i] = (inside ? 40 : 900) * (0.7 + 0.6 * random());
    local.lambda_min[i] = local.equivalent_returns[i] / 0.0004;
    local.weak_axis.set([1, 0.02, 0], 3 * i);
  }
  const legs = {
    t: truth.t,
    loss: truth.t.map((_, i) =>
      i / samples > 0.6 && i / samples < 0.65 ? 0.9 : 0.02 * (random() > 0.9),
    ),
    slip: truth.t.map(() => (random() > 0.98 ? 0.4 * random() : 0.02)),
  };
  return {
    schema: "aims.page/2",
    kind: "run",
    title,
    version: "0.0.0",
    scenario: {
      name: title,
      description: "made up: a corridor of 78.6 m, out and back",
      seed: 1,
      simulated_s: seconds,
      complete: true,
      robot: { fell: false, touched_wall: false },
    },
    command: `aims run corridor --seed 1 --estimators ${names.join(",")}`,
    config_yaml: "name: corridor\nseed: 1\n",
    config_changes: [
      { key: "scene.corridor.length", value: 78.6, default: 40, unit: "m" },
      { key: "route.speed", value: 0.7, default: 0.5, unit: "m/s" },
    ],
    partial: [],
    score_list: kScoreList,
    scores: {
      schema: "aims.scores/1",
      segments: [
        { name: "a-b", length_m: 78.6 },
        { name: "b-a", length_m: 78.6 },
      ],
      localizability: {
        scans: samples,
        median_equivalent_returns: 44,
        degenerate_fraction: { n10: 0, n100: 0.74, n1000: 0.93 },
        bound_end_m: { longitudinal: 0.02, lateral: 0.004, vertical: 0.005 },
      },
      estimators: Object.fromEntries(estimators.map((item) => [item.name, scoresOf(item, random)])),
      expectations: [],
    },
    scene: scene(),
    waypoint_times: [
      { name: "a", t: 5, x: 0, y: 0, z: 0.4 },
      { name: "b", t: seconds / 2, x: kLength, y: 0, z: 0.4 },
    ],
    truth,
    localizability: {
      ...local,
      crb_sigma: null,
      bound_longitudinal: null,
      bound_lateral: null,
      bound_vertical: null,
      degenerate: {
        n10: [],
        n100: [
          [2 + 0.1 * seconds, 0.47 * seconds],
          [0.53 * seconds, 0.9 * seconds],
        ],
        n1000: [[5, 0.95 * seconds]],
      },
    },
    legs,
    scans: scans(seconds, random),
    estimators,
    pictures: [
      { name: "trajectories", title: "Trajectories", png: picture(320, 200) },
      { name: "robot_start", title: "The robot at the start", png: picture(320, 240) },
    ],
  };
}
