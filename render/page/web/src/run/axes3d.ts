// SPDX-License-Identifier: BSD-3-Clause
/** Axes over the 3D view: two edges of its box with ticks [m], drawn over the canvas. */
import { Vector3, type Camera } from "three";
import { axis } from "../charts/axis";
import { svg } from "../charts/svg";
import type { Bounds } from "./parts3d";
import type { Preset } from "./store";

/** An edge of the box along one axis. */
interface Ruler {
  name: "x" | "y" | "z";
  from: Vector3;
  to: Vector3;
}

/** The edges that a view shows: along its picture's sides, in the orbit those on the floor. */
function rulers({ min, max }: Bounds, preset: Preset, longX: boolean): Ruler[] {
  const corner = new Vector3(min.x, min.y, min.z);
  const ruler = (name: "x" | "y" | "z", x: number, y: number, z: number): Ruler =>
    ({ name, from: corner, to: new Vector3(x, y, z) });
  const x = ruler("x", max.x, min.y, min.z);
  const y = ruler("y", min.x, max.y, min.z);
  const z = ruler("z", min.x, min.y, max.z);
  if (preset === "side") return longX ? [x, z] : [y, z];
  return [x, y];
}

/** Least room of a tick on the screen, and width of an axis's name [px]. */
const kRoom = 46;
const kName = 38;

/** The name stands beyond the end of its axis; where that is outside the picture, above or below it. */
function nameAt([x, y]: [number, number], upright: boolean, width: number) {
  if (upright) {
    return x > kName ? { x: x - 6, y: y - 12, "text-anchor": "end" } : { x: 2, y: y - 12, "text-anchor": "start" };
  }
  return x + kName < width ? { x: x + 4, y: y + 4, "text-anchor": "start" } : { x: width - 2, y: y + 30, "text-anchor": "end" };
}

export class Axes3D {
  readonly element = svg("svg", { class: "axes-3d", "aria-hidden": "true" });

  /** `heightScale`: heights are drawn so many times larger; sizes of the canvas [px]. */
  draw(camera: Camera, bounds: Bounds, preset: Preset, heightScale: number, width: number, height: number): void {
    this.element.setAttribute("viewBox", `0 0 ${width} ${height}`);
    camera.updateMatrixWorld();
    const longX = bounds.max.x - bounds.min.x >= bounds.max.y - bounds.min.y;
    const screen = (point: Vector3): [number, number] | null => {
      const p = new Vector3(point.x, point.y, point.z * heightScale).project(camera);
      return p.z > 1 || p.z < -1 ? null : [((p.x + 1) / 2) * width, ((1 - p.y) / 2) * height];
    };
    this.element.replaceChildren(...rulers(bounds, preset, longX).flatMap((each) => this.ruler(each, screen, width)));
  }

  private ruler({ name, from, to }: Ruler, screen: (point: Vector3) => [number, number] | null, width: number): SVGElement[] {
    const a = screen(from);
    const b = screen(to);
    if (!a || !b) return [];
    const length = Math.hypot(b[0] - a[0], b[1] - a[1]);
    if (length < kRoom) return [];
    const low = from[name];
    const high = to[name];
    const upright = Math.abs(b[1] - a[1]) > Math.abs(b[0] - a[0]);
    const parts: SVGElement[] = [svg("line", { x1: a[0], y1: a[1], x2: b[0], y2: b[1] })];
    for (const tick of axis([low, high], false, Math.max(1, Math.floor(length / kRoom))).ticks) {
      const point = from.clone();
      point[name] = tick.value;
      const at = screen(point);
      if (!at) continue;
      const aside = upright ? { x: at[0] - 6, y: at[1] + 4, "text-anchor": "end" } : { x: at[0], y: at[1] + 15, "text-anchor": "middle" };
      parts.push(svg("circle", { cx: at[0], cy: at[1], r: 1.8 }), svg("text", aside, tick.label));
    }
    parts.push(svg("text", { class: "axis-name", ...nameAt(b, upright, width) }, `${name} [m]`));
    return parts;
  }
}
