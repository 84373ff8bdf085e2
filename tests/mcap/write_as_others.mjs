// SPDX-License-Identifier: BSD-3-Clause
// usage: write_as_others.mjs FILE FOLDER [DEFINITIONS]. Writes the messages of an MCAP file with
// Foxglove's writer in the forms that recorders choose: FOLDER/NAME.mcap for each of the names below.
// DEFINITIONS: JSON with the definition of each type in OMG IDL, by which idl and idl_big_endian are
// written; that of odd_msgs/msg/Feet takes the place of aims_msgs/msg/FootContacts.
import { CdrWriter, EncapsulationKind } from "@foxglove/cdr";
import { parseRos2idl } from "@foxglove/ros2idl-parser";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import lz4js from "lz4js";
import zstd from "@foxglove/wasm-zstd";
import { McapWriter } from "@mcap/core";
import { open, readFile } from "node:fs/promises";
import { messagesOf, openIndexed } from "./viewer.mjs";

const kChunkSize = 100 << 10; // [bytes]
const compressed = (name, compress) => (bytes) => ({ compression: name, compressedData: compress(bytes) });
const kBare = {
  useStatistics: false,
  useSummaryOffsets: false,
  repeatSchemas: false,
  repeatChannels: false,
  useChunkIndex: false,
  useMessageIndex: false,
};
const kForms = {
  plain: {},
  lz4: { compressChunk: compressed("lz4", (bytes) => lz4js.compress(bytes)) },
  zstd: { compressChunk: compressed("zstd", (bytes) => zstd.compress(bytes, 3)) },
  unindexed: { ...kBare, compressChunk: compressed("lz4", (bytes) => lz4js.compress(bytes)) },
  unchunked: { ...kBare, useChunks: false },
  big_endian: {},
};
const kOddType = "odd_msgs/msg/Feet";

/** Writes a value of a parsed type in either byte order. */
class ValueWriter {
  constructor(types, root, kind) {
    this.root = root;
    this.kind = kind;
    this.byName = new Map(types.filter((type) => type.name).map((type) => [type.name, type]));
  }

  writeMessage(value) {
    this.out = new CdrWriter({ kind: this.kind });
    this.#type(this.root, value);
    return this.out.data;
  }

  #type(type, value) {
    for (const field of type.definitions) {
      // The two parsers name the fraction of a time differently.
      const name = field.name === "nsec" && !("nsec" in value) ? "nanosec" : field.name;
      if (!field.isConstant) this.#field(field, value[name]);
    }
  }

  #field(field, value) {
    if (!field.isArray) return this.#one(field, value);
    if (field.arrayLength == undefined) this.out.sequenceLength(value.length);
    for (const entry of value) this.#one(field, entry);
  }

  #one(field, value) {
    if (field.isComplex) return this.#type(this.byName.get(field.type), value);
    if (field.type === "time" || field.type === "duration") {
      this.out.int32(value.sec);
      this.out.uint32(value.nsec ?? value.nanosec);
    } else if (field.type === "bool") {
      this.out.uint8(value ? 1 : 0);
    } else {
      this.out[field.type](value);
    }
  }
}

/** The value of the odd type that has the header and the contacts of `value`. */
function oddValue(value, serial) {
  const foot = (side) => ({ side, force: 1.5 * side, count: BigInt(side) });
  return {
    ...value,
    ...{ first: 9, height: 0.25, flag: true, gait: serial % 2, word: "w".repeat(serial % 7) },
    pair: Array.from({ length: serial % 3 }, (_, i) => foot(-i)),
    ...{ two: [foot(1), foot(2)], letter: 65, other: 66, serial: BigInt(serial) << 40n },
    ...{ words: ["", "long".repeat(serial % 2)], none: [], last: -2 },
  };
}

/** How messages of a topic are written: its schema, and a function of a message. */
function routeOf({ schema, types }, bigEndian, definitions) {
  const kind = bigEndian ? EncapsulationKind.CDR_BE : EncapsulationKind.CDR_LE;
  if (!bigEndian && !definitions) return { schema, dataOf: (message) => message.data };
  const reader = new MessageReader(types);
  if (!definitions) {
    const writer = new ValueWriter(types, types[0], kind);
    return { schema, dataOf: ({ data }) => writer.writeMessage(reader.readMessage(data)) };
  }
  const isOdd = schema.name === "aims_msgs/msg/FootContacts";
  const name = isOdd ? kOddType : schema.name;
  const parsed = parseRos2idl(definitions[name]);
  const writer = new ValueWriter(parsed, parsed.find((type) => type.name === name), kind);
  let serial = 0;
  return {
    schema: { name, encoding: "ros2idl", data: new TextEncoder().encode(definitions[name]) },
    dataOf: ({ data }) => {
      const value = reader.readMessage(data);
      return writer.writeMessage(isOdd ? oddValue(value, serial++) : value);
    },
  };
}

async function write(path, form, mcap, bigEndian, definitions) {
  const handle = await open(path, "w");
  let written = 0n;
  const writable = {
    position: () => written,
    write: async (bytes) => {
      await handle.writeFile(bytes);
      written += BigInt(bytes.length);
    },
  };
  const writer = new McapWriter({ writable, chunkSize: kChunkSize, ...form });
  await writer.start({ profile: "ros2", library: "write_as_others" });
  const routes = new Map();
  for (const [id, topic] of mcap.topics) {
    const route = routeOf(topic, bigEndian, definitions);
    const schemaId = await writer.registerSchema(route.schema);
    routes.set(id, { ...route, id: await writer.registerChannel({ ...topic.channel, schemaId }) });
  }
  for await (const message of messagesOf(mcap)) {
    const route = routes.get(message.channelId);
    await writer.addMessage({ ...message, channelId: route.id, data: route.dataOf(message) });
  }
  await writer.end();
  await handle.close();
}

const [file, folder, definitions] = process.argv.slice(2);
const mcap = await openIndexed(file);
for (const [name, form] of Object.entries(kForms)) {
  await write(`${folder}/${name}.mcap`, form, mcap, name === "big_endian");
}
if (definitions) {
  const idl = JSON.parse(await readFile(definitions, "utf8"));
  await write(`${folder}/idl.mcap`, {}, mcap, false, idl);
  await write(`${folder}/idl_big_endian.mcap`, {}, mcap, true, idl);
}
