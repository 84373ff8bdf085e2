// SPDX-License-Identifier: BSD-3-Clause
/** Distances to the surfaces of a scene. */
import type { Numbers, Scene } from "../contract";

type Point = readonly [number, number, number];

const sub = (a: Point, b: Point): Point => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
const dot = (a: Point, b: Point) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];

/** Squared distance from `p` to the segment from `a` to `b`. */
function toSegment(p: Point, a: Point, b: Point): number {
  const along = sub(b, a);
  const from = sub(p, a);
  const length = dot(along, along);
  const t = length > 0 ? Math.min(Math.max(dot(from, along) / length, 0), 1) : 0;
  const rest = sub(from, [t * along[0], t * along[1], t * along[2]]);
  return dot(rest, rest);
}

/** Squared distance from `p` to the triangle `a`, `b`, `c`. */
export function toTriangle(p: Point, a: Point, b: Point, c: Point): number {
  const [u, v, w] = [sub(b, a), sub(c, a), sub(p, a)];
  const [uu, uv, vv, wu, wv] = [dot(u, u), dot(u, v), dot(v, v), dot(w, u), dot(w, v)];
  const area = uu * vv - uv * uv;
  const s = (wu * vv - wv * uv) / area;
  const t = (wv * uu - wu * uv) / area;
  if (area > 0 && s >= 0 && t >= 0 && s + t <= 1) {
    const rest: Point = [0, 1, 2].map((i) => w[i]! - s * u[i]! - t * v[i]!) as unknown as Point;
    return dot(rest, rest);
  }
  return Math.min(toSegment(p, a, b), toSegment(p, b, c), toSegment(p, c, a));
}

/** Triangles with the boxes around them. */
export class Surface {
  private readonly lists: Numbers[];

  constructor(scene: Scene) {
    this.lists = [scene.triangles, scene.roof_triangles].filter((list) => list != null);
  }

  /** Distance from a point to the nearest surface, `limit` if none is nearer [m]. */
  distance(p: Point, limit: number): number {
    let best = limit * limit;
    for (const list of this.lists) {
      for (let k = 0; k + 8 < list.length; k += 9) {
        let outside = 0;
        for (let axis = 0; axis < 3; ++axis) {
          const [a, b, c] = [list[k + axis]!, list[k + 3 + axis]!, list[k + 6 + axis]!];
          const gap = Math.max(Math.min(a, b, c) - p[axis]!, p[axis]! - Math.max(a, b, c), 0);
          outside += gap * gap;
        }
        if (outside >= best) continue;
        const corner = (i: number): Point => [list[k + i]!, list[k + i + 1]!, list[k + i + 2]!];
        best = Math.min(best, toTriangle(p, corner(0), corner(3), corner(6)));
      }
    }
    return Math.sqrt(best);
  }
}
