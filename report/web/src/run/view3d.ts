// SPDX-License-Identifier: BSD-3-Clause
/** The 3D view: built once, drawn again only when something has changed. */
import {
  Box3, Color, Group, LineSegments, Mesh, OrthographicCamera, PerspectiveCamera, Points, Quaternion, Sprite,
  Scene as Stage, Vector3, WebGLRenderer, type Object3D,
} from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import type { RunPayload } from "../contract";
import { color, seriesColor, theme } from "../theme";
import { axisArrow, cloud, ellipsoid, ellipsoidMatrix, extend, robot, sceneParts, way, type Bounds } from "./parts3d";
import { indexAt, quaternionAt, vectorAt } from "./series";
import type { State } from "./store";

export type Preset = "orbit" | "top" | "side";

/** Can this browser draw with WebGL 2? */
export function hasWebGl(): boolean {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    context?.getExtension("WEBGL_lose_context")?.loseContext();
    return context !== null;
  } catch {
    return false;
  }
}

/** Gives back what an object holds on the graphics card. */
function dispose(object: Object3D): void {
  object.traverse((node) => {
    if (node instanceof Sprite) node.material.map?.dispose();
    if (node instanceof LineSegments || node instanceof Points || node instanceof Mesh) node.geometry.dispose();
    if ("material" in node) (node.material as { dispose(): void }).dispose();
  });
  object.removeFromParent();
}

export class View3D {
  readonly canvas: HTMLCanvasElement;
  private readonly renderer: WebGLRenderer;
  private readonly stage = new Stage();
  private readonly world = new Group();
  private readonly perspective = new PerspectiveCamera(45, 1, 0.05, 5000);
  private readonly flat = new OrthographicCamera(-1, 1, 1, -1, -5000, 5000);
  private readonly controls: OrbitControls;
  private readonly bounds: Bounds;
  private moving: { truth: ReturnType<typeof robot>; estimate: ReturnType<typeof robot>; axis: Group; cloud: Group } | null = null;
  private preset: Preset = "orbit";
  private follow = false;
  private stretch = 1;
  private pending = false;
  /** How much larger than three sigma the ellipsoid is drawn. */
  readonly ellipsoidScale: number;

  constructor(private readonly data: RunPayload, private state: Readonly<State>) {
    this.renderer = new WebGLRenderer({ antialias: true, preserveDrawingBuffer: true, powerPreference: "low-power" });
    this.canvas = this.renderer.domElement;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.stage.add(this.world);
    this.perspective.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.perspective, this.canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", () => this.draw());
    this.canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.bounds = this.extent();
    this.ellipsoidScale = this.chooseEllipsoidScale();
    this.build();
  }

  /** What the presets show: truth and scene; estimates count only near them, for lost ones run far. */
  private extent(): Bounds {
    const bounds: Bounds = { min: new Vector3(Infinity, Infinity, Infinity), max: new Vector3(-Infinity, -Infinity, -Infinity) };
    extend(bounds, this.data.scene?.edges);
    extend(bounds, this.data.truth?.p);
    if (bounds.min.x > bounds.max.x) for (const item of this.data.estimators) extend(bounds, item.series?.p);
    if (bounds.min.x > bounds.max.x) return { min: new Vector3(-1, -1, 0), max: new Vector3(1, 1, 1) };
    return bounds;
  }

  private chooseEllipsoidScale(): number {
    const list = this.data.estimators.flatMap((item) => {
      const c = item.series?.position_covariance;
      return c && c.length >= 6 ? [Math.sqrt(Math.max(c[c.length - 6]!, c[c.length - 3]!, c[c.length - 1]!))] : [];
    }).filter((sigma) => Number.isFinite(sigma) && sigma > 0);
    const sigma = list.length > 0 ? Math.max(...list) : 1;
    return [1, 10, 100].find((scale) => 3 * sigma * scale > 0.3) ?? 100;
  }

  /** Everything anew, in the colours of the theme. */
  private build(): void {
    for (const child of [...this.world.children]) dispose(child);
    this.stage.background = new Color(color("--scene"));
    if (this.data.scene) this.world.add(sceneParts(this.data.scene, color("--wire")));
    this.addCloud();
    this.addWays();
    const ink = seriesColor(this.data.estimators[this.state.chosen]?.colour_index ?? 0);
    this.moving = { truth: robot(color("--truth")), estimate: robot(ink), axis: axisArrow(color("--weak")), cloud: ellipsoid(ink) };
    this.world.add(this.moving.truth.group, this.moving.estimate.group, this.moving.axis, this.moving.cloud);
    this.move();
  }

