// SPDX-License-Identifier: BSD-3-Clause
/** How curves that lie on each other stay visible: the worst below and wide, the best on top and thin. */
import { mostOf, type ErrorTrack } from "./errors";

const kThinnest = 1.4;
/** A curve shows this much on both sides of the one on top of it, all together at most `kMost` [px]. */
const kStep = 1;
const kMost = 5;

/** The items from the bottom to the top, each with the width of its curve [px]. */
export function layered<Item extends { track: ErrorTrack }>(items: Item[]): { item: Item; width: number }[] {
  const most = (item: Item) => mostOf(item.track);
  const order = [...items].reverse().sort((a, b) => most(b) - most(a));
  const step = Math.min(kStep, kMost / Math.max(order.length - 1, 1));
  return order.map((item, i) => ({ item, width: kThinnest + step * (order.length - 1 - i) }));
}
