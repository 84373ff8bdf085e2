// SPDX-License-Identifier: BSD-3-Clause
/** Numbers as text. What has no value is a dash. */

export const kNone = "–";

export function isNumber(value: unknown): value is number {
  return typeof value === "number" && Number.isFinite(value);
}

/** Number with about `digits` significant digits and a true minus sign: 1234, 0.0123, 1.2e−7. */
export function formatNumber(value: unknown, digits = 3): string {
  if (typeof value !== "number" || Number.isNaN(value)) return kNone;
  if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
  const size = Math.abs(value);
  let text: string;
  if (size !== 0 && (size < 1e-4 || size >= 1e6)) {
    text = value.toExponential(Math.max(0, digits - 1));
  } else {
    const decimals = size === 0 ? 0 : Math.max(0, digits - 1 - Math.floor(Math.log10(size)));
    text = value.toFixed(Math.min(decimals, 6));
  }
  return text.replace(/-/g, "−");
}

/** Number with that many decimals. */
export function formatFixed(value: unknown, decimals: number): string {
  if (!isNumber(value)) return kNone;
  const text = value.toFixed(decimals);
  return (Number(text) === 0 ? text.replace("-", "") : text).replace("-", "−");
}

/** Seconds as 1:23.4. */
export function formatTime(seconds: unknown): string {
  if (!isNumber(seconds)) return kNone;
  const tenths = Math.round(Math.abs(seconds) * 10);
  const minutes = Math.floor(tenths / 600);
  const rest = ((tenths % 600) / 10).toFixed(1).padStart(4, "0");
  return `${seconds < 0 ? "−" : ""}${minutes}:${rest}`;
}

/** Of a message of several lines. */
export function firstLine(message: unknown): string {
  return typeof message === "string" ? message.split("\n", 1)[0]! : "";
}