  private addCloud(): void {
    const map = this.data.estimators[this.state.chosen]?.map;
    if (!map || !(map.n > 0)) return;
    const coloring = this.state.coloring === "error" && map.error ? "error" : "height";
    this.world.add(new Group().add(cloud(map, coloring, theme() === "dark")));
  }

  /** The chosen one and the truth are thick, and drawn last. */
  private addWays(): void {
    const { estimators, truth } = this.data;
    const add = (positions: Float32Array | null | undefined, ink: string, width: number, opacity: number) => {
      const line = positions ? way(positions, ink, width, opacity) : null;
      if (line) this.world.add(line);
    };
    estimators.forEach((item, index) => {
      if (index !== this.state.chosen) add(item.series?.p, seriesColor(item.colour_index), 1.25, 0.7);
    });
    const chosen = estimators[this.state.chosen];
    add(chosen?.series?.p, seriesColor(chosen?.colour_index ?? 0), 3, 1);
    add(truth?.p, color("--truth"), 1.5, 1);
  }

  /** Puts what stands at the cursor in its place. */
  private move(): void {
    if (!this.moving) return;
    const { truth, estimate, axis, cloud: shape } = this.moving;
    const seconds = this.state.cursor;
    const chosen = this.data.estimators[this.state.chosen];
    const truthIndex = indexAt(this.data.truth?.t, seconds);
    const here = this.place(truth.group, this.data.truth, truthIndex);
    const index = indexAt(chosen?.series?.t, seconds);
    const there = this.place(estimate.group, chosen?.series, index);
    const weak = vectorAt(this.data.localizability?.weak_axis, indexAt(this.data.localizability?.t, seconds));
    axis.visible = here !== null && weak !== null;
    if (here && weak) {
      axis.position.copy(here);
      axis.quaternion.setFromUnitVectors(new Vector3(1, 0, 0), new Vector3(...weak).normalize());
    }
    const covariance = chosen?.series?.position_covariance?.subarray(6 * index, 6 * index + 6);
    const matrix = there && index >= 0 && covariance?.length === 6
      ? ellipsoidMatrix(covariance, 3 * this.ellipsoidScale, there, estimate.group.quaternion) : null;
    shape.visible = matrix !== null;
    if (matrix) shape.matrix.copy(matrix);
    const target = here ?? there;
    if (this.follow && target) this.moveTarget(target);
    this.draw();
  }

  private place(group: Group, poses: { p: Float32Array | null; q: Float32Array | null } | null | undefined, index: number): Vector3 | null {
    const position = vectorAt(poses?.p, index);
    group.visible = position !== null;
    if (!position) return null;
    group.position.set(...position);
    group.quaternion.copy(new Quaternion(...quaternionAt(poses?.q, index)).normalize());
    return group.position;
  }

  private moveTarget(world: Vector3): void {
    const target = new Vector3(world.x, world.y, world.z * this.stretch);
    const step = target.clone().sub(this.controls.target);
    this.controls.target.copy(target);
    this.controls.object.position.add(step);
    this.controls.update();
  }

  /** Where the robot is at the cursor, world [m]; null if nowhere. */
  robotPosition(): number[] | null {
    return this.moving?.estimate.group.visible ? this.moving.estimate.group.position.toArray() : null;
  }

  update(state: Readonly<State>, rebuild: boolean): void {
    this.state = state;
    if (rebuild) this.build();
    else this.move();
  }

  setFollow(follow: boolean): void {
    this.follow = follow;
    if (follow) {
      this.controls.zoomToCursor = false;
      const target = this.moving?.truth.group.visible ? this.moving.truth.group.position : this.moving?.estimate.group.position;
      if (target) this.near(target);
    } else {
      this.controls.zoomToCursor = true;
      this.show(this.preset);
    }
  }

  /** Comes close to the robot. */
  private near(target: Vector3): void {
    this.moveTarget(target);
    const distance = this.controls.object.position.distanceTo(this.controls.target);
    if (this.controls.object === this.perspective && distance > 6) {
      this.perspective.position.sub(this.controls.target).setLength(6).add(this.controls.target);
    } else if (this.controls.object === this.flat) {
      this.flat.zoom = (this.flat.top - this.flat.bottom) / 6;
      this.flat.updateProjectionMatrix();
    }
    this.controls.update();
    this.draw();
  }

