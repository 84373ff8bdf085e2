// SPDX-License-Identifier: BSD-3-Clause
// What a page of a run must do, in a real browser. Screenshots go to AIMS_PAGE_ARTIFACTS.
import assert from "node:assert/strict";
import { mkdir, readFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { launch, open, settle } from "./browser.mjs";
import { needlessScrolls } from "./made_up.mjs";
import { payloadOf } from "./pack.mjs";

export const kArtifacts =
  process.env.AIMS_PAGE_ARTIFACTS ?? path.join(os.tmpdir(), "aims-page-artifacts");

/** Index of the value nearest to `value`. */
function nearest(list, value) {
  let best = 0;
  for (let i = 1; i < list.length; ++i)
    if (Math.abs(list[i] - value) < Math.abs(list[best] - value)) best = i;
  return best;
}

async function shoot(page, name, fullPage = false) {
  await mkdir(kArtifacts, { recursive: true });
  await page.screenshot({ path: path.join(kArtifacts, `${name}.png`), fullPage });
}

/** Value that a strip shows at the cursor; undefined if there is no such curve. */
function shown(page, panel, series) {
  return page.evaluate(
    ([id, name]) => {
      for (const output of document.querySelectorAll(`[data-panel="${id}"] output`)) {
        if (output.dataset.series === name) return output.dataset.value;
      }
      return undefined;
    },
    [panel, series],
  );
}

export const cursorOf = (page) =>
  page.evaluate(() => Number(document.querySelector("[data-clock]").dataset.value));

/** How many different colours the 3D canvas holds. */
function canvasColors(page) {
  return page.evaluate(() => {
    const source = document.querySelector(".view-frame canvas");
    const copy = Object.assign(document.createElement("canvas"), {
      width: source.width,
      height: source.height,
    });
    const context = copy.getContext("2d");
    context.drawImage(source, 0, 0);
    const data = new Uint32Array(context.getImageData(0, 0, copy.width, copy.height).data.buffer);
    return new Set(data).size;
  });
}

/** Fraction of a strip's pixels that something was drawn on. */
function stripInk(page, panel) {
  return page.evaluate((id) => {
    const canvas = document.querySelector(`[data-panel="${id}"] canvas`);
    const { data } = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height);
    let drawn = 0;
    for (let i = 3; i < data.length; i += 4) drawn += data[i] > 0;
    return drawn / (data.length / 4);
  }, panel);
}

/** Cells of a table by row and title of column: { value (in full or null), best, text }. */
function tableCells(page, selector) {
  return page.evaluate((where) => {
    const table = document.querySelector(`${where} table`);
    if (!table) return null;
    const titles = [...table.querySelectorAll("thead th")].map((head) => head.textContent.trim());
    return [...table.querySelectorAll("tbody tr")].map((row) => ({
      name: row.dataset.row,
      cells: Object.fromEntries(
        [...row.children].map((cell, i) => [
          titles[i],
          {
            value: cell.dataset.value === undefined ? null : Number(cell.dataset.value),
            best: cell.classList.contains("best"),
            text: cell.textContent,
          },
        ]),
      ),
    }));
  }, selector);
}

/** The page leads with the verdict and the table, then come the time series, then the rest. */
async function assertLeadsWithResult(page, height) {
  const tops = await page.evaluate(() =>
    [".verdict", '[data-table="paper"] table', ".plan", ".timeline", ".view", "#details"].map(
      (selector) => document.querySelector(selector).getBoundingClientRect().top + scrollY,
    ),
  );
  assert.deepEqual(
    tops,
    [...tops].sort((a, b) => a - b),
    "verdict, table, plan, time series, 3D view, details",
  );
  assert.ok(tops[1] < height, `the table begins at ${tops[1]} px of a window of ${height}`);
}

/** Pixels of the 3D canvas that are not its background, as fractions of its width and height that they span. */
function canvasSpan(page) {
  return page.evaluate(() => {
    const source = document.querySelector(".view-frame canvas");
    const { width, height } = source;
    const copy = Object.assign(document.createElement("canvas"), { width, height });
    const context = copy.getContext("2d");
    context.drawImage(source, 0, 0);
    const data = new Uint32Array(context.getImageData(0, 0, width, height).data.buffer);
    let [left, right, top, bottom] = [width, 0, height, 0];
    for (let y = 0; y < height; ++y) {
      for (let x = 0; x < width; ++x) {
        if (data[y * width + x] === data[0]) continue;
        [left, right] = [Math.min(left, x), Math.max(right, x)];
        [top, bottom] = [Math.min(top, y), Math.max(bottom, y)];
      }
    }
    return [(right - left) / width, (bottom - top) / height];
  });
}

