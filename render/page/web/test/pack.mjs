// SPDX-License-Identifier: BSD-3-Clause
// Packs a payload as the C++ side does: typed arrays become references into a blob.
import { deflateSync, inflateSync } from "node:zlib";

const kKinds = new Map([
  [Float32Array, "f32"],
  [Uint8Array, "u8"],
]);

/** Stands for the table of core/series_style.cpp. */
const kPalette = Array.from({ length: 24 }, (_, i) => ({
  light: `#${((0x2a24de + i * 0x0b1d37) & 0xffffff).toString(16).padStart(6, "0")}`,
  dark: `#${((0x8f9fff - i * 0x050913) & 0xffffff).toString(16).padStart(6, "0")}`,
  dash: i % 2 ? [8, 4] : [],
}));

/** base64 of the payload of `aims.page/2`; typed arrays go into the blob. */
export function pack(given) {
  const payload = { palette: kPalette, ...given };
  const parts = [];
  let size = 0;
  const json = JSON.stringify(payload, (_key, value) => {
    const kind = ArrayBuffer.isView(value) ? kKinds.get(value.constructor) : undefined;
    if (!kind) return typeof value === "number" && !Number.isFinite(value) ? null : value;
    const bytes = Buffer.from(value.buffer, value.byteOffset, value.byteLength);
    const at = size;
    const padding = (8 - (bytes.length % 8)) % 8;
    parts.push(bytes, Buffer.alloc(padding));
    size += bytes.length + padding;
    return { $: kind, at, n: value.length };
  });
  const text = Buffer.from(json, "utf8");
  const head = Buffer.alloc(4);
  head.writeUInt32LE(text.length);
  const padding = Buffer.alloc((8 - ((4 + text.length) % 8)) % 8);
  return deflateSync(Buffer.concat([head, text, padding, ...parts])).toString("base64");
}

function escapeHtml(text) {
  return text.replace(/&/g, "&amp;").replace(/</g, "&lt;").replace(/>/g, "&gt;");
}

/** The page: both marks of the template replaced in one pass, for a title may look like one. */
export function fillTemplate(template, payload) {
  const fills = { __AIMS_TITLE__: escapeHtml(payload.title), __AIMS_DATA__: pack(payload) };
  return template.replace(/__AIMS_TITLE__|__AIMS_DATA__/g, (mark) => fills[mark]);
}

/** Quantized columns, row by row. */
function dequantized({ at, n, columns }, blob) {
  const rows = n / columns.length;
  const values = new Float32Array(n);
  let from = at;
  columns.forEach((column, k) => {
    let code = 0;
    for (let i = 0; i < rows; ++i) {
      if (column === null) {
        const bytes = [0, 1, 2, 3].map((plane) => blob[from + plane * rows + i]);
        values[i * columns.length + k] = Buffer.from(bytes).readFloatLE();
        continue;
      }
      const folded = blob[from + i] + 256 * blob[from + rows + i];
      code = (code + 65536 + (folded % 2 ? -(folded + 1) / 2 : folded / 2)) % 65536;
      const place = column.low + column.step * code;
      values[i * columns.length + k] = code === 65535 ? NaN : column.log ? Math.exp(place) : place;
    }
    from += (column === null ? 4 : 2) * rows;
  });
  return values;
}

/** Payload of a page as an object, its arrays in place: the other way round. */
export function payloadOf(html) {
  const base64 = html.match(/<script id="aims-data" type="text\/plain">([^<]*)<\/script>/)[1];
  const bytes = inflateSync(Buffer.from(base64, "base64"));
  const length = bytes.readUInt32LE(0);
  const blob = bytes.subarray(Math.ceil((4 + length) / 8) * 8);
  const types = { f32: Float32Array, u8: Uint8Array };
  return JSON.parse(bytes.subarray(4, 4 + length).toString("utf8"), (_key, value) => {
    if (value?.$ === "q16") return dequantized(value, blob);
    const type = types[value?.$];
    if (!type) return value;
    return new type(
      Uint8Array.from(blob.subarray(value.at, value.at + value.n * type.BYTES_PER_ELEMENT)).buffer,
    );
  });
}
