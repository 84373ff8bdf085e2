// SPDX-License-Identifier: BSD-3-Clause
// Lists a bag as bag_tool does, and decodes every message: node list_bag.mjs BAG
import { createRequire } from "node:module";
import path from "node:path";
import process from "node:process";

// The packages lie where this was called, not beside this file.
const require = createRequire(path.join(process.cwd(), "package.json"));
const { Bag } = require("@foxglove/rosbag");
const { FileReader } = require("@foxglove/rosbag/node");
const bz2Module = require("@foxglove/wasm-bz2");
const lz4 = require("@foxglove/wasm-lz4");

function crcTable() {
  const table = new Uint32Array(256);
  for (let i = 0; i < 256; ++i) {
    let value = i;
    for (let bit = 0; bit < 8; ++bit) value = value & 1 ? (value >>> 1) ^ 0xedb88320 : value >>> 1;
    table[i] = value >>> 0;
  }
  return table;
}

const table = crcTable();

function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = table[(crc ^ byte) & 0xff] ^ (crc >>> 8);
  return ((crc ^ 0xffffffff) >>> 0).toString(16).padStart(8, "0");
}

await lz4.isLoaded;
const bz2 = await (bz2Module.default ?? bz2Module).init();
const bag = new Bag(new FileReader(process.argv[2]), {
  decompress: {
    bz2: (buffer, size) => bz2.decompress(buffer, size, { small: false }),
    lz4: (buffer, size) => (lz4.default ?? lz4)(buffer, size),
  },
});
await bag.open();
const lines = [];
let decoded = 0;
for await (const event of bag.messageIterator()) {
  const connection = bag.connections.get(event.connectionId);
  const time = BigInt(event.timestamp.sec) * 1000000000n + BigInt(event.timestamp.nsec);
  lines.push(`${time} ${event.topic} ${connection.type} ${event.data.byteLength} ${crc32(event.data)}`);
  if (event.message !== undefined) ++decoded;
}
if (decoded !== lines.length) throw new Error(`${decoded} of ${lines.length} messages decoded`);
process.stdout.write(lines.join("\n") + "\n");
