// SPDX-License-Identifier: BSD-3-Clause
// usage: write_as_others.mjs FILE FOLDER. Writes the messages of an MCAP file with Foxglove's writer in
// the forms that recorders choose: FOLDER/NAME.mcap for each of the names below.
import { CdrWriter, EncapsulationKind } from "@foxglove/cdr";
import { MessageReader } from "@foxglove/rosmsg2-serialization";
import lz4js from "lz4js";
import zstd from "@foxglove/wasm-zstd";
import { McapWriter } from "@mcap/core";
import { open } from "node:fs/promises";
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

/** Writes a value of a parsed type, big endian. */
class BigEndianWriter {
  constructor(types) {
    this.types = types;
    this.byName = new Map(types.filter((type) => type.name).map((type) => [type.name, type]));
  }

  writeMessage(value) {
    this.out = new CdrWriter({ kind: EncapsulationKind.CDR_BE });
    this.#type(this.types[0], value);
    return this.out.data;
  }

  #type(type, value) {
    for (const field of type.definitions) {
      if (!field.isConstant) this.#field(field, value[field.name]);
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

async function write(path, form, bigEndian, mcap) {
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
  for (const [id, { channel, schema, types }] of mcap.topics) {
    const schemaId = await writer.registerSchema(schema);
    routes.set(id, {
      id: await writer.registerChannel({ ...channel, schemaId }),
      reader: new MessageReader(types),
      writer: new BigEndianWriter(types),
    });
  }
  for await (const message of messagesOf(mcap)) {
    const route = routes.get(message.channelId);
    const data = bigEndian
      ? route.writer.writeMessage(route.reader.readMessage(message.data))
      : message.data;
    await writer.addMessage({ ...message, channelId: route.id, data });
  }
  await writer.end();
  await handle.close();
}

const [file, folder] = process.argv.slice(2);
const mcap = await openIndexed(file);
for (const [name, form] of Object.entries(kForms)) {
  await write(`${folder}/${name}.mcap`, form, name === "big_endian", mcap);
}
