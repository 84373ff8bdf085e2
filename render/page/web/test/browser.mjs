// SPDX-License-Identifier: BSD-3-Clause
// Headless Chromium, as the machines that test this have it.
import { createRequire } from "node:module";
import { existsSync } from "node:fs";
import path from "node:path";
import { fileURLToPath, pathToFileURL } from "node:url";

const here = path.dirname(fileURLToPath(import.meta.url));
const modules = process.env.AIMS_PAGE_MODULES ?? path.join(here, "../node_modules");
const { chromium } = createRequire(path.join(path.resolve(modules), "any.js"))("playwright-core");

export const kChromium = process.env.AIMS_CHROMIUM ?? "/usr/bin/chromium";
export const hasChromium = () => existsSync(kChromium);

/** A browser; without WebGL if asked for. */
export function launch({ webgl = true } = {}) {
  const graphics = webgl
    ? [
        "--use-angle=swiftshader",
        "--enable-unsafe-swiftshader",
        "--disable-accelerated-2d-canvas",
        "--disable-gpu-rasterization",
      ]
    : ["--disable-gpu", "--disable-3d-apis"];
  return chromium.launch({
    executablePath: kChromium,
    args: [
      "--headless",
      "--no-sandbox",
      "--disable-quic",
      "--no-first-run",
      "--disable-background-networking",
      "--disable-component-update",
      "--disable-sync",
      "--force-device-scale-factor=1",
      ...graphics,
    ],
  });
}

/** Opens a file, waits for its ready mark; `troubles` are console errors, exceptions, requests. */
export async function open(
  browser,
  file,
  { width = 1280, height = 800, dark = false, touch = false, hash = "" } = {},
) {
  const context = await browser.newContext({
    viewport: { width, height },
    colorScheme: dark ? "dark" : "light",
    hasTouch: touch,
    offline: false,
  });
  const page = await context.newPage();
  page.setDefaultTimeout(180000);
  const troubles = [];
  const url = pathToFileURL(path.resolve(file)).href;
  page.on("console", (message) => {
    if (["error", "warning"].includes(message.type()))
      troubles.push(`${message.type()}: ${message.text()}`);
  });
  page.on("pageerror", (error) => troubles.push(`exception: ${error.message}`));
  page.on("request", (request) => {
    const to = request.url();
    if (to.split("#")[0] !== url && !/^(data|blob):/.test(to)) troubles.push(`request: ${to}`);
  });
  const start = Date.now();
  await page.goto(url + hash);
  await page.waitForFunction(() => document.documentElement.dataset.ready !== undefined);
  return {
    page,
    context,
    troubles,
    readyMs: Date.now() - start,
    ready: await page.evaluate(() => document.documentElement.dataset.ready),
  };
}

/** Lets two frames pass. */
export function settle(page) {
  return page.evaluate(
    () =>
      new Promise((done) =>
        requestAnimationFrame(() => requestAnimationFrame(() => requestAnimationFrame(done))),
      ),
  );
}
