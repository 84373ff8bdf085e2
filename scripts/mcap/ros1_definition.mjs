// SPDX-License-Identifier: BSD-3-Clause

/** Bytes of each ROS 1 type of fixed size; a time or duration is two numbers of 4 bytes. */
export const kSizes = new Map([
  ["bool", 1],
  ["int8", 1],
  ["uint8", 1],
  ["byte", 1],
  ["char", 1],
  ["int16", 2],
  ["uint16", 2],
  ["int32", 4],
  ["uint32", 4],
  ["int64", 8],
  ["uint64", 8],
  ["float32", 4],
  ["float64", 8],
]);

export function isBuiltin(type) {
  return kSizes.has(type) || type === "string" || type === "time" || type === "duration";
}

/**
 * Parses the definition that a bag carries for a message type: the type's own fields, then those of
 * every type that it uses, each after a line of `=` and a line `MSG: package/Type`.
 * @returns {Map<string, {fields: {type, name, length}[], constants: {type, name, value}[]}>}
 *   every type by its full name, the message's own first; `length` is undefined for a single value,
 *   -1 for an array of any length. Nested types have their full names.
 */
export function parseDefinition(rootType, text) {
  const types = new Map();
  for (const [index, section] of text.split(/^={3,}[ \t]*\r?$/m).entries()) {
    let name = rootType;
    let body = section;
    if (index > 0) {
      const title = /^\s*MSG:\s*(\S+)[^\n]*\n?/.exec(section);
      if (!title) throw new Error(`definition of ${rootType}: section ${index + 1} has no "MSG:" line`);
      name = title[1];
      body = section.slice(title[0].length);
    }
    if (!types.has(name)) types.set(name, parseSection(name, body));
  }
  for (const [name, type] of types) {
    for (const field of type.fields) field.type = resolve(field.type, name, types);
  }
  return types;
}

function parseSection(name, body) {
  const type = { fields: [], constants: [] };
  for (const [index, raw] of body.split("\n").entries()) {
    const line = raw.replace(/#.*/, "").trim();
    if (line === "") continue;
    const constant = /^\s*(\w+)\s+(\w+)\s*=(.*)$/.exec(raw);
    if (constant && !constant[0].split("=")[0].includes("#")) {
      // A '#' belongs to the value of a string, and begins a comment everywhere else.
      const value = constant[1] === "string" ? constant[3] : constant[3].replace(/#.*/, "");
      type.constants.push({ type: constant[1], name: constant[2], value: value.trim() });
      continue;
    }
    const field = /^([A-Za-z][\w/]*)(?:\[(\d*)\])?\s+([A-Za-z]\w*)$/.exec(line);
    if (!field) throw new Error(`definition of ${name}, line ${index + 1}: cannot read '${line}'`);
    const length = field[2] === undefined ? undefined : field[2] === "" ? -1 : Number(field[2]);
    type.fields.push({ type: field[1], name: field[3], length });
  }
  return type;
}

/** The full name of a type as written inside `user`. */
function resolve(type, user, types) {
  if (isBuiltin(type)) return type;
  if (type === "Header") return "std_msgs/Header";
  const own = type.includes("/") ? type : `${user.split("/")[0]}/${type}`;
  if (types.has(own)) return own;
  const same = [...types.keys()].filter((each) => each.split("/").pop() === type.split("/").pop());
  if (same.length === 1) return same[0];
  throw new Error(`definition of ${user}: the type '${type}' is not in it`);
}
