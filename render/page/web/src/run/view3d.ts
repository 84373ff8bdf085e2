// SPDX-License-Identifier: BSD-3-Clause
/** The 3D view: built once, drawn again only when something has changed. */
import {
  Color,
  Group,
  LineSegments,
  Mesh,
  Points,
  Quaternion,
  Sprite,
  Scene as Stage,
  Vector3,
  WebGLRenderer,
  type Object3D,
} from "three";
import type { RunPayload } from "../contract";
import { color, seriesColor, theme } from "../theme";
import { Axes3D } from "./axes3d";
import { CameraRig } from "./camera3d";
import {
  axisArrow,
  coloredPoints,
  cloud,
  ellipsoid,
  ellipsoidMatrix,
  extend,
  robot,
  person,
  personAt,
  sceneParts,
  tube,
  type Bounds,
  type Tube,
} from "./parts3d";
import { ramp, rampTable } from "./ramps";
import type { ScanPlacer } from "./scan";
import { indexAt, quaternionAt, vectorAt } from "./series";
import type { Preset, State } from "./store";

/** How this browser draws with WebGL 2: on a graphics card, in software, or not at all. */
export function webGlKind(): "card" | "software" | null {
  try {
    const context = document.createElement("canvas").getContext("webgl2");
    if (!context) return null;
    const info = context.getExtension("WEBGL_debug_renderer_info");
    const name = info ? String(context.getParameter(info.UNMASKED_RENDERER_WEBGL)) : "";
    context.getExtension("WEBGL_lose_context")?.loseContext();
    return /swiftshader|llvmpipe|software/i.test(name) ? "software" : "card";
  } catch {
    return null;
  }
}

/** Gives back what an object holds on the graphics card. */
function dispose(object: Object3D): void {
  object.traverse((node) => {
    if (node instanceof Sprite) node.material.map?.dispose();
    if (node instanceof LineSegments || node instanceof Points || node instanceof Mesh)
      node.geometry.dispose();
    if ("material" in node) (node.material as { dispose(): void }).dispose();
  });
  object.removeFromParent();
}

/** Of the scene no more is shown at first than lies so near to the walked path [m]. */
const kAround = 6;

/** What the presets show: the truth and the scene around it; estimates only without these, since diverged ones run far. */
function extent(data: RunPayload): Bounds {
  const empty = (): Bounds => ({
    min: new Vector3(Infinity, Infinity, Infinity),
    max: new Vector3(-Infinity, -Infinity, -Infinity),
  });
  const scene = empty();
  extend(scene, data.scene?.edges);
  const path = empty();
  extend(path, data.truth?.p);
  if (path.min.x > path.max.x && scene.min.x > scene.max.x)
    for (const item of data.estimators) extend(path, item.series?.p);
  if (path.min.x > path.max.x) {
    return scene.min.x <= scene.max.x
      ? scene
      : { min: new Vector3(-1, -1, 0), max: new Vector3(1, 1, 1) };
  }
  if (scene.min.x > scene.max.x) return path;
  const around = new Vector3(kAround, kAround, kAround);
  return {
    min: scene.min.clone().max(path.min.clone().sub(around)).min(path.min),
    max: scene.max.clone().min(path.max.clone().add(around)).max(path.max),
  };
}

/** Power of ten that makes the largest last ellipsoid visible beside the robot. */
function chooseEllipsoidScale(data: RunPayload): number {
  const list = data.estimators
    .flatMap((item) => {
      const c = item.series?.position_covariance;
      return c && c.length >= 6
        ? [Math.sqrt(Math.max(c[c.length - 6]!, c[c.length - 3]!, c[c.length - 1]!))]
        : [];
    })
    .filter((sigma) => Number.isFinite(sigma) && sigma > 0);
  const sigma = list.length > 0 ? Math.max(...list) : 1;
  return [1, 10, 100].find((scale) => 3 * sigma * scale > 0.3) ?? 100;
}

