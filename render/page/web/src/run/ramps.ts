// SPDX-License-Identifier: BSD-3-Clause
/** Colour ramps for points: height by cividis, error from blue to orange. */

type Rgb = [number, number, number];

/** Cividis, Nunez et al. 2018: even in lightness, the same to who confuses red and green. */
const kHeight: Rgb[] = [
  [0, 34, 78],
  [18, 53, 112],
  [59, 73, 108],
  [87, 93, 109],
  [112, 113, 115],
  [138, 134, 120],
  [165, 156, 116],
  [195, 179, 105],
  [225, 204, 85],
  [254, 232, 56],
];
/** Blue is on the surface, orange and red away from it. */
const kError: Rgb[] = [
  [0, 114, 178],
  [86, 180, 233],
  [196, 196, 186],
  [230, 159, 0],
  [213, 94, 0],
  [150, 40, 0],
];
/** On a dark ground the ramp of heights starts lighter. */
const kHeightDark: Rgb[] = [[62, 92, 160], [92, 108, 150], [112, 120, 140], ...kHeight.slice(5)];

/** From dark red to bright: stands out from a map in the colours of heights. */
const kScan: Rgb[] = [
  [90, 0, 60],
  [170, 20, 70],
  [225, 75, 50],
  [245, 145, 40],
  [255, 215, 90],
];

export type Ramp = "height" | "error" | "scan";

export function ramp(kind: Ramp, dark: boolean): Rgb[] {
  if (kind === "scan") return kScan;
  return kind === "error" ? kError : dark ? kHeightDark : kHeight;
}

/** Colour at `share` of the ramp, each channel in [0, 255]. */
export function rampColor(stops: Rgb[], share: number): Rgb {
  const place = Math.min(Math.max(Number.isFinite(share) ? share : 0, 0), 1) * (stops.length - 1);
  const index = Math.min(Math.floor(place), stops.length - 2);
  const rest = place - index;
  const a = stops[index]!,
    b = stops[index + 1]!;
  return [0, 1, 2].map((i) => a[i]! + rest * (b[i]! - a[i]!)) as Rgb;
}

/** 256 colours of a ramp, three bytes each. */
export function rampTable(stops: Rgb[]): Uint8Array {
  const table = new Uint8Array(256 * 3);
  for (let i = 0; i < 256; ++i) table.set(rampColor(stops, i / 255).map(Math.round), 3 * i);
  return table;
}

/** The ramp as a background of CSS. */
export function rampGradient(stops: Rgb[]): string {
  return `linear-gradient(to right, ${stops.map((rgb) => `rgb(${rgb.join(",")})`).join(", ")})`;
}
