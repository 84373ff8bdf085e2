// SPDX-License-Identifier: BSD-3-Clause
/** Things of the 3D view: scene, cloud, trajectories, robot, axis, ellipsoid. World axes, z up, metres. */
import {
  BoxGeometry,
  BufferAttribute,
  BufferGeometry,
  CanvasTexture,
  ConeGeometry,
  CylinderGeometry,
  DoubleSide,
  EdgesGeometry,
  Group,
  LineBasicMaterial,
  LineSegments,
  Matrix4,
  Mesh,
  MeshBasicMaterial,
  Points,
  PointsMaterial,
  Quaternion,
  SphereGeometry,
  Sprite,
  SpriteMaterial,
  Vector3,
  type ColorRepresentation,
} from "three";
import { LineMaterial } from "three/examples/jsm/lines/LineMaterial.js";
import { LineSegments2 } from "three/examples/jsm/lines/LineSegments2.js";
import { LineSegmentsGeometry } from "three/examples/jsm/lines/LineSegmentsGeometry.js";
import type { Body, CloudMap, Numbers, Person, Scene } from "../contract";
import { ramp, rampTable } from "./ramps";

export type Bounds = { min: Vector3; max: Vector3 };

/** Takes the finite points of a list of xyz into the bounds. */
export function extend(bounds: Bounds, list: Numbers | null | undefined): void {
  const point = new Vector3();
  for (let i = 0; list && i + 2 < list.length; i += 3) {
    point.set(list[i]!, list[i + 1]!, list[i + 2]!);
    if (!Number.isFinite(point.x + point.y + point.z)) continue;
    bounds.min.min(point);
    bounds.max.max(point);
  }
}

function geometry(list: Float32Array): BufferGeometry {
  return new BufferGeometry().setAttribute("position", new BufferAttribute(list, 3));
}

/** Faint wire and fainter surfaces of the scene, with its ceiling or without. */
export function sceneParts(scene: Scene, wire: ColorRepresentation, ceiling: boolean): Group {
  const group = new Group();
  const surfaces = (list: Numbers | null | undefined, opacity: number) => {
    if (!list?.length) return;
    const material = new MeshBasicMaterial({
      color: wire,
      transparent: true,
      opacity,
      side: DoubleSide,
      depthWrite: false,
    });
    group.add(new Mesh(geometry(list), material));
  };
  const lines = (list: Numbers | null | undefined) => {
    if (!list?.length) return;
    const material = new LineBasicMaterial({ color: wire, transparent: true, opacity: 0.5 });
    group.add(new LineSegments(geometry(list), material));
  };
  surfaces(scene.triangles, 0.09);
  lines(scene.edges);
  if (ceiling) {
    surfaces(scene.roof_triangles, 0.09);
    lines(scene.roof_edges);
  }
  return group;
}

/** Where a person stands at a time of the simulation [m]. */
export function personAt(person: Person, seconds: number): [number, number] {
  const along = [person.to[0] - person.from[0], person.to[1] - person.from[1]] as const;
  const half = 0.5 * (person.turn ?? 0);
  const length = Math.hypot(...along) * (half === 0 ? 1 : half / Math.sin(half));
  if (!(length > 0)) return person.from;
  const walked = (person.start + person.speed * seconds) % (2 * length);
  const fraction = (walked > length ? 2 * length - walked : walked) / length;
  const angle = half * (fraction - 1); // of the chord walked, against the whole one
  const part = half === 0 ? fraction : Math.sin(half * fraction) / Math.sin(half);
  const [cos, sin] = [part * Math.cos(angle), part * Math.sin(angle)];
  return [
    person.from[0] + cos * along[0] - sin * along[1],
    person.from[1] + sin * along[0] + cos * along[1],
  ];
}

/** An upright cylinder with its outline, standing on the floor. */
export function person({ radius, height }: Person, ink: ColorRepresentation): Group {
  const group = new Group();
  const shape = new CylinderGeometry(radius, radius, height, 20)
    .rotateX(Math.PI / 2)
    .translate(0, 0, height / 2);
  const faces = new MeshBasicMaterial({ color: ink, transparent: true, opacity: 0.45 });
  const edges = new LineBasicMaterial({ color: ink });
  group.add(new Mesh(shape, faces), new LineSegments(new EdgesGeometry(shape, 30), edges));
  return group;
}