export class View3D {
  readonly canvas: HTMLCanvasElement;
  private readonly renderer: WebGLRenderer;
  private readonly stage = new Stage();
  private readonly world = new Group();
  private readonly rig: CameraRig;
  private readonly bounds: Bounds;
  /** Axes over the canvas. */
  readonly axes = new Axes3D();
  private moving: {
    truth: ReturnType<typeof robot>;
    estimate: ReturnType<typeof robot>;
    axis: Group;
    cloud: Group;
    people: Group[];
  } | null = null;
  private scan: Points | null = null;
  private tubes: { tube: Tube; pixels: number; radius: number }[] = [];
  private preset: Preset = "orbit";
  private pending = false;
  /** How much larger than three sigma the ellipsoid is drawn. */
  readonly ellipsoidScale: number;

  /** `smooth`: edges without steps, four times the work where there is no graphics card. */
  constructor(
    private readonly data: RunPayload,
    private state: Readonly<State>,
    private readonly placer: ScanPlacer,
    smooth: boolean,
  ) {
    this.renderer = new WebGLRenderer({
      antialias: smooth,
      preserveDrawingBuffer: true,
      powerPreference: "low-power",
    });
    this.canvas = this.renderer.domElement;
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.stage.add(this.world);
    this.bounds = extent(data);
    this.rig = new CameraRig(this.canvas, this.bounds, () => this.draw());
    this.preset = state.preset;
    this.rig.show(state.preset, null);
    this.canvas.addEventListener("webglcontextrestored", () => this.draw());
    this.ellipsoidScale = chooseEllipsoidScale(data);
    this.build();
  }

  /** Everything anew, in the colours of the theme. */
  private build(): void {
    for (const child of [...this.world.children]) dispose(child);
    this.stage.background = new Color(color("--scene"));
    if (this.data.scene) this.world.add(sceneParts(this.data.scene, color("--wire"), this.state.ceiling));
    this.addCloud();
    this.addTrajectories();
    const ink = seriesColor(this.data.estimators[this.state.chosen]?.colour_index ?? 0);
    this.moving = {
      truth: robot(color("--truth"), this.data.scenario.body),
      estimate: robot(ink, this.data.scenario.body),
      axis: axisArrow(color("--weak")),
      cloud: ellipsoid(ink),
      people: (this.data.scene?.people ?? []).map((each) => person(each, color("--person"))),
    };
    this.world.add(
      this.moving.truth.group,
      this.moving.estimate.group,
      this.moving.axis,
      this.moving.cloud,
      ...this.moving.people,
    );
    this.scan = null;
    this.move();
  }

  private addCloud(): void {
    const map = this.data.estimators[this.state.chosen]?.map;
    if (!map || !(map.n > 0)) return;
    const coloring = this.state.coloring === "error" && map.error ? "error" : "height";
    this.world.add(new Group().add(cloud(map, coloring, theme() === "dark", this.state.ceiling)));
  }

  /** The chosen one and the truth are thick, and drawn last. */
  private addTrajectories(): void {
    const { estimators, truth } = this.data;
    this.tubes = [];
    const add = (
      positions: Float32Array | null | undefined,
      ink: string,
      pixels: number,
      radius: number,
      opacity: number,
    ) => {
      const made = positions ? tube(positions, ink, color("--scene"), opacity) : null;
      if (!made) return;
      this.world.add(made.group);
      this.tubes.push({ tube: made, pixels, radius });
    };
    estimators.forEach((item, index) => {
      if (index !== this.state.chosen && !this.state.hidden.has(index))
        add(item.series?.p, seriesColor(item.colour_index), 1.5, 0.01, 0.6);
    });
    const chosen = estimators[this.state.chosen];
    add(chosen?.series?.p, seriesColor(chosen?.colour_index ?? 0), 4, 0.03, 1);
    add(truth?.p, color("--truth"), 2, 0.015, 1);
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
    const weak = vectorAt(
      this.data.localizability?.weak_axis,
      indexAt(this.data.localizability?.t, seconds),
    );
    axis.visible = here !== null && weak !== null;
    if (here && weak) {
      axis.position.copy(here);
      axis.quaternion.setFromUnitVectors(new Vector3(1, 0, 0), new Vector3(...weak).normalize());
    }
    const covariance = chosen?.series?.position_covariance?.subarray(6 * index, 6 * index + 6);
    const matrix =
      there && index >= 0 && covariance?.length === 6
        ? ellipsoidMatrix(covariance, 3 * this.ellipsoidScale, there, estimate.group.quaternion)
        : null;
    shape.visible = matrix !== null;
    if (matrix) shape.matrix.copy(matrix);
    const simulated = seconds + (this.data.t0_s ?? 0);
    this.data.scene?.people?.forEach((each, i) => {
      this.moving!.people[i]?.position.set(...personAt(each, simulated), each.ground ?? 0);
    });
    this.showScan();
    const target = here ?? there;
    if (target) this.rig.track(target);
    this.draw();
  }

