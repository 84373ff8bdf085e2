// SPDX-License-Identifier: BSD-3-Clause
// The list of scores as a payload holds it, from where the program has it.
import { readFileSync } from "node:fs";

const source = readFileSync(new URL("../../../../bench/scoring/score_list.cpp", import.meta.url), "utf8");
const kBetter = { kSmall: "smaller", kLarge: "larger", kOpen: "neither" };

export const kScoreList = [...source.matchAll(/Score\{"([^"]+)", "([^"]*)", "([^"]*)"(?:, \d+, (k\w+))?/g)]
  .map(([, key, title, unit, better]) => ({ key, title, unit: unit === "-" ? "" : unit, better: kBetter[better ?? "kSmall"] }));
