// SPDX-License-Identifier: BSD-3-Clause
// Opens MCAP files with Foxglove's packages.
import { parse } from "@foxglove/rosmsg";
import lz4 from "@foxglove/wasm-lz4";
import zstd from "@foxglove/wasm-zstd";
import { McapIndexedReader } from "@mcap/core";
import { readFile } from "node:fs/promises";

/** A file by its index, and of each topic, by channel id, the parsed types. */
export async function openIndexed(path) {
  await Promise.all([lz4.isLoaded, zstd.isLoaded]);
  const file = await readFile(path);
  const readable = {
    size: async () => BigInt(file.length),
    read: async (offset, size) => file.subarray(Number(offset), Number(offset + size)),
  };
  const decompressHandlers = {
    lz4: (bytes, size) => lz4(bytes, Number(size)),
    zstd: (bytes, size) => zstd.decompress(bytes, Number(size)),
  };
  const reader = await McapIndexedReader.Initialize({ readable, decompressHandlers });
  const topics = new Map();
  for (const channel of reader.channelsById.values()) {
    const schema = reader.schemasById.get(channel.schemaId);
    const types = parse(new TextDecoder().decode(schema.data), { ros2: true });
    topics.set(channel.id, { channel, schema, types });
  }
  return { reader, topics };
}

/** All messages in order of log time. */
export function messagesOf(mcap) {
  return mcap.reader.readMessages();
}
