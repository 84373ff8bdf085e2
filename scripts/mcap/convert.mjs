// SPDX-License-Identifier: BSD-3-Clause
import { BagSource } from "./bag_source.mjs";
import { McapTarget } from "./mcap_target.mjs";
import { parseDefinition } from "./ros1_definition.mjs";
import { ros2Schema } from "./ros2_schema.mjs";
import { Transcoder } from "./transcoder.mjs";

async function routeOf(connection, target) {
  const types = parseDefinition(connection.type, connection.messageDefinition);
  const schema = ros2Schema(connection.type, types);
  const latching = connection.latching === true;
  return {
    channel: await target.channel(connection.topic, schema, latching),
    transcoder: new Transcoder(connection.type, types),
  };
}

async function copyMessages(bag, target, stopped) {
  const routes = new Map();
  for (const connection of bag.connections.values()) {
    routes.set(connection, await routeOf(connection, target));
  }
  let count = 0;
  for await (const { connection, time, data } of bag.messages()) {
    if (stopped()) return undefined;
    const { channel, transcoder } = routes.get(connection);
    try {
      const publish = transcoder.stamp(data) ?? time;
      await target.message(channel, time, publish, transcoder.cdr(data));
    } catch (error) {
      throw new Error(`message ${count + 1} (${connection.topic}): ${error.message}`);
    }
    ++count;
  }
  return count;
}

/**
 * Converts the bag `input` into the MCAP file `output`, which appears whole or not at all.
 * @param compression "none" or "zstd"
 * @param stopped asked before each message; true: gives up and leaves nothing
 * @returns {messages, topics, bytes}, or undefined when stopped
 */
export async function convert(input, output, compression, stopped = () => false) {
  const bag = await BagSource.open(input);
  try {
    const target = await McapTarget.create(output, compression);
    try {
      const messages = await copyMessages(bag, target, stopped);
      if (messages === undefined) {
        await target.discard();
        return undefined;
      }
      const topics = new Set([...bag.connections.values()].map((each) => each.topic)).size;
      return { messages, topics, bytes: await target.close() };
    } catch (error) {
      await target.discard();
      throw error;
    }
  } finally {
    await bag.close();
  }
}