/** The ceiling is cut away until it is asked for. */
async function assertCeilingSwitches(page) {
  const ceiling = page.locator('[data-control="ceiling"]');
  assert.equal(await ceiling.isChecked(), false, "the ceiling is cut away at first");
  const shot = () =>
    page.evaluate(() => document.querySelector(".view-frame canvas").toDataURL());
  const open = await shot();
  await ceiling.check();
  await settle(page);
  const closed = await shot();
  assert.notEqual(closed, open, "the ceiling is drawn");
  await ceiling.uncheck();
  await settle(page);
}

/** The scan at the cursor is drawn in each of its colours, and the page states which scan it is. */
async function assertScanColors(page, payload) {
  if (!payload.scans) return;
  const key = page.locator('[data-key="scan"]');
  const text = await key.innerText();
  const cursor = await cursorOf(page);
  const at = nearest(payload.scans.t, cursor);
  assert.ok(text.includes(`at ${payload.scans.t[at].toFixed(1)} s`), `${text} near ${cursor} s`);
  assert.ok(text.includes(payload.scans.returns[at].toLocaleString("en")), text);
  const pictures = new Set();
  const select = page.locator('[data-control="scan-coloring"]');
  for (const name of ["intensity", "range", "residual", "none"]) {
    await select.selectOption(name);
    await settle(page);
    pictures.add(await page.evaluate(() => document.querySelector(".view-frame canvas").toDataURL()));
    assert.equal(await key.count(), name === "none" ? 0 : 1, name);
  }
  assert.equal(pictures.size, 4, "each colouring looks different");
  await select.selectOption("intensity");
  await settle(page);
}

/** Every number of the first two tables equals that of scores.json. */
async function assertTablesEqual(page, scores) {
  const near = (cell, value, what) => {
    // A column in which no estimator has a value is left out.
    if (value === null || value === undefined) assert.equal(cell?.value ?? null, null, what);
    else assert.equal(cell.value, value, what);
  };
  const paper = await tableCells(page, '[data-table="paper"]');
  assert.deepEqual(new Set(paper.map((row) => row.name)), new Set(Object.keys(scores.estimators)));
  for (const { name, cells } of paper) {
    near(cells["M_list %"], scores.estimators[name].m_list_percent?.all, `${name} M_list`);
    near(cells["M_end m"], scores.estimators[name].m_end_m, `${name} M_end`);
    near(cells["ATE yaw m"], scores.estimators[name].ate_yaw_m, `${name} ATE by heading`);
    near(cells["max |z| m"], scores.estimators[name].max_error_z_m, `${name} height error`);
    if (scores.robot?.valid !== false)
      assert.equal(cells["Success"].text === "yes", scores.estimators[name].success === true, `${name} success`);
  }
  for (const { name, cells } of await tableCells(page, '[data-table="errors"]')) {
    const own = scores.estimators[name];
    for (const { name: segment } of scores.segments ?? [])
      near(cells[`M_list(${segment}) %`], own.m_list_percent?.[segment], `${name} M_list(${segment})`);
    near(cells["ATE start m"], own.ate_m, `${name} ATE`);
    near(cells["ATE SE(3) m"], own.ate_se3_m, `${name} ATE SE(3)`);
    near(cells["max m"], own.max_error_m, `${name} max`);
    near(cells["RPE 10 m m"], own.rpe_10m?.translation_m, `${name} RPE`);
    near(cells["longitudinal m"], own.drift_m?.rmse?.longitudinal, `${name} longitudinal drift`);
    const turned = own.drift_m?.rmse?.heading_rad;
    near(cells["heading, start mrad"], Number.isFinite(turned) ? 1000 * turned : null, `${name} drift heading`);
  }
  for (const { name, cells } of (await tableCells(page, '[data-table="times"]')) ?? []) {
    const own = scores.estimators[name];
    near(cells["CPU p99 ms"], own.cpu_per_scan_ms?.p99, `${name} processor time`);
    near(cells["wall p99 ms"], own.time_per_scan_ms?.p99, `${name} wall time`);
  }
}