  /** Draws the scan at the cursor, over the map. */
  private showScan(): void {
    if (this.scan) dispose(this.scan);
    this.scan = null;
    const placed = this.placer.place(this.state);
    if (!placed || placed.values.length === 0) return;
    const kind = this.state.scanColoring === "residual" ? "error" : "scan";
    const fractions = placed.values.map((value) => value / placed.high);
    this.scan = coloredPoints(placed.p, fractions, rampTable(ramp(kind, theme() === "dark")), 3.5);
    this.scan.renderOrder = 1;
    this.world.add(this.scan);
  }

  private place(
    group: Group,
    poses: { p: Float32Array | null; q: Float32Array | null } | null | undefined,
    index: number,
  ): Vector3 | null {
    const position = vectorAt(poses?.p, index);
    group.visible = position !== null;
    if (!position) return null;
    group.position.set(...position);
    group.quaternion.copy(new Quaternion(...quaternionAt(poses?.q, index)).normalize());
    return group.position;
  }

  update(state: Readonly<State>, rebuild: boolean): void {
    this.state = state;
    if (rebuild) this.build();
    else this.move();
  }

  /** Where the robot is, world [m]; null if nowhere. */
  private target(): Vector3 | null {
    const robots = [this.moving?.truth.group, this.moving?.estimate.group];
    return robots.find((group) => group?.visible)?.position ?? null;
  }

  /** By how much more than along it the view draws what lies across. */
  get stretch(): number {
    return this.rig.stretch;
  }

  /** Lets flat views stretch what lies across, or shows all at one scale. */
  setStretches(stretches: boolean): void {
    this.rig.stretches = stretches;
    this.rig.show(this.preset, this.target());
    this.draw();
  }

  follow(follows: boolean): void {
    this.rig.follow(follows, this.target());
    this.draw();
  }

  /** Draws heights so many times larger. */
  setHeightScale(scale: number): void {
    this.rig.heightScale = scale;
    this.world.scale.z = scale;
    this.rig.show(this.preset, this.target());
    this.draw();
  }

  /** Turns to one of the views. */
  show(preset: Preset): void {
    this.preset = preset;
    this.rig.show(preset, this.target());
    this.draw();
  }

  resize(width: number, height: number): void {
    if (width < 1 || height < 1) return;
    this.renderer.setSize(width, height, false);
    this.rig.setAspect(width / height, this.target());
    this.draw();
  }

  /** Draws in the next frame. */
  draw(): void {
    if (this.pending) return;
    this.pending = true;
    requestAnimationFrame(() => {
      this.pending = false;
      this.sizeMarks();
      this.renderer.render(this.stage, this.rig.camera);
      this.axes.draw(this.rig.camera, this.bounds, this.preset, this.rig.heightScale,
        this.canvas.clientWidth, this.canvas.clientHeight);
    });
  }

  /** Rings of eleven pixels, gone where the robot is larger; an axis that stays in sight. */
  private sizeMarks(): void {
    if (!this.moving) return;
    const pixel = 1 / (this.canvas.clientHeight || 1);
    const here = this.world.localToWorld(this.moving.estimate.group.position.clone());
    const metres = pixel * this.rig.heightAt(here);
    const ring = 22 * pixel * this.rig.spriteHeight();
    for (const { ring: sprite } of [this.moving.truth, this.moving.estimate]) {
      sprite.scale.set(ring * this.rig.stretch, ring, 1);
      sprite.visible = 30 * metres > 0.6;
    }
    this.moving.axis.scale.setScalar(Math.max(1, 34 * metres));
    for (const { tube: each, pixels, radius } of this.tubes)
      each.setWidth(Math.min(Math.max(pixels, (2 * radius) / metres), 8 * pixels));
  }
}