/** Points of a map that are shown: all, or those below the ceiling. */
export function shownPoints(map: CloudMap, ceiling: boolean): number {
  return ceiling ? map.n : Math.min(map.below ?? map.n, map.n);
}

/** Heights [m] between which a map's colours run: all but two percent at either end. */
export function heightRange(map: CloudMap, ceiling: boolean): [number, number] {
  const count = shownPoints(map, ceiling);
  const heights = Float32Array.from({ length: count }, (_, i) => map.p[3 * i + 2]!).sort();
  const pick = (fraction: number) =>
    heights[Math.min(count - 1, Math.floor(fraction * count))] ?? 0;
  return [pick(0.02), pick(0.98)];
}

/** Points of a map coloured by height or by error. */
export function cloud(
  map: CloudMap,
  coloring: "height" | "error",
  dark: boolean,
  ceiling: boolean,
): Points {
  const count = shownPoints(map, ceiling);
  const [low, high] = heightRange(map, ceiling);
  const fractions = Float32Array.from({ length: count }, (_, i) =>
    coloring === "error"
      ? (map.error?.[i] ?? 0) / 255
      : (map.p[3 * i + 2]! - low) / (high - low || 1),
  );
  return coloredPoints(map.p.subarray(0, 3 * count), fractions, rampTable(ramp(coloring, dark)), 2);
}

/** Points with colours of a ramp; `pixels`: their size. */
export function coloredPoints(
  positions: Numbers,
  fractions: ArrayLike<number>,
  table: Uint8Array,
  pixels: number,
): Points {
  const colors = new Uint8Array(positions.length);
  for (let i = 0; i < fractions.length; ++i) {
    const index = 3 * Math.round(255 * Math.min(Math.max(fractions[i]!, 0), 1));
    colors.set(table.subarray(index, index + 3), 3 * i);
  }
  const points = geometry(positions).setAttribute("color", new BufferAttribute(colors, 3, true));
  return new Points(
    points,
    new PointsMaterial({ size: pixels, sizeAttenuation: false, vertexColors: true }),
  );
}

/** A trajectory as a tube with a rim, broken where a pose has no value. */
export interface Tube {
  group: Group;
  /** Makes it so many pixels wide. */
  setWidth: (pixels: number) => void;
}

/** Null without any two poses in a row. */
export function tube(
  positions: Numbers,
  ink: ColorRepresentation,
  rim: ColorRepresentation,
  opacity: number,
): Tube | null {
  const pairs: number[] = [];
  for (let i = 3; i + 2 < positions.length; i += 3) {
    const pair = Array.from(positions.subarray(i - 3, i + 3));
    if (pair.every(Number.isFinite)) pairs.push(...pair);
  }
  if (pairs.length === 0) return null;
  const shape = new LineSegmentsGeometry().setPositions(pairs);
  const line = (color: ColorRepresentation, order: number) => {
    const material = new LineMaterial({ color, transparent: true, opacity, depthTest: false });
    const part = new LineSegments2(shape, material);
    part.renderOrder = order;
    return part;
  };
  const parts = [line(rim, 1.9), line(ink, 2)] as const;
  return {
    group: new Group().add(...parts),
    setWidth: (pixels) => {
      parts[0].material.linewidth = pixels + 2;
      parts[1].material.linewidth = pixels;
    },
  };
}

/** Ring that keeps its size on the screen, to find half a metre of robot in a hundred. */
function marker(ink: string): Sprite {
  const canvas = document.createElement("canvas");
  canvas.width = canvas.height = 64;
  const context = canvas.getContext("2d")!;
  context.strokeStyle = ink;
  context.lineWidth = 7;
  context.beginPath();
  context.arc(32, 32, 26, 0, 2 * Math.PI);
  context.stroke();
  const sprite = new Sprite(
    new SpriteMaterial({
      map: new CanvasTexture(canvas),
      sizeAttenuation: false,
      depthTest: false,
    }),
  );
  sprite.renderOrder = 5;
  return sprite;
}

/** Of the robot in recordings without a scenario: the default one of the simulation. */
const USUAL_BODY: Body = { trunk: [0.17, 0, -0.02], hip_x: 0.188, leg_y: 0.127, height: 0.29 };

