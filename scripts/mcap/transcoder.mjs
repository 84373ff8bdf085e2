// SPDX-License-Identifier: BSD-3-Clause
import { kSizes, parseDefinition } from "./ros1_definition.mjs";
import { keptFields } from "./ros2_schema.mjs";

/** Reads a message as serialized by ROS 1: little endian, nothing aligned. */
class Source {
  reset(bytes) {
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
    this.position = 0;
  }

  /** Moves on by `size` bytes; yields where they begin. */
  take(size) {
    const begin = this.position;
    if (begin + size > this.bytes.length) {
      throw new Error(
        `${size} bytes expected at byte ${begin} of the message, which has ${this.bytes.length}`,
      );
    }
    this.position += size;
    return begin;
  }

  count() {
    return this.view.getUint32(this.take(4), true);
  }
}

/** Writes CDR, little endian: each number is aligned to its own size, from behind the header. */
class Target {
  static kHeader = [0, 1, 0, 0];

  constructor() {
    this.#grow(1 << 16);
  }

  reset() {
    this.bytes.set(Target.kHeader);
    this.position = Target.kHeader.length;
  }

  #grow(size) {
    const bytes = new Uint8Array(size);
    if (this.bytes) bytes.set(this.bytes);
    this.bytes = bytes;
    this.view = new DataView(bytes.buffer);
  }

  /** Room for `size` bytes at a multiple of `alignment`; yields where they begin. */
  room(size, alignment) {
    const begin = this.position + ((Target.kHeader.length - this.position) & (alignment - 1));
    const end = begin + size;
    if (end > this.bytes.length) this.#grow(2 * end);
    this.bytes.fill(0, this.position, begin);
    this.position = end;
    return begin;
  }

  count(value) {
    this.view.setUint32(this.room(4, 4), value, true);
  }

  data() {
    return this.bytes.subarray(0, this.position);
  }
}

/** Copies `size` bytes of numbers, which need `alignment`. */
function copy(source, target, size, alignment) {
  if (size === 0) return;
  const from = source.take(size);
  const to = target.room(size, alignment);
  if (size > 16) {
    target.bytes.set(source.bytes.subarray(from, from + size), to);
  } else {
    for (let i = 0; i < size; ++i) target.bytes[to + i] = source.bytes[from + i];
  }
}

/** ROS 2 ends each string with a zero, which counts. */
function copyString(source, target) {
  const length = source.count();
  const from = source.take(length);
  target.count(length + 1);
  const to = target.room(length + 1, 1);
  target.bytes.set(source.bytes.subarray(from, from + length), to);
  target.bytes[to + length] = 0;
}

/** What copies one value of a type, and its size when numbers of one size are all that it holds. */
function copierOf(type, types, copiers) {
  if (type === "string") return { copy: copyString };
  if (type === "time" || type === "duration") return numbersCopier(8, 4);
  if (kSizes.has(type)) return numbersCopier(kSizes.get(type), kSizes.get(type));
  if (!copiers.has(type)) {
    const copier = {};
    copiers.set(type, copier);
    copier.copy = structCopy(type, types, copiers);
  }
  return copiers.get(type);
}

function numbersCopier(size, alignment) {
  return { size, alignment, copy: (source, target) => copy(source, target, size, alignment) };
}

function fieldCopy(field, types, copiers) {
  const one = copierOf(field.type, types, copiers);
  if (field.length === undefined) return one.copy;
  return (source, target) => {
    let length = field.length;
    if (length < 0) {
      length = source.count();
      target.count(length);
    }
    if (one.size !== undefined) {
      copy(source, target, length * one.size, one.alignment);
      return;
    }
    if (length > source.bytes.length) {
      throw new Error(`an array of ${length} in a message of ${source.bytes.length} bytes`);
    }
    for (let i = 0; i < length; ++i) one.copy(source, target);
  };
}

function structCopy(name, types, copiers) {
  const type = types.get(name);
  const kept = new Set(keptFields(name, type));
  const steps = type.fields.map((field) =>
    kept.has(field) ? fieldCopy(field, types, copiers) : (source) => source.take(4),
  );
  // A structure without fields has one hidden byte in ROS 2.
  if (steps.length === 0) return (source, target) => void (target.bytes[target.room(1, 1)] = 0);
  if (steps.length === 1) return (source, target) => steps[0](source, target);
  return (source, target) => {
    for (const step of steps) step(source, target);
  };
}

/** Turns messages of one type from ROS 1's serialization into CDR, every value bit by bit. */
export class Transcoder {
  static #source = new Source();
  static #target = new Target();
  #copy;

  constructor(rootType, types) {
    this.#copy = copierOf(rootType, types, new Map()).copy;
    const first = types.get(rootType).fields[0];
    this.hasHeader = first?.type === "std_msgs/Header" && first.length === undefined;
  }

  static of(rootType, definition) {
    return new Transcoder(rootType, parseDefinition(rootType, definition));
  }

  /** The message as CDR; valid until the next call of any transcoder. */
  cdr(message) {
    const source = Transcoder.#source;
    const target = Transcoder.#target;
    source.reset(message);
    target.reset();
    this.#copy(source, target);
    if (source.position !== message.length) {
      throw new Error(`${message.length - source.position} bytes too many`);
    }
    return target.data();
  }

  /** The stamp of the message's header [ns]; undefined without a header. */
  stamp(message) {
    if (!this.hasHeader || message.length < 12) return undefined;
    const view = new DataView(message.buffer, message.byteOffset);
    return BigInt(view.getUint32(4, true)) * 1000000000n + BigInt(view.getUint32(8, true));
  }
}