/** Bold is the least M_end among those that did not diverge. */
async function assertBestIsBold(page, scores) {
  const eligible = Object.entries(scores.estimators).filter(
    ([, own]) => own.success === true && Number.isFinite(own.m_end_m),
  );
  const rows = await tableCells(page, '[data-table="paper"]');
  if (eligible.length === 0 || rows.length < 2) return;
  const [best] = eligible.reduce((a, b) => (b[1].m_end_m < a[1].m_end_m ? b : a));
  assert.ok(rows.find((row) => row.name === best).cells["M_end m"].best, `${best} is in bold`);
  for (const row of rows)
    if (scores.estimators[row.name].success !== true)
      assert.ok(!row.cells["M_end m"].best, `${row.name} is not`);
}

async function assertSorts(page) {
  const head = page.locator('[data-table="errors"] thead th', { hasText: "ATE SE(3)" });
  const values = async () =>
    (await tableCells(page, '[data-table="errors"]'))
      .map((row) => row.cells["ATE SE(3) m"].value)
      .filter((value) => value !== null);
  await head.locator("button").click();
  assert.equal(await head.getAttribute("aria-sort"), "ascending");
  const up = await values();
  assert.deepEqual(
    up,
    [...up].sort((a, b) => a - b),
  );
  await head.locator("button").focus();
  await page.keyboard.press("Enter");
  assert.equal(await head.getAttribute("aria-sort"), "descending");
  const down = await values();
  assert.deepEqual(
    down,
    [...down].sort((a, b) => b - a),
  );
}

/** What strips and readout show is the payload's sample at the cursor; none if none is near. */
async function assertCursorAgrees(page, payload, chosen) {
  const cursor = await cursorOf(page);
  const { series } = payload.estimators[chosen];
  const index = nearest(series.t, cursor);
  const near = Math.abs(series.t[index] - cursor) <= 0.5;
  for (const [panel, name, key] of [
    ["index", "D", "D"],
    ["weights", "γ lidar", "gamma_lidar"],
    ["error_longitudinal", payload.estimators[chosen].name, "error_longitudinal"],
  ]) {
    if (!series[key] || !series[key].some(Number.isFinite)) continue;
    if ((await page.locator(`[data-panel="${panel}"]`).count()) === 0) continue; // of the other tab
    const value = Number(await shown(page, panel, name));
    assert.equal(value, near ? series[key][index] : NaN, `${panel} ${name} at ${cursor} s`);
  }
  const text = await page.textContent('[data-readout="estimate"]');
  const fixed = [0, 1, 2].map((axis) =>
    series.p[3 * index + axis]
      .toFixed(2)
      .replace(/^-0\.00$/, "0.00")
      .replace("-", "−"),
  );
  assert.equal(text, near ? `${fixed.join(", ")} m` : "– m");
}

async function assertCursorMoves(page, payload) {
  const chosen = await page.evaluate(() =>
    Number(document.querySelector("input[name=estimator]:checked").value),
  );
  await assertCursorAgrees(page, payload, chosen);
  const said = await page.locator(".timeline [data-cursor-at]").first().textContent();
  assert.equal(said, `at ${(await cursorOf(page)).toFixed(1)} s`);
  const strip = page.locator(".timeline [data-plot]").first();
  // Not to the upper edge: there the controls lie over it.
  await strip.evaluate((each) => each.scrollIntoView({ block: "center" }));
  const box = await strip.boundingBox();
  const before = {
    cursor: await cursorOf(page),
    text: await page.textContent('[data-readout="truth"]'),
  };
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.3 * box.width, box.y + 20, { steps: 4 });
  await page.mouse.up();
  await settle(page);
  const dragged = await cursorOf(page);
  assert.ok(dragged < before.cursor, `${dragged} s is before ${before.cursor} s`);
  assert.notEqual(await page.textContent('[data-readout="truth"]'), before.text, "the robot moved");
  await assertCursorAgrees(page, payload, chosen);
  await page.locator(".strips").focus();
  await page.keyboard.press("ArrowRight");
  await settle(page);
  const stepped = await cursorOf(page);
  assert.ok(stepped > dragged && stepped - dragged < 1, `one scan on: ${dragged} to ${stepped} s`);
  await assertCursorAgrees(page, payload, chosen);
  await page.keyboard.press("Home");
  await settle(page);
  assert.ok((await cursorOf(page)) < dragged);
}

