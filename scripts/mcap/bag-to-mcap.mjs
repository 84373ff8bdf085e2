#!/usr/bin/env node
// SPDX-License-Identifier: BSD-3-Clause
import { existsSync, statSync } from "node:fs";
import { dirname } from "node:path";
import { parseArgs } from "node:util";
import { convert } from "./convert.mjs";

const kUsage = `Converts a ROS 1 bag into MCAP with ROS 2 messages (CDR), for today's viewers.

usage: bag-to-mcap.mjs RUN.bag RUN.mcap [--compress none|zstd] [--overwrite]

Record times become log times, header stamps publish times. Exit codes: 0 ok, 2 bad input,
130 interrupted.`;

const kBadInput = 2;
const kInterrupted = 130;

class BadInput extends Error {}

function readArguments() {
  let parsed;
  try {
    parsed = parseArgs({
      allowPositionals: true,
      options: {
        compress: { type: "string", default: "none" },
        overwrite: { type: "boolean", default: false },
        help: { type: "boolean", short: "h", default: false },
      },
    });
  } catch (error) {
    throw new BadInput(`${error.message.split(". ")[0]}; see --help`);
  }
  const { values, positionals } = parsed;
  if (values.help) return undefined;
  if (positionals.length !== 2) throw new BadInput("two files expected: RUN.bag RUN.mcap");
  if (!["none", "zstd"].includes(values.compress)) {
    throw new BadInput(`--compress ${values.compress}: none or zstd expected`);
  }
  return { input: positionals[0], output: positionals[1], ...values };
}

function check({ input, output, overwrite }) {
  if (!existsSync(input)) throw new BadInput(`${input}: no such file`);
  if (!statSync(input).isFile()) throw new BadInput(`${input}: not a file`);
  if (!existsSync(dirname(output))) throw new BadInput(`${dirname(output)}: no such folder`);
  if (!existsSync(output)) return;
  const [from, to] = [statSync(input), statSync(output)];
  if (from.dev === to.dev && from.ino === to.ino) throw new BadInput(`${output}: is the bag itself`);
  if (!to.isFile()) throw new BadInput(`${output}: not a file`);
  if (!overwrite) throw new BadInput(`${output}: exists; --overwrite replaces it`);
}

async function main() {
  const options = readArguments();
  if (!options) {
    console.log(kUsage);
    return 0;
  }
  check(options);
  let interrupted = false;
  for (const signal of ["SIGINT", "SIGTERM"]) process.on(signal, () => (interrupted = true));
  let result;
  try {
    result = await convert(options.input, options.output, options.compress, () => interrupted);
  } catch (error) {
    throw error.path ? error : new BadInput(`${options.input}: ${error.message ?? error}`);
  }
  if (!result) return kInterrupted;
  const { messages, topics, bytes } = result;
  console.log(`${options.output}: ${messages} messages, ${topics} topics, ${bytes} bytes`);
  return 0;
}

try {
  process.exitCode = await main();
} catch (error) {
  console.error(`bag-to-mcap: ${error.message}`);
  process.exitCode = kBadInput;
}
