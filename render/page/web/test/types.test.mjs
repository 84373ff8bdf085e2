// SPDX-License-Identifier: BSD-3-Clause
// The type checker, with the node_modules of AIMS_PAGE_MODULES.
import assert from "node:assert/strict";
import { spawnSync } from "node:child_process";
import { existsSync } from "node:fs";
import { mkdtemp, rm, writeFile } from "node:fs/promises";
import os from "node:os";
import path from "node:path";
import { test } from "node:test";
import { fileURLToPath } from "node:url";

const web = path.join(path.dirname(fileURLToPath(import.meta.url)), "..");
const modules = path.resolve(process.env.AIMS_PAGE_MODULES ?? path.join(web, "node_modules"));
const compiler = path.join(modules, "typescript/bin/tsc");

test(
  "the sources pass the type checker",
  { skip: existsSync(compiler) ? false : `no ${compiler}` },
  async () => {
    const folder = await mkdtemp(path.join(os.tmpdir(), "aims-types-"));
    try {
      const project = path.join(folder, "tsconfig.json");
      await writeFile(
        project,
        JSON.stringify({
          extends: path.join(web, "tsconfig.json"),
          compilerOptions: {
            paths: {
              three: [`${modules}/@types/three`],
              "three/*": [`${modules}/@types/three/*`],
              "*": [`${modules}/*`],
            },
            types: [],
          },
          include: [path.join(web, "src")],
        }),
      );
      const { status, stdout } = spawnSync(process.execPath, [compiler, "--project", project], {
        encoding: "utf8",
      });
      assert.equal(status, 0, stdout);
    } finally {
      await rm(folder, { recursive: true, force: true });
    }
  },
);
