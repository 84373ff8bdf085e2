// SPDX-License-Identifier: BSD-3-Clause
// Arithmetic of the 3D view, without a browser.
import assert from "node:assert/strict";
import { mkdtemp, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";
import { generator } from "./made_run.mjs";

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = path.resolve(process.env.AIMS_PAGE_MODULES ?? path.join(here, "../node_modules"));
let folder;
let geometry;

before(async () => {
  folder = await mkdtemp(path.join(os.tmpdir(), "aims-geometry-"));
  const outfile = path.join(folder, "geometry.mjs");
  const { build } = createRequire(path.join(modules, "any.js"))("esbuild");
  await build({
    stdin: {
      contents: ["framing", "parts3d", "surface"].map((name) => `export * from "./src/run/${name}";`).join("\n"),
      resolveDir: path.join(here, ".."),
    },
    nodePaths: [modules],
    bundle: true,
    format: "esm",
    logLevel: "error",
    outfile,
  });
  geometry = await import(pathToFileURL(outfile).href);
});
after(() => rm(folder, { recursive: true }));

/** Largest |x| and |y| of the corners of a box in a window, 1 at its edge. */
function reach(shot, { min, max }, tangent, aspect) {
  const away = shot.position.clone().sub(shot.target).normalize();
  const right = away.clone().set(0, 0, 1).cross(away).normalize();
  const up = away.clone().cross(right);
  const most = [0, 0];
  for (let i = 0; i < 8; ++i) {
    const corner = away
      .clone()
      .set(i & 1 ? max.x : min.x, i & 2 ? max.y : min.y, i & 4 ? max.z : min.z)
      .sub(shot.position);
    const depth = -corner.dot(away);
    assert.ok(depth > 0, "no corner is behind the camera");
    most[0] = Math.max(most[0], Math.abs(corner.dot(right)) / (depth * tangent * aspect));
    most[1] = Math.max(most[1], Math.abs(corner.dot(up)) / (depth * tangent));
  }
  return most;
}

test("all of a box is in the window, and it touches two edges, whatever their shapes", () => {
  const tangent = Math.tan(Math.PI / 8);
  for (const [x, y, z] of [[90, 3, 3], [3, 90, 3], [40, 30, 3], [30, 10, 10]]) {
    for (const aspect of [2.8, 1, 0.6]) {
      const box = { min: { x: 5, y: -2, z: 0 }, max: { x: 5 + x, y: y - 2, z } };
      const [across, along] = reach(geometry.bestShot(box, tangent, aspect), box, tangent, aspect);
      const text = `${x} × ${y} × ${z} m in ${aspect}`;
      assert.ok(across <= 1 && along <= 1, text);
      assert.ok(Math.max(across, along) > 0.9, `${text}: no room is wasted`);
      assert.ok(Math.min(across, along) > 0.5, `${text}: no half of the window is empty`);
    }
  }
});

test("a long corridor is seen from its side in a wide window, along its length in a high one", () => {
  const box = { min: { x: 0, y: -1, z: 0 }, max: { x: 90, y: 1, z: 3 } };
  const along = (aspect) => {
    const { position, target } = geometry.bestShot(box, 0.41, aspect);
    const away = position.clone().sub(target).normalize();
    return Math.abs(away.x) / Math.hypot(away.x, away.y);
  };
  assert.ok(along(2.8) < 0.6, `${along(2.8)}`);
  assert.ok(along(0.6) > 0.8, `${along(0.6)}`);
});

test("a person walks up and down between two points", () => {
  const person = { from: [0, 1], to: [4, 1], speed: 2, start: 3, radius: 0.25, height: 1.75 };
  assert.deepEqual(geometry.personAt(person, 0), [3, 1]);
  assert.deepEqual(geometry.personAt(person, 1), [3, 1]);
  assert.deepEqual(geometry.personAt(person, 2.5), [0, 1]);
  assert.deepEqual(geometry.personAt(person, 3), [1, 1]);
  assert.deepEqual(geometry.personAt({ ...person, to: [0, 1] }, 3), [0, 1]);
});

test("the distance to a triangle is the least over its points", () => {
  const random = generator(3);
  const point = () => [0, 1, 2].map(() => 4 * random() - 2);
  for (let trial = 0; trial < 50; ++trial) {
    const [p, a, b, c] = [point(), point(), point(), point()];
    let least = Infinity;
    for (let i = 0; i <= 200; ++i) {
      for (let k = 0; k <= 200 - i; ++k) {
        const [s, t] = [i / 200, k / 200];
        const q = [0, 1, 2].map((n) => a[n] + s * (b[n] - a[n]) + t * (c[n] - a[n]));
        least = Math.min(least, (p[0] - q[0]) ** 2 + (p[1] - q[1]) ** 2 + (p[2] - q[2]) ** 2);
      }
    }
    const found = geometry.toTriangle(p, a, b, c);
    assert.ok(found <= least + 1e-9 && Math.sqrt(least) - Math.sqrt(found) < 0.02, `${found} of ${least}`);
  }
});

test("no surface is nearer than the limit, and roofs count", () => {
  const flat = (z) => Float32Array.from([-9, -9, z, 9, -9, z, 0, 9, z]);
  const surface = new geometry.Surface({ edges: null, triangles: flat(0), roof_triangles: flat(3) });
  assert.ok(Math.abs(surface.distance([0, 0, 0.2], 0.5) - 0.2) < 1e-6);
  assert.ok(Math.abs(surface.distance([0, 0, 2.9], 0.5) - 0.1) < 1e-6);
  assert.equal(surface.distance([0, 0, 1.5], 0.5), 0.5);
});
