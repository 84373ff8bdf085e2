// SPDX-License-Identifier: BSD-3-Clause
/** Payload: base64 of zlib of (u32 length of JSON, JSON, padding to 8, blob). */
import type { PagePayload } from "./contract";

const kArrays = { f32: Float32Array, u16: Uint16Array, u8: Uint8Array } as const;
type ArrayKind = keyof typeof kArrays;

interface Reference {
  $: ArrayKind;
  at: number;
  n: number;
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
  if (payload.schema !== "aims.page/1") {
    throw new Error(`data: schema ${String(payload.schema)}, expected aims.page/1`);
  }
  link(payload, buffer, Math.ceil((4 + length) / 8) * 8);
  return payload;
}
