// SPDX-License-Identifier: BSD-3-Clause
/** What a page is handed, `aims.page/2`, after payload.ts has turned references into arrays. */

/** A number that may have no value; NaN plays this part inside arrays. */
export type Maybe = number | null;
export type Numbers = Float32Array;
export type Json = null | boolean | number | string | Json[] | { [key: string]: Json };

/** How a series looks, on a light and on a dark ground. */
export interface SeriesStyle {
  light: string;
  dark: string;
  /** Lengths of line and gap in turn [px]. */
  dash: number[];
}

/** A score of the list that all of the program takes titles and units from. */
export interface ListedScore {
  key: string;
  title: string;
  unit: string;
  better: string;
}

export interface PagePayload {
  schema: string;
  kind: string;
  title: string;
  version?: string;
  palette?: SeriesStyle[];
}

export interface ConfigChange {
  key: string;
  value: Json;
  default: Json;
  unit?: string | null;
}

export interface Scene {
  /** Corners of the floor, xy each [m]. */
  floor?: { min: number[]; max: number[]; flat?: boolean } | null;
  /** Pairs of points, xyz each, world [m]. */
  edges: Numbers | null;
  /** Corners of triangles, xyz each, world [m]. */
  triangles: Numbers | null;
  /** The same of the ceilings. */
  roof_edges?: Numbers | null;
  roof_triangles?: Numbers | null;
  /** Least and greatest corner of what is no ceiling, xyz each, world [m]. */
  bounds?: { min: number[]; max: number[] } | null;
  people?: Person[] | null;
}

/** Walks up and down between two points at constant speed, on a line or an arc. */
export interface Person {
  from: [number, number];
  to: [number, number];
  /** By which the way turns on an arc, positive to the left [rad]; 0 or none: a line. */
  turn?: number;
  /** Height of the floor [m]. */
  ground?: number;
  /** [m/s] */
  speed: number;
  /** Distance walked at time zero [m]. */
  start: number;
  radius: number;
  height: number;
}

export interface WaypointTime {
  name: string;
  t: Maybe;
  x: Maybe;
  y: Maybe;
  z: Maybe;
}

export interface Poses {
  /** Stamps [s]. */
  t: Numbers;
  /** Positions, xyz each, world [m]. */
  p: Numbers;
  /** Unit quaternions, xyzw each, body to world. */
  q: Numbers | null;
}

/** First and last stamp [s]. */
export type TimeInterval = [number, number];

export interface Localizability {
  t: Numbers;
  equivalent_returns: Numbers | null;
  lambda_min: Numbers | null;
  crb_sigma: Numbers | null;
  /** Unit vectors, xyz each, world; the sign means nothing. */
  weak_axis: Numbers | null;
  bound_longitudinal: Numbers | null;
  bound_lateral: Numbers | null;
  bound_vertical: Numbers | null;
  degenerate: { n10?: TimeInterval[] | null; n100?: TimeInterval[] | null; n1000?: TimeInterval[] | null };
}

export interface Legs {
  t: Numbers;
  /** Fraction of samples lost, in [0, 1]. */
  loss: Numbers | null;
  /** True speed of the stance foot that slips most [m/s]. */
  slip: Numbers | null;
}

/** Columns of an estimator, as long as `t`; `p` 3, `q` 4, `position_covariance` 6 per sample. */
export interface EstimatorSeries {
  t: Numbers;
  p: Numbers | null;
  q: Numbers | null;
  /** Upper triangle xx xy xz yy yz zz, body axes [m^2]. */
  position_covariance?: Numbers | null;
  [column: string]: Numbers | null | undefined;
}

export interface CloudMap {
  n: number;
  /** Of the map that these were chosen from. */
  points?: Maybe;
  /** The first so many lie below the ceiling. */
  below?: Maybe;
  /** Positions, xyz each, world [m]. */
  p: Numbers;
  /** Distance to the true surface, 0..255 for 0..0.5 m. */
  error: Uint8Array | null;
}

/** How long an estimator called itself what, after its start. */
export interface Health {
  worst: string;
  healthy_s: number;
  /** Of it, after its error exceeded the limit of a success. */
  healthy_while_wrong_s?: Maybe;
  degraded_s: number;
  invalid_s: number;
  reasons: string;
}

export interface Estimator {
  name: string;
  diverged_at: Maybe;
  health?: Health | null;
  /** Of a recording: what came out, and how far it goes [m]. */
  summary?: { poses?: Maybe; path_m?: Maybe; displacement_m?: Maybe } | null;
  /** Index of its style in the palette. */
  colour_index: number;
  series: EstimatorSeries | null;
  map: CloudMap | null;
}

/** Some scans of the run, thinned; points of one follow those of the one before. */
export interface Scans {
  /** Ends of the scans [s]. */
  t: Numbers;
  /** Index of each scan's first point. */
  first: Numbers;
  /** Returns that each scan had. */
  returns: Numbers;
  /** How many of each scan's points, its first ones, lie below the ceiling. */
  below: Numbers;
  /** xyz each, in the body frame at the scan's end [m]. */
  p: Numbers;
  /** 0..255 for 0..1. */
  intensity: Uint8Array;
}

export interface Picture {
  name: string;
  title: string;
  /** base64 of a PNG. */
  png: string;
}

/** How the robot's walk went; an invalid run says nothing of the estimators. */
export interface Robot {
  fell?: boolean | null;
  touched_wall?: boolean | null;
  valid?: boolean | null;
  invalid_reason?: string | null;
}

/** Dimensions of the robot [m]. */
export interface Body {
  /** Its trunk's centre in body axes. */
  trunk: [number, number, number];
  /** Hips ahead of the trunk's centre and behind it. */
  hip_x: number;
  /** Legs to either side of the trunk's centre. */
  leg_y: number;
  /** Of the trunk's centre over the ground. */
  height: number;
}

/** An estimator that failed; the message may have several lines. */
export interface Failure {
  estimator?: string;
  message?: string;
}

export interface RunPayload extends PagePayload {
  kind: "run";
  /** What could not be read. */
  notes?: string[] | null;
  /** Assumptions about a recording that may decide its result. */
  warnings?: string[] | null;
  /** How a recording was read, and what was left out of the estimates. */
  reading?: string[] | null;
  /** Estimators that failed. */
  failures?: Failure[] | null;
  /** Every stamp is in seconds after this one [s]. */
  t0_s?: Maybe;
  scenario: {
    name: string;
    description?: string | null;
    seed: Maybe;
    simulated_s: Maybe;
    complete: boolean | null;
    /** Does the route follow a corridor? */
    corridor?: boolean;
    robot?: Robot | null;
    body?: Body | null;
  };
  command?: string | null;
  config_yaml?: string | null;
  config_changes?: ConfigChange[] | null;
  score_list: ListedScore[];
  /** scores.json as it was written. */
  scores: Json;
  /** Estimators whose estimate lacks a part of the run (`is_partial`). */
  partial: string[];
  scene: Scene | null;
  waypoint_times: WaypointTime[] | null;
  truth: Poses | null;
  localizability: Localizability | null;
  legs: Legs | null;
  scans?: Scans | null;
  estimators: Estimator[];
  pictures: Picture[] | null;
}
