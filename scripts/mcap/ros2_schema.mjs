// SPDX-License-Identifier: BSD-3-Clause
import { isBuiltin } from "./ros1_definition.mjs";

const kSeparator = "=".repeat(80);
const kNewNames = new Map([["tf/tfMessage", "tf2_msgs/TFMessage"]]);
const kBuiltins = new Map([
  ["byte", "int8"],
  ["char", "uint8"],
  ["time", "builtin_interfaces/Time"],
  ["duration", "builtin_interfaces/Duration"],
]);
const kTimeFields = "int32 sec\nuint32 nanosec\n";

/** The fields that ROS 2 keeps of a type: its Header has no `seq`. */
export function keptFields(name, type) {
  if (name !== "std_msgs/Header") return type.fields;
  return type.fields.filter((field) => field.name !== "seq");
}

/** `package/Type` as ROS 2 names it. */
function shortName(type) {
  return kNewNames.get(type) ?? type;
}

/** `package/msg/Type`. */
export function ros2Name(type) {
  return shortName(type).replace("/", "/msg/");
}

/** ROS 2 has lower-case field names: `K` becomes `k`, `timeRef` becomes `time_ref`. */
function fieldName(name) {
  return name.replace(/([a-z0-9])([A-Z])/g, "$1_$2").toLowerCase();
}

function constantText({ type, value }) {
  if (type === "string") return JSON.stringify(value);
  if (type !== "bool") return value;
  return value === "0" || value.toLowerCase() === "false" ? "false" : "true";
}

function sectionOf(name, type) {
  let text = "";
  for (const constant of type.constants) {
    const kind = kBuiltins.get(constant.type) ?? constant.type;
    text += `${kind} ${constant.name.toUpperCase()}=${constantText(constant)}\n`;
  }
  const names = new Set();
  for (const field of keptFields(name, type)) {
    const kind = kBuiltins.get(field.type) ?? shortName(field.type);
    const brackets = field.length === undefined ? "" : `[${field.length < 0 ? "" : field.length}]`;
    const own = fieldName(field.name);
    if (names.has(own)) throw new Error(`${name}: ROS 2 cannot hold two fields named '${own}'`);
    names.add(own);
    text += `${kind}${brackets} ${own}\n`;
  }
  return text;
}

/**
 * The ROS 2 schema of a message type: `name` as `package/msg/Type`, `text` as the concatenated
 * definitions of MCAP's encoding "ros2msg"; viewers look for the used types as `package/Type`.
 */
export function ros2Schema(rootType, types) {
  const used = [rootType];
  const builtins = new Set();
  for (const name of used) {
    for (const field of keptFields(name, types.get(name))) {
      if (kBuiltins.get(field.type)?.includes("/")) builtins.add(field.type);
      if (!isBuiltin(field.type) && !used.includes(field.type)) used.push(field.type);
    }
  }
  let text = sectionOf(rootType, types.get(rootType));
  for (const name of used.slice(1)) {
    text += `${kSeparator}\nMSG: ${shortName(name)}\n${sectionOf(name, types.get(name))}`;
  }
  for (const type of builtins) {
    text += `${kSeparator}\nMSG: ${kBuiltins.get(type)}\n${kTimeFields}`;
  }
  return { name: ros2Name(rootType), text };
}