/** Trunk with head and legs, body axes. */
export function robot(ink: string, body: Body | null | undefined): { group: Group; ring: Sprite } {
  const group = new Group();
  const faces = new MeshBasicMaterial({
    color: ink,
    transparent: true,
    opacity: 0.2,
    depthTest: false,
  });
  const edges = new LineBasicMaterial({ color: ink, depthTest: false });
  const box = (length: number, width: number, height: number, x: number, y: number, z: number) => {
    const shape = new BoxGeometry(length, width, height).translate(x, y, z);
    const solid = new Mesh(shape, faces);
    const outline = new LineSegments(new EdgesGeometry(shape), edges);
    solid.renderOrder = 3;
    outline.renderOrder = 4;
    group.add(solid, outline);
  };
  const { trunk, hip_x, leg_y, height } = body ?? USUAL_BODY;
  const [x, y, z] = trunk;
  const thickness = 0.4 * height;
  box(2.9 * hip_x, 1.9 * leg_y, thickness, x, y, z);
  box(0.65 * hip_x, leg_y, 0.8 * thickness, x + 1.75 * hip_x, y, z + 0.1 * height);
  const leg = height - 0.2 * thickness;
  for (const [ahead, left] of [
    [1, 1],
    [1, -1],
    [-1, 1],
    [-1, -1],
  ] as const)
    box(0.15 * height, 0.15 * height, leg, x + ahead * hip_x, y + left * leg_y, z - height + leg / 2);
  const ring = marker(ink);
  group.add(ring);
  return { group, ring };
}

/** Arrow with two heads along x, from -1 to 1. */
export function axisArrow(ink: ColorRepresentation): Group {
  const group = new Group();
  const material = new MeshBasicMaterial({ color: ink, depthTest: false });
  const shapes = [
    new CylinderGeometry(0.025, 0.025, 1.6, 8).rotateZ(Math.PI / 2),
    new ConeGeometry(0.09, 0.3, 12).rotateZ(-Math.PI / 2).translate(0.85, 0, 0),
    new ConeGeometry(0.09, 0.3, 12).rotateZ(Math.PI / 2).translate(-0.85, 0, 0),
  ];
  for (const shape of shapes) {
    const part = new Mesh(shape, material);
    part.renderOrder = 6;
    group.add(part);
  }
  return group;
}

/** Unit sphere that `shapeEllipsoid` turns into an ellipsoid. */
export function ellipsoid(ink: ColorRepresentation): Group {
  const group = new Group();
  const shape = new SphereGeometry(1, 24, 16);
  const solid = new Mesh(
    shape,
    new MeshBasicMaterial({
      color: ink,
      transparent: true,
      opacity: 0.22,
      depthWrite: false,
      depthTest: false,
    }),
  );
  const net = new LineSegments(
    new EdgesGeometry(new SphereGeometry(1, 12, 8), 1),
    new LineBasicMaterial({ color: ink, transparent: true, opacity: 0.6, depthTest: false }),
  );
  solid.renderOrder = 3;
  net.renderOrder = 4;
  group.add(solid, net);
  group.matrixAutoUpdate = false;
  return group;
}

/**
 * Matrix of the ellipsoid x' C^-1 x = scale^2 of a covariance in body axes (xx xy xz yy yz zz):
 * R L with C = L L', so that no eigenvectors are needed. Null if C is not a covariance.
 */
export function ellipsoidMatrix(
  c: ArrayLike<number>,
  scale: number,
  at: Vector3,
  turn: Quaternion,
): Matrix4 | null {
  const [xx, xy, xz, yy, yz, zz] = Array.from(c) as [
    number,
    number,
    number,
    number,
    number,
    number,
  ];
  const floor = 1e-12;
  if (![xx, xy, xz, yy, yz, zz].every(Number.isFinite) || xx < 0 || yy < 0 || zz < 0) return null;
  const a = Math.sqrt(Math.max(xx, floor));
  const b = xy / a,
    d = xz / a;
  const e = Math.sqrt(Math.max(yy - b * b, floor));
  const f = (yz - b * d) / e;
  const g = Math.sqrt(Math.max(zz - d * d - f * f, floor));
  const root = new Matrix4().set(a, 0, 0, 0, b, e, 0, 0, d, f, g, 0, 0, 0, 0, 1);
  return new Matrix4().compose(at, turn, new Vector3(scale, scale, scale)).multiply(root);
}