/** All strips share the window of time: marking one with shift changes the ticks of the last. */
async function assertZoomLinks(page) {
  const shot = () =>
    page.evaluate(() =>
      [...document.querySelectorAll(".timeline .panel canvas")].map((canvas) => canvas.toDataURL()),
    );
  const full = await shot();
  const strip = page.locator(".timeline [data-plot]").first();
  await strip.evaluate((each) => each.scrollIntoView({ block: "center" }));
  const box = await strip.boundingBox();
  await page.keyboard.down("Shift");
  await page.mouse.move(box.x + 0.4 * box.width, box.y + 20);
  await page.mouse.down();
  await page.mouse.move(box.x + 0.5 * box.width, box.y + 20, { steps: 4 });
  await page.mouse.up();
  await page.keyboard.up("Shift");
  await settle(page);
  const zoomed = await shot();
  zoomed.forEach((picture, i) => assert.notEqual(picture, full[i], `strip ${i} zoomed`));
  await page.keyboard.press("0");
  await settle(page);
}

async function assertSwitches(page, payload) {
  const count = payload.estimators.length;
  for (let index = 0; index < count; ++index) {
    await page.locator("input[name=estimator]").nth(index).check({ force: true });
    await settle(page);
    if (payload.estimators[index].series) await assertCursorAgrees(page, payload, index);
  }
}

async function assertNarrow(browser, file, name) {
  const { page, context, troubles } = await open(browser, file, {
    width: 390,
    height: 844,
    touch: true,
  });
  const width = await page.evaluate(() => document.documentElement.scrollWidth);
  assert.ok(width <= 390, `${width} px wide in a window of 390`);
  assert.deepEqual(troubles, []);
  await shoot(page, `${name}-390`, true);
  await context.close();
}

async function assertNoWebGl(file, name, pictures) {
  const browser = await launch({ webgl: false });
  try {
    const { page, troubles, ready } = await open(browser, file);
    assert.equal(ready, "true");
    assert.deepEqual(troubles, []);
    assert.equal(await page.locator(".view-frame canvas").count(), 0);
    const fallback = page.locator('[data-view="fallback"]');
    assert.ok(await fallback.isVisible());
    if (pictures)
      assert.ok(
        (await fallback.locator("img").evaluate((image) => image.naturalWidth)) > 0,
        "the picture is shown",
      );
    await shoot(page, `${name}-no-webgl`);
  } finally {
    await browser.close();
  }
}

/** Charts of all estimators on the first screen; what is hidden leaves them, and the address says so. */
async function assertOverview(page, payload) {
  const names = payload.estimators.filter((item) => item.series).map((item) => item.name);
  const lines = (where) => page.locator(`${where} [data-series]`).evaluateAll((list) => list.map((each) => each.dataset.series));
  assert.deepEqual(new Set(await lines(".overview-errors")), new Set(names));
  assert.deepEqual(new Set(await lines(".overview-plan")), new Set(names));
  assert.ok((await stripInk(page, "error_distance")) > 0.01, "the error over distance drew");
  const errors = await page.locator('[data-plot="error_distance"]').boundingBox();
  const before = await cursorOf(page);
  for (const part of [0.1, 0.95]) {
    await page.mouse.click(errors.x + part * errors.width, errors.y + 20);
    await settle(page);
    const said = (await page.textContent('[data-panel="error_distance"] [data-cursor-at]')) ?? "";
    assert.match(said, /^at [0-9.]+ s, [0-9.]+ m$/, "the values beside it are of that instant");
    assert.equal((await cursorOf(page)) < before, part < 0.5, "a press on the error moves the run's cursor there");
  }
  assert.match(await page.locator(".overview-plan [data-beyond]").innerText(), /Dots: where estimates end\./);
  for (const width of [1400, 1300, 1000, 390]) {
    await page.setViewportSize({ width, height: 800 });
    const cut = await page.locator('[data-table="paper"] .table-frame').evaluate((frame) => frame.scrollWidth - frame.clientWidth);
    assert.ok(cut <= 1, `the results are cut by ${cut} px at ${width} px`);
  }
  await page.setViewportSize({ width: 1280, height: 800 });
  await settle(page);
  assert.equal(await page.locator('[data-control="level"]').inputValue(), "n100", "below 100 returns is degenerate");
  await page.locator(`[data-shown="${names[0]}"]`).uncheck();
  await page.waitForFunction(() => location.hash.includes("hide="));
  assert.deepEqual(new Set(await lines(".overview-errors")), new Set(names.slice(1)));
  await page.locator(`[data-shown="${names[0]}"]`).check();
  await page.waitForFunction(() => !location.hash.includes("hide="));
}