  /** Draws heights larger than they are. */
  setStretch(stretch: number): void {
    this.stretch = stretch;
    this.world.scale.z = stretch;
    this.show(this.preset);
  }

  /** Turns to one of the views, all of the run in it. */
  show(preset: Preset): void {
    this.preset = preset;
    const box = new Box3(this.bounds.min.clone(), this.bounds.max.clone());
    box.min.z *= this.stretch;
    box.max.z *= this.stretch;
    const center = box.getCenter(new Vector3());
    const size = box.getSize(new Vector3());
    const reach = Math.max(size.length(), 2);
    this.controls.target.copy(center);
    if (preset === "orbit") this.showOrbit(box, center, size);
    else this.showFlat(preset, center, size, reach);
    this.controls.enableRotate = preset === "orbit";
    this.controls.update();
    if (this.follow) this.setFollow(true);
    this.draw();
  }

  /** From the side and above, as near as all corners of the box allow. */
  private showOrbit(box: Box3, center: Vector3, size: Vector3): void {
    const longX = size.x >= size.y;
    const away = new Vector3(longX ? -0.9 : -0.4, longX ? -0.4 : -0.9, 0.45).normalize();
    const camera = this.perspective;
    const tangent = Math.tan((camera.fov * Math.PI) / 360);
    const right = new Vector3().crossVectors(new Vector3(0, 0, 1), away).normalize();
    const up = new Vector3().crossVectors(away, right);
    let distance = 1;
    for (let i = 0; i < 8; ++i) {
      const corner = new Vector3(i & 1 ? box.max.x : box.min.x, i & 2 ? box.max.y : box.min.y, i & 4 ? box.max.z : box.min.z).sub(center);
      const across = Math.max(Math.abs(corner.dot(right)) / camera.aspect, Math.abs(corner.dot(up)));
      distance = Math.max(distance, corner.dot(away) + (1.04 * across) / tangent);
    }
    camera.position.copy(center).addScaledVector(away, distance);
    this.controls.object = camera;
  }

  private showFlat(preset: Preset, center: Vector3, size: Vector3, reach: number): void {
    const longX = size.x >= size.y;
    const up = preset === "top" ? (longX ? new Vector3(0, 1, 0) : new Vector3(-1, 0, 0)) : new Vector3(0, 0, 1);
    const away = preset === "top" ? new Vector3(0, 0, 1) : longX ? new Vector3(0, -1, 0) : new Vector3(1, 0, 0);
    const width = Math.max(longX ? size.x : size.y, 1) * 1.06;
    const height = Math.max(preset === "side" ? size.z : longX ? size.y : size.x, 0.5) * 1.15;
    const aspect = this.perspective.aspect;
    const half = Math.max(height, width / aspect) / 2;
    this.flat.top = half;
    this.flat.bottom = -half;
    this.flat.left = -half * aspect;
    this.flat.right = half * aspect;
    this.flat.zoom = 1;
    this.flat.up.copy(up);
    this.flat.position.copy(center).addScaledVector(away, reach);
    this.flat.lookAt(center);
    this.flat.updateProjectionMatrix();
    this.controls.object = this.flat;
  }

  resize(width: number, height: number): void {
    if (width < 1 || height < 1) return;
    this.renderer.setSize(width, height, false);
    this.perspective.aspect = width / height;
    this.perspective.updateProjectionMatrix();
    this.show(this.preset);
  }

  /** Draws in the next frame. */
  draw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.sizeRings();
      this.renderer.render(this.stage, this.controls.object);
    });
  }

  /** Rings of about eleven pixels, gone where the robot itself is larger; an axis that is not lost in a long corridor. */
  private sizeRings(): void {
    if (!this.moving) return;
    const pixel = 1 / (this.canvas.clientHeight || 1);
    const flat = this.controls.object === this.flat;
    const tangent = 2 * Math.tan((this.perspective.fov * Math.PI) / 360);
    const flatSize = (this.flat.top - this.flat.bottom) / this.flat.zoom;
    const ring = 22 * pixel * (flat ? flatSize : tangent);
    const here = this.world.localToWorld(this.moving.estimate.group.position.clone());
    const away = flat ? flatSize : tangent * here.distanceTo(this.perspective.position);
    for (const { ring: sprite } of [this.moving.truth, this.moving.estimate]) {
      sprite.scale.set(ring, ring, 1);
      sprite.visible = 30 * pixel * away > 0.6;
    }
    this.moving.axis.scale.setScalar(Math.max(1, 34 * pixel * away));
  }
}
