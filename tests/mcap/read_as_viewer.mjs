// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file as Foxglove does (its index, schema parser and CDR decoder), writes each message
// again with that decoder's counterpart and counts those whose bytes differ. Messages with text beyond
// ASCII are decoded alone: the counterpart states the length of such text in characters, not bytes.
import { parse } from "@foxglove/rosmsg";
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { McapIndexedReader } from "@mcap/core";
import { readFile } from "node:fs/promises";

function hasForeignText(value) {
  if (typeof value === "string") return /[^\x00-\x7f]/.test(value);
  if (typeof value !== "object" || ArrayBuffer.isView(value)) return false;
  return Object.values(value).some(hasForeignText);
}

const file = await readFile(process.argv[2]);
const readable = {
  size: async () => BigInt(file.length),
  read: async (offset, size) => file.subarray(Number(offset), Number(offset + size)),
};
const mcap = await McapIndexedReader.Initialize({ readable });
const codecs = new Map();
for (const channel of mcap.channelsById.values()) {
  const schema = mcap.schemasById.get(channel.schemaId);
  const types = parse(new TextDecoder().decode(schema.data), { ros2: true });
  codecs.set(channel.id, { reader: new MessageReader(types), writer: new MessageWriter(types) });
}
let count = 0;
let different = 0;
let foreign = 0;
for await (const message of mcap.readMessages()) {
  const { reader, writer } = codecs.get(message.channelId);
  const value = reader.readMessage(message.data);
  ++count;
  if (hasForeignText(value)) {
    ++foreign;
  } else if (Buffer.compare(writer.writeMessage(value), message.data) !== 0) {
    ++different;
  }
}
console.log(`${count} messages read, ${foreign} not ASCII, ${different} differ`);
