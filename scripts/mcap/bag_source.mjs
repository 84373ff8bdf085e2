// SPDX-License-Identifier: BSD-3-Clause
import Bzip2 from "@foxglove/wasm-bz2";
import lz4 from "@foxglove/wasm-lz4";
import rosbag from "@foxglove/rosbag";
import nodeReader from "@foxglove/rosbag/node.js";
import records from "@foxglove/rosbag/dist/cjs/record.js";
import { open } from "node:fs/promises";

const kMagic = "#ROSBAG V2.0\n";
const kLargestChunk = 2 ** 30; // of one chunk once decompressed [bytes]

async function checkMagic(file) {
  const handle = await open(file, "r");
  try {
    if (!(await handle.stat()).isFile()) throw new Error("not a file");
    const { buffer, bytesRead } = await handle.read(Buffer.alloc(kMagic.length), 0, kMagic.length, 0);
    if (bytesRead < kMagic.length || buffer.toString("latin1") !== kMagic) {
      throw new Error("not a ROS 1 bag: '#ROSBAG V2.0' expected at offset 0");
    }
  } finally {
    await handle.close();
  }
}

/** What `promise` yields; its error says where. */
async function at(place, promise) {
  try {
    return await promise;
  } catch (error) {
    throw new Error(`${place}: ${error.message ?? error}`);
  }
}

async function decompressors() {
  const bzip2 = await Bzip2.init();
  await lz4.isLoaded;
  const bounded = (decompress) => (bytes, size) => {
    if (size > kLargestChunk) throw new Error(`a chunk claims ${size} bytes`);
    const result = decompress(bytes, size);
    if (result.length !== size) {
      throw new Error(`a chunk claims ${size} bytes, but has ${result.length}`);
    }
    return result;
  };
  return {
    bz2: bounded((bytes, size) => bzip2.decompress(bytes, size, { small: false })),
    lz4: bounded((bytes, size) => lz4(bytes, size)),
  };
}

/** A ROS 1 bag, read chunk by chunk: memory holds one chunk, however long the bag is. */
export class BagSource {
  #bag;
  #file;
  #decompress;

  /** Throws an error that says what was expected where. */
  static async open(path) {
    await checkMagic(path);
    const source = new BagSource();
    source.#file = new nodeReader.FileReader(path);
    source.#decompress = await decompressors();
    source.#bag = new rosbag.Bag(source.#file);
    try {
      const header = await at("bag header at offset 13", source.#bag.reader.readHeader());
      if (header.indexPosition === 0) {
        throw new Error("the bag was never closed and has no index; run 'rosbag reindex' first");
      }
      if (header.indexPosition > source.#file.size()) {
        throw new Error(
          `cut short: the index is at ${header.indexPosition}, the end at ${source.#file.size()}`,
        );
      }
      await at(`index at offset ${header.indexPosition}`, source.#bag.open());
    } catch (error) {
      await source.close();
      throw error;
    }
    return source;
  }

  /** Connections by their ids: topic, type, messageDefinition, latching. */
  get connections() {
    return this.#bag.connections;
  }

  /** Yields {connection, time [ns], data} in the order of the file. */
  async *messages() {
    const chunks = [...this.#bag.chunkInfos].sort((a, b) => a.chunkPosition - b.chunkPosition);
    for (const [index, chunk] of chunks.entries()) chunk.nextChunk = chunks[index + 1];
    for (const info of chunks) {
      try {
        yield* this.#messagesOf(await this.#bag.reader.readChunk(info, this.#decompress));
      } catch (error) {
        throw new Error(`chunk at offset ${info.chunkPosition}: ${error.message ?? error}`);
      }
    }
  }

  *#messagesOf({ chunk, indices }) {
    const offsets = indices.flatMap((index) => index.indices.map((entry) => entry.offset));
    for (const offset of offsets.sort((a, b) => a - b)) {
      const record = this.#bag.reader.readRecordFromBuffer(
        chunk.data.subarray(offset),
        offset,
        records.MessageData,
      );
      const connection = this.connections.get(record.conn);
      if (!connection) throw new Error(`no connection ${record.conn}, which a message names`);
      const time = BigInt(record.time.sec) * 1000000000n + BigInt(record.time.nsec);
      yield { connection, time, data: record.data };
    }
  }

  async close() {
    await this.#file.close();
  }
}
