// SPDX-License-Identifier: BSD-3-Clause
/** Where the 3D view is seen from: presets, following the robot, sizes on the screen. */
import { Box3, OrthographicCamera, PerspectiveCamera, Vector3, type Camera } from "three";
import { OrbitControls } from "three/examples/jsm/controls/OrbitControls.js";
import { bestShot } from "./framing";
import type { Bounds } from "./parts3d";
import type { Preset } from "./store";

/** How far from the robot the camera follows [m]. */
const kNear = 6;
/** By how much more a flat view draws what lies across, at most. */
const kMostStretch = 12;

/**
 * Half the sides of a flat view [m] that shows `width` by `height` in a window of that aspect, and by
 * how much what lies across is drawn larger, so that a long corridor fills its window.
 */
export function flatSides(width: number, height: number, aspect: number, stretches: boolean): {
  x: number; y: number; stretch: number;
} {
  const x = Math.max(width, height * aspect) / 2;
  const y = stretches ? Math.max(height / 2, x / aspect / kMostStretch) : x / aspect;
  return { x, y, stretch: x / aspect / y };
}

export class CameraRig {
  private readonly perspective = new PerspectiveCamera(45, 1, 0.05, 5000);
  private readonly flat = new OrthographicCamera(-1, 1, 1, -1, -5000, 5000);
  private readonly controls: OrbitControls;
  private preset: Preset = "orbit";
  private follows = false;
  /** Heights are drawn so many times larger. */
  heightScale = 1;
  /** May flat views stretch what lies across? */
  stretches = true;
  /** By how much the view shown stretches it. */
  stretch = 1;

  /** Calls `changed` when the reader moves the camera; `bounds` is what the presets show [m]. */
  constructor(
    canvas: HTMLCanvasElement,
    private readonly bounds: Bounds,
    changed: () => void,
  ) {
    this.perspective.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.perspective, canvas);
    this.controls.zoomToCursor = true;
    this.controls.addEventListener("change", changed);
  }

  get camera(): Camera {
    return this.controls.object;
  }

  /** Height of the window, where `world` lies [m]. */
  heightAt(world: Vector3): number {
    if (this.controls.object === this.flat)
      return (this.flat.top - this.flat.bottom) / this.flat.zoom;
    return this.angle() * world.distanceTo(this.perspective.position);
  }

  /** Height of the window as a scale of sprites that keep their size. */
  spriteHeight(): number {
    if (this.controls.object === this.flat)
      return (this.flat.top - this.flat.bottom) / this.flat.zoom;
    return this.angle();
  }

  private angle(): number {
    return 2 * Math.tan((this.perspective.fov * Math.PI) / 360);
  }

  /** Keeps beside `target` from now on, or goes back to the preset. */
  follow(follows: boolean, target: Vector3 | null): void {
    this.follows = follows;
    this.controls.zoomToCursor = !follows;
    if (!follows || this.stretch !== 1) this.show(this.preset, follows ? target : null);
    else if (target) this.approach(target);
  }

  /** Goes with the robot if it follows. */
  track(world: Vector3): void {
    if (!this.follows) return;
    const target = new Vector3(world.x, world.y, world.z * this.heightScale);
    const step = target.clone().sub(this.controls.target);
    this.controls.target.copy(target);
    this.controls.object.position.add(step);
    this.controls.update();
  }

  private approach(target: Vector3): void {
    this.track(target);
    const offset = this.controls.object.position.clone().sub(this.controls.target);
    if (this.controls.object === this.perspective && offset.length() > kNear) {
      this.perspective.position.copy(this.controls.target).add(offset.setLength(kNear));
    } else if (this.controls.object === this.flat) {
      this.flat.zoom = (this.flat.top - this.flat.bottom) / kNear;
      this.flat.updateProjectionMatrix();
    }
    this.controls.update();
  }

  /** Turns to one of the views, all of the run in it, or near `target` while it follows. */
  show(preset: Preset, target: Vector3 | null): void {
    this.preset = preset;
    const box = new Box3(this.bounds.min.clone(), this.bounds.max.clone());
    box.min.z *= this.heightScale;
    box.max.z *= this.heightScale;
    const center = box.getCenter(new Vector3());
    this.controls.target.copy(center);
    this.stretch = 1;
    if (preset === "orbit") this.showOrbit(box);
    else this.showFlat(preset, box, center);
    this.controls.enableRotate = preset === "orbit";
    this.controls.update();
    if (this.follows && target) this.approach(target);
  }

  /** From where the box fills the window best. */
  private showOrbit(box: Box3): void {
    const camera = this.perspective;
    const shot = bestShot(box, Math.tan((camera.fov * Math.PI) / 360), camera.aspect);
    camera.position.copy(shot.position);
    this.controls.target.copy(shot.target);
    this.controls.object = camera;
  }

  private showFlat(preset: Preset, box: Box3, center: Vector3): void {
    const size = box.getSize(new Vector3());
    const reach = Math.max(size.length(), 2);
    // The longer side of the plan lies along the longer side of the window.
    const longX = size.x >= size.y === (preset === "side" || this.perspective.aspect >= 1);
    const up =
      preset === "top"
        ? longX
          ? new Vector3(0, 1, 0)
          : new Vector3(-1, 0, 0)
        : new Vector3(0, 0, 1);
    const away =
      preset === "top"
        ? new Vector3(0, 0, 1)
        : longX
          ? new Vector3(0, -1, 0)
          : new Vector3(1, 0, 0);
    const width = Math.max(longX ? size.x : size.y, 1) * 1.12;
    const height = Math.max(preset === "side" ? size.z : longX ? size.y : size.x, 0.5) * 1.5;
    const half = flatSides(width, height, this.perspective.aspect, this.stretches && !this.follows);
    this.stretch = half.stretch;
    this.flat.top = half.y;
    this.flat.bottom = -half.y;
    this.flat.left = -half.x;
    this.flat.right = half.x;
    this.flat.zoom = 1;
    this.flat.up.copy(up);
    this.flat.position.copy(center).addScaledVector(away, reach);
    this.flat.lookAt(center);
    this.flat.updateProjectionMatrix();
    this.controls.object = this.flat;
  }

  setAspect(aspect: number, target: Vector3 | null): void {
    this.perspective.aspect = aspect;
    this.perspective.updateProjectionMatrix();
    this.show(this.preset, target);
  }
}
