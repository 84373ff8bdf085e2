// SPDX-License-Identifier: BSD-3-Clause
// Where the ticks of charts stand, without a browser.
import assert from "node:assert/strict";
import { mkdtemp, readFile, rm } from "node:fs/promises";
import { createRequire } from "node:module";
import os from "node:os";
import path from "node:path";
import { after, before, test } from "node:test";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = path.resolve(process.env.AIMS_PAGE_MODULES ?? path.join(here, "../node_modules"));
let folder;
let axis;

before(async () => {
  folder = await mkdtemp(path.join(os.tmpdir(), "aims-axis-"));
  const outfile = path.join(folder, "axis.mjs");
  const { build } = createRequire(path.join(modules, "any.js"))("esbuild");
  await build({ entryPoints: [path.join(here, "../src/charts/axis.ts")], bundle: true, format: "esm", logLevel: "error", outfile });
  ({ axis } = await import(pathToFileURL(outfile).href));
});
after(() => rm(folder, { recursive: true }));

const labels = (ends, log, most) => axis(ends, log, most).ticks.map(({ label }) => label);

test("ticks stand where those of pictures do", async () => {
  const table = await readFile(path.join(here, "../../../../tests/render/plots/ticks.txt"), "utf8");
  const cases = table.split("\n").filter((line) => line && !line.startsWith("#")).map((line) => line.split(" "));
  assert.ok(cases.length >= 16);
  for (const [kind, low, high, most, ...values] of cases) {
    const { ticks } = axis([Number(low), Number(high)], kind === "log", Number(most));
    assert.deepEqual(ticks.map(({ value }) => Number(value.toPrecision(12))), values.map(Number), `${kind} ${low} to ${high}`);
  }
});

test("ticks of a logarithmic axis spread over all of it, as dense as they fit", () => {
  assert.deepEqual(labels([0.03, 1.3], true, 3), ["0.03", "0.1", "0.3", "1"]);
  assert.deepEqual(labels([0.03, 1.3], true, 10), ["0.05", "0.1", "0.2", "0.5", "1"]);
  assert.deepEqual(labels([0.009, 40], true, 3), ["0.01", "0.1", "1", "10"]);
  assert.deepEqual(labels([0.6, 0.9], true, 3), ["0.6", "0.7", "0.8", "0.9"], "within a decade they are linear");
});

test("ticks of a logarithmic axis are at least two and no more than asked for and one", () => {
  for (const decades of [0.2, 0.7, 1, 1.5, 2.3, 4, 9]) {
    for (const most of [2, 3, 5, 10]) {
      const low = 0.0123;
      const { ticks } = axis([low, low * 10 ** decades], true, most);
      assert.ok(ticks.length >= 2 && ticks.length <= Math.max(most + 2, 4), `${decades} decades, ${most}: ${ticks.map(({ label }) => label)}`);
    }
  }
});

test("a linear axis has ticks on a phone, too", () => {
  assert.deepEqual(labels([-0.3, 8.3], false, 4), ["0", "2", "4", "6", "8"]);
  const whole = ([low, high]) => axis([low, high], false, 10, true).ticks.map(({ label }) => label);
  assert.deepEqual(whole([4.96, 6.04]), ["5", "6"], "levels are whole numbers");
  assert.deepEqual(whole([0.8, 9.2]), ["1", "2", "3", "4", "5", "6", "7", "8", "9"]);
  assert.deepEqual(labels([0, 78.6], false, 6), ["0", "20", "40", "60"]);
});
