// SPDX-License-Identifier: BSD-3-Clause
import zstd from "@foxglove/wasm-zstd";
import { McapWriter } from "@mcap/core";
import { open, rename, rm } from "node:fs/promises";

const kChunkSize = 4 << 20; // [bytes]
const kZstdLevel = 1;

/** The part of rosbag2's metadata by which a player offers a topic as it was offered. */
function offeredQos(latching) {
  const forever = "\n    sec: 9223372036\n    nsec: 854775807";
  return [
    "- history: 1",
    `  depth: ${latching ? 1 : 10}`,
    "  reliability: 1",
    `  durability: ${latching ? 1 : 2}`,
    `  deadline:${forever}`,
    `  lifespan:${forever}`,
    "  liveliness: 1",
    `  liveliness_lease_duration:${forever}`,
    "  avoid_ros_namespace_conventions: false",
  ].join("\n");
}

/** An MCAP file that appears under its name only once it is whole. */
export class McapTarget {
  #path;
  #partial;
  #handle;
  #writer;
  #written = 0n;
  #schemas = new Map();
  #channels = new Map();
  #sequence = new Map();

  static async create(path, compression) {
    const target = new McapTarget();
    target.#path = path;
    target.#partial = `${path}.${process.pid}.partial`;
    target.#handle = await open(target.#partial, "wx");
    if (compression === "zstd") await zstd.isLoaded;
    const compressChunk = (bytes) => ({
      compression: "zstd",
      compressedData: zstd.compress(bytes, kZstdLevel),
    });
    target.#writer = new McapWriter({
      writable: {
        position: () => target.#written,
        write: async (bytes) => target.#write(bytes),
      },
      chunkSize: kChunkSize,
      compressChunk: compression === "zstd" ? compressChunk : undefined,
    });
    await target.#writer.start({ profile: "ros2", library: "aims-bag-to-mcap" });
    return target;
  }

  async #write(bytes) {
    await this.#handle.writeFile(bytes);
    this.#written += BigInt(bytes.length);
  }

  /** Announces a topic with messages of a schema {name, text}; the same one gives the same id. */
  async channel(topic, schema, latching) {
    const schemaKey = `${schema.name}\n${schema.text}`;
    if (!this.#schemas.has(schemaKey)) {
      const data = new TextEncoder().encode(schema.text);
      const id = await this.#writer.registerSchema({ name: schema.name, encoding: "ros2msg", data });
      this.#schemas.set(schemaKey, id);
    }
    const schemaId = this.#schemas.get(schemaKey);
    const key = `${topic}\n${schemaId}\n${latching}`;
    if (!this.#channels.has(key)) {
      const metadata = new Map([["offered_qos_profiles", offeredQos(latching)]]);
      const info = { topic, schemaId, messageEncoding: "cdr", metadata };
      this.#channels.set(key, await this.#writer.registerChannel(info));
    }
    return this.#channels.get(key);
  }

  /** Appends a message; times in ns. */
  async message(channelId, logTime, publishTime, data) {
    const sequence = this.#sequence.get(channelId) ?? 0;
    this.#sequence.set(channelId, sequence + 1);
    await this.#writer.addMessage({ channelId, sequence, logTime, publishTime, data });
  }

  /** Ends the file and gives it its name; yields its size [bytes]. */
  async close() {
    await this.#writer.end();
    await this.#handle.sync();
    await this.#handle.close();
    await rename(this.#partial, this.#path);
    return Number(this.#written);
  }

  /** Leaves nothing behind. */
  async discard() {
    await this.#handle.close().catch(() => {});
    await rm(this.#partial, { force: true });
  }
}
