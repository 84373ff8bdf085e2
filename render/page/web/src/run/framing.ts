// SPDX-License-Identifier: BSD-3-Clause
/** From where a box fills a window best. */
import { Vector3 } from "three";
import type { Bounds } from "./parts3d";

/** A camera that looks along -`away` from `position` at `target`. */
export interface Shot {
  position: Vector3;
  target: Vector3;
}

/** Room around the box, as a factor. */
const kMargin = 1.04;
const kElevations = [30, 40, 50];
const kAzimuthStep = 5;
/** How much it counts against a direction that the far end is small: power of the ratio of depths. */
const kEvenness = 0.25;

function corners({ min, max }: Bounds): Vector3[] {
  return Array.from({ length: 8 }, (_, i) =>
    new Vector3(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z),
  );
}

interface Axes {
  right: Vector3;
  up: Vector3;
  away: Vector3;
}

function axesOf(azimuth: number, elevation: number): Axes {
  const away = new Vector3(
    Math.cos(elevation) * Math.cos(azimuth),
    Math.cos(elevation) * Math.sin(azimuth),
    Math.sin(elevation),
  );
  const right = new Vector3(0, 0, 1).cross(away).normalize();
  return { right, up: new Vector3().crossVectors(away, right), away };
}

/** Where the axis through the camera must lie, and how far back: min over the place of the max over points. */
function fitAlong(points: Vector3[], across: Vector3, away: Vector3, tangent: number) {
  let upper = -Infinity;
  let lower = -Infinity;
  for (const point of points) {
    const side = (kMargin * point.dot(across)) / tangent;
    upper = Math.max(upper, side + point.dot(away));
    lower = Math.max(lower, -side + point.dot(away));
  }
  return { center: (tangent * (upper - lower)) / (2 * kMargin), back: (upper + lower) / 2 };
}

function fit(points: Vector3[], axes: Axes, tangent: number, aspect: number) {
  const x = fitAlong(points, axes.right, axes.away, tangent * aspect);
  const y = fitAlong(points, axes.up, axes.away, tangent);
  return { x: x.center, y: y.center, back: Math.max(x.back, y.back) };
}

/** Area of the convex hull of points in the plane. */
function hullArea(points: [number, number][]): number {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const half = (list: [number, number][]) => {
    const hull: [number, number][] = [];
    for (const p of list) {
      for (;;) {
        const [a, b] = [hull[hull.length - 2], hull[hull.length - 1]];
        if (!a || !b) break;
        if ((b[0] - a[0]) * (p[1] - a[1]) - (b[1] - a[1]) * (p[0] - a[0]) > 0) break;
        hull.pop();
      }
      hull.push(p);
    }
    return hull.slice(0, -1);
  };
  const hull = [...half(sorted), ...half(sorted.reverse())];
  return Math.abs(
    hull.reduce((sum, [x, y], i) => {
      const [nx, ny] = hull[(i + 1) % hull.length]!;
      return sum + (x * ny - nx * y) / 2;
    }, 0),
  );
}

/**
 * The camera that sees all of the box, from the direction in which it covers most of the window without
 * its far end being much smaller than its near one.
 */
export function bestShot(box: Bounds, tangent: number, aspect: number): Shot {
  const points = corners(box);
  let best: { worth: number; axes: Axes; at: ReturnType<typeof fit> } | null = null;
  for (const elevation of kElevations) {
    for (let azimuth = -180; azimuth < 180; azimuth += kAzimuthStep) {
      const axes = axesOf((azimuth * Math.PI) / 180, (elevation * Math.PI) / 180);
      const at = fit(points, axes, tangent, aspect);
      const seen = points.map((point): [number, number] => {
        const depth = Math.max(at.back - point.dot(axes.away), 1e-6);
        return [
          (point.dot(axes.right) - at.x) / (depth * tangent * aspect),
          (point.dot(axes.up) - at.y) / (depth * tangent),
        ];
      });
      const depths = points.map((point) => at.back - point.dot(axes.away));
      const evenness = Math.max(Math.min(...depths), 0) / Math.max(...depths);
      const worth = (hullArea(seen) / 4) * evenness ** kEvenness;
      if (!best || worth > best.worth * 1.001) best = { worth, axes, at };
    }
  }
  const { axes, at } = best!;
  const middle = points.reduce((sum, point) => sum + point.dot(axes.away), 0) / points.length;
  const onAxis = (back: number) =>
    new Vector3()
      .addScaledVector(axes.right, at.x)
      .addScaledVector(axes.up, at.y)
      .addScaledVector(axes.away, back);
  return { position: onAxis(at.back), target: onAxis(middle) };
}
