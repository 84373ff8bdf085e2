// SPDX-License-Identifier: BSD-3-Clause
/** Payload: base64 of zlib of (u32 length of JSON, JSON, padding to 8, blob). */
import type { PagePayload } from "./contract";

const kArrays = { f32: Float32Array, u8: Uint8Array } as const;
type ArrayKind = keyof typeof kArrays;

interface Reference {
  $: ArrayKind;
  at: number;
  n: number;
}

/** Code of NaN in a quantized column. */
const kNoCode = 65535;

/** `n` values in `columns` columns: value = low + step * code, or exp of that; null: 32-bit floats. */
interface Quantized {
  $: "q16";
  at: number;
  n: number;
  columns: ({ low: number; step: number; log: boolean } | null)[];
}

function isReference(value: object): value is Reference {
  const { $, at, n } = value as Partial<Reference>;
  return (
    typeof $ === "string" &&
    Object.hasOwn(kArrays, $) &&
    Number.isInteger(at) &&
    Number.isInteger(n)
  );
}

function isQuantized(value: object): value is Quantized {
  const { $, at, n, columns } = value as Partial<Quantized>;
  return $ === "q16" && Number.isInteger(at) && Number.isInteger(n) && Array.isArray(columns);
}

/** Values of quantized columns, a row after the other; see PageData::q16. */
function dequantize({ at, n, columns }: Quantized, blob: ArrayBuffer, start: number): Float32Array {
  const rows = n / columns.length;
  const size = columns.reduce((sum, column) => sum + (column ? 2 : 4) * rows, 0);
  if (!Number.isInteger(rows) || at < 0 || n < 0 || start + at + size > blob.byteLength)
    throw new Error(`data: ${n} quantized values at ${at} do not fit into the block`);
  const values = new Float32Array(n);
  let from = start + at;
  columns.forEach((column, k) => {
    const bytes = new Uint8Array(blob, from, (column ? 2 : 4) * rows);
    from += bytes.length;
    if (column) fillQuantized(values, k, columns.length, bytes, column);
    else fillFloats(values, k, columns.length, bytes);
  });
  return values;
}

function fillQuantized(
  values: Float32Array, k: number, stride: number, bytes: Uint8Array,
  { low, step, log }: { low: number; step: number; log: boolean },
): void {
  const rows = bytes.length / 2;
  let code = 0;
  for (let i = 0; i < rows; ++i) {
    const folded = bytes[i]! | (bytes[rows + i]! << 8);
    code = (code + (folded & 1 ? -((folded + 1) >> 1) : folded >> 1)) & 0xffff;
    const value = low + step * code;
    values[k + i * stride] = code === kNoCode ? NaN : log ? Math.exp(value) : value;
  }
}

function fillFloats(values: Float32Array, k: number, stride: number, bytes: Uint8Array): void {
  const rows = bytes.length / 4;
  const bits = new DataView(new ArrayBuffer(4));
  for (let i = 0; i < rows; ++i) {
    for (let plane = 0; plane < 4; ++plane) bits.setUint8(plane, bytes[plane * rows + i]!);
    values[k + i * stride] = bits.getFloat32(0, true);
  }
}

function bytesOf(base64: string): Uint8Array<ArrayBuffer> {
  const text = atob(base64.trim());
  const bytes = new Uint8Array(text.length);
  for (let i = 0; i < text.length; ++i) bytes[i] = text.charCodeAt(i);
  return bytes;
}

async function inflate(bytes: Uint8Array<ArrayBuffer>): Promise<ArrayBuffer> {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}

function resolve(reference: Reference, blob: ArrayBuffer, start: number): ArrayBufferView {
  const type = kArrays[reference.$];
  const at = start + reference.at;
  const size = reference.n * type.BYTES_PER_ELEMENT;
  if (reference.at < 0 || reference.n < 0 || at + size > blob.byteLength) {
    throw new Error(
      `data: an array of ${reference.n} at ${reference.at} lies outside the block of ` +
        `${blob.byteLength - start} bytes`,
    );
  }
  if (at % type.BYTES_PER_ELEMENT === 0) return new type(blob, at, reference.n);
  return new type(blob.slice(at, at + size));
}

/** Replaces every reference below `node` by its array, in place. */
function link(node: unknown, blob: ArrayBuffer, start: number): void {
  if (typeof node !== "object" || node === null) return;
  for (const [key, value] of Object.entries(node)) {
    if (typeof value !== "object" || value === null) continue;
    if (isReference(value)) {
      (node as Record<string, unknown>)[key] = resolve(value, blob, start);
    } else if (isQuantized(value)) {
      (node as Record<string, unknown>)[key] = dequantize(value, blob, start);
    } else {
      link(value, blob, start);
    }
  }
}

/** The payload of a page, arrays in place; an error says what is wrong with it. */
export async function decodePayload(base64: string): Promise<PagePayload> {
  const buffer = await inflate(bytesOf(base64));
  if (buffer.byteLength < 4) throw new Error("data: too short to hold a length");
  const length = new DataView(buffer).getUint32(0, true);
  if (4 + length > buffer.byteLength) throw new Error(`data: JSON of ${length} bytes is cut off`);
  const payload = JSON.parse(
    new TextDecoder().decode(new Uint8Array(buffer, 4, length)),
  ) as PagePayload;
  if (payload.schema !== "aims.page/2") {
    throw new Error(`data: schema ${String(payload.schema)}, expected aims.page/2`);
  }
  link(payload, buffer, Math.ceil((4 + length) / 8) * 8);
  return payload;
}