/** A link with the view's state shows that view. */
async function assertAddress(browser, file, payload) {
  const name = payload.estimators[payload.estimators.length - 1].name;
  const hash = `#estimator=${encodeURIComponent(name)}&tab=internals&preset=top&level=n1000`;
  const { page, context, troubles } = await open(browser, file, { hash });
  assert.equal(await page.locator("input[name=estimator]:checked").getAttribute("data-estimator"), name);
  assert.equal(await page.locator('[data-tab="internals"]').getAttribute("aria-selected"), "true");
  assert.equal(await page.locator('[data-preset="top"]').getAttribute("aria-pressed"), "true");
  assert.equal(await page.locator('[data-control="level"]').inputValue(), "n1000");
  const [wide, high] = await canvasSpan(page);
  assert.ok(wide > 0.6 && high > 0.35, `from the top the scene spans ${wide} by ${high} of the view`);
  assert.ok((await page.locator(".axes-3d text").count()) > 3, "the view has axes");
  assert.deepEqual(troubles, []);
  await context.close();
}

/** Everything that a page of a run with results must do. */
export async function assertRunPage(browser, file, name, scores) {
  const payload = payloadOf(await readFile(file, "utf8"));
  const { page, context, troubles, readyMs, ready } = await open(browser, file);
  assert.equal(ready, "true", troubles.join("\n"));
  console.log(`# ${name}: ready after ${readyMs} ms`);
  await shoot(page, `${name}-light`);
  assert.ok((await canvasColors(page)) > 20, "the 3D view drew");
  assert.equal(await page.locator('[data-panel="index"]').count(), 0, "internals are behind a tab");
  await assertOverview(page, payload);
  const [wide, high] = await canvasSpan(page);
  assert.ok(wide > 0.6 && high > 0.5, `the scene spans ${wide} by ${high} of the view`);
  await assertLeadsWithResult(page, 800);
  await assertCeilingSwitches(page);
  await assertScanColors(page, payload);
  assert.deepEqual(await needlessScrolls(page), []);
  await assertTablesEqual(page, scores);
  await assertBestIsBold(page, scores);
  await assertCursorMoves(page, payload);
  await page.locator('[data-tab="internals"]').click();
  await settle(page);
  assert.ok((await stripInk(page, "index")) > 0.01, "the strips drew");
  await assertZoomLinks(page);
  await assertSwitches(page, payload);
  await assertSorts(page);
  for (const preset of ["top", "side"]) {
    await page.locator(`[data-preset="${preset}"]`).click();
    await settle(page);
    assert.ok((await canvasColors(page)) > 5, `the view from the ${preset} drew`);
    await shoot(page, `${name}-${preset}`);
  }
  assert.deepEqual(troubles, []);
  await context.close();
  const dark = await open(browser, file, { dark: true });
  assert.equal(await dark.page.evaluate(() => document.documentElement.dataset.theme), "dark");
  await shoot(dark.page, `${name}-dark`, true);
  assert.deepEqual(dark.troubles, []);
  await dark.context.close();
  await assertAddress(browser, file, payload);
  await assertNarrow(browser, file, name);
  await assertNoWebGl(file, name, (payload.pictures ?? []).length > 0);
}

/** A page of whatever run becomes ready, runs nothing that came as a name, requests nothing. */
export async function assertHolds(browser, file, name) {
  const { page, context, troubles, ready } = await open(browser, file);
  assert.equal(ready, "true", troubles.join("\n"));
  await page.keyboard.press("ArrowRight");
  for (const radio of await page.locator("input[name=estimator]").all())
    await radio.check({ force: true });
  await settle(page);
  assert.equal(
    await page
      .locator("main script, main svg script, main b, main i:not(.swatch):not(.ramp), main u")
      .count(),
    0,
    "no name became markup",
  );
  assert.notEqual(await page.title(), "taken", "no name ran");
  assert.equal(await page.evaluate(() => window.broken), undefined, "no name ran");
  assert.deepEqual(troubles, []);
  await shoot(page, name, true);
  await context.close();
  await assertNarrow(browser, file, name);
}
