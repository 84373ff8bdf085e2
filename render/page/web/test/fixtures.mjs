// SPDX-License-Identifier: BSD-3-Clause
// Made-up runs: `node test/fixtures.mjs PAGE_HTML DIR` writes a page per case.
import { mkdir, readFile, writeFile } from "node:fs/promises";
import path from "node:path";
import { run } from "./made_run.mjs";
import { fillTemplate } from "./pack.mjs";

const kHostile = [
  "<script>document.title='taken'</script>",
  "__proto__",
  '"><img src=x onerror="console.error(\'taken\')">',
  "constructor ${1} \u202e 名前 " + "x".repeat(120),
];

function hostile() {
  const page = run({
    names: kHostile,
    count: 200,
    points: 500,
    title: "<script>console.error('taken')</script></title>__AIMS_DATA__ $& $'",
  });
  page.scenario.description = "</script><script>console.error('taken')</script>";
  page.config_yaml = "name: </pre><script>console.error('taken')</script>\n";
  page.config_changes.push({
    key: "<b>key</b>",
    value: "<i>value</i>",
    default: null,
    unit: "<u>m</u>",
  });
  page.waypoint_times[0].name = "<svg onload=console.error('taken')>";
  page.pictures.push({
    name: "x\" onerror=\"console.error('taken')",
    title: "<b>no picture</b>",
    png: 'not base64 " onerror=',
  });
  page.scores = JSON.parse(
    JSON.stringify(page.scores).replace(/"b-a"/g, JSON.stringify("<b>b</b>-a")),
  );
  return page;
}

function notNumbers() {
  const page = run({ count: 300, points: 0 });
  for (const item of page.estimators) {
    for (const [key, values] of Object.entries(item.series))
      if (key !== "t") values.fill(NaN, 0, Math.floor(values.length / 2));
  }
  page.estimators[1].series.p.fill(NaN);
  page.estimators[2].series.D.fill(NaN);
  page.estimators[2].series.C_IL.fill(-1);
  page.scores.estimators.aims = { success: null, m_list_percent: {}, m_end_m: null };
  page.localizability.equivalent_returns.fill(NaN);
  page.truth.p.fill(NaN, 0, 90);
  page.scenario.seed = null;
  return page;
}

function failed() {
  const page = run({ count: 100, points: 200 });
  page.scenario.robot = {
    fell: true,
    touched_wall: false,
    valid: false,
    invalid_reason: "the robot fell at 3.2 s",
  };
  page.scores.expectations = [
    { estimator: "aims", score: "ate_m", min: null, max: 0.5, value: 0.2, holds: true },
    { estimator: "lio", score: "ate_m", min: null, max: 0.1, value: 0.4, holds: false },
  ];
  page.failures = [{ estimator: "mine", message: "boom <b>\nsecond line" }];
  page.scores.estimators.lio.health = { worst: "degraded", healthy_while_wrong_s: 98.9 };
  return page;
}

/** An estimate that ends early. */
function part() {
  const page = run({ count: 100, points: 0 });
  Object.assign(page.scores.estimators.lio, { success: false, diverged_at_s: 40, diverged_reason: "ends_early" });
  page.partial = ["lio"];
  return page;
}

function empty() {
  return {
    schema: "aims.page/2",
    kind: "run",
    title: "empty",
    version: "0.0.0",
    scenario: {
      name: "empty",
      description: null,
      seed: null,
      simulated_s: null,
      complete: false,
      robot: null,
    },
    command: null,
    config_yaml: null,
    config_changes: null,
    scores: null,
    partial: [],
    scene: null,
    waypoint_times: null,
    truth: null,
    localizability: null,
    legs: null,
    estimators: [],
    pictures: null,
  };
}

export const kCases = {
  run: () => run(),
  part,
  large: () =>
    run({
      names: ["aims_d", "aims", "lio", "tfs", "leg"],
      count: 6000,
      points: 60000,
      seconds: 900,
      title: "long walk, seed 1",
    }),
  hostile,
  "not-numbers": notNumbers,
  failed,
  "one-scan": () => run({ count: 1, points: 30 }),
  empty,
};

/** Writes every case with the template; returns name → file. */
export async function writeFixtures(templateFile, folder) {
  const template = await readFile(templateFile, "utf8");
  await mkdir(folder, { recursive: true });
  const files = {};
  for (const [name, make] of Object.entries(kCases)) {
    files[name] = path.join(folder, `${name}.html`);
    await writeFile(files[name], fillTemplate(template, make()));
  }
  return files;
}

if (process.argv[1]?.endsWith("fixtures.mjs")) {
  const files = await writeFixtures(process.argv[2], process.argv[3]);
  console.log(Object.values(files).join("\n"));
}
