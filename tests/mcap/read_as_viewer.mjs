// SPDX-License-Identifier: BSD-3-Clause
// Reads an MCAP file as Foxglove does (its index, schema parser and CDR decoder), writes each message
// again with that decoder's counterpart and counts those whose bytes differ. Messages with text beyond
// ASCII are decoded alone: the counterpart states the length of such text in characters, not bytes.
import { MessageReader, MessageWriter } from "@foxglove/rosmsg2-serialization";
import { messagesOf, openIndexed } from "./viewer.mjs";

function hasForeignText(value) {
  if (typeof value === "string") return /[^\x00-\x7f]/.test(value);
  if (typeof value !== "object" || ArrayBuffer.isView(value)) return false;
  return Object.values(value).some(hasForeignText);
}

const mcap = await openIndexed(process.argv[2]);
const codecs = new Map();
for (const [id, { types }] of mcap.topics) {
  codecs.set(id, { reader: new MessageReader(types), writer: new MessageWriter(types) });
}
let count = 0;
let different = 0;
let foreign = 0;
for await (const message of messagesOf(mcap)) {
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
