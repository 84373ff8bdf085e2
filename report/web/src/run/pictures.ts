// SPDX-License-Identifier: BSD-3-Clause
/** The pictures of the folder. */
import type { Picture, RunPayload } from "../contract";
import { h, section } from "../dom";

export function pictureImage(picture: Picture): HTMLImageElement {
  const base64 = /^[A-Za-z0-9+/=\s]*$/.test(picture.png) ? picture.png : "";
  return h("img", { src: `data:image/png;base64,${base64}`, alt: picture.title || picture.name });
}

export function picturesSection(data: RunPayload): HTMLElement | null {
  const pictures = data.pictures ?? [];
  if (pictures.length === 0) return null;
  return section("pictures", "Pictures", h("div", { class: "pictures" }, ...pictures.map((picture) =>
    h("figure", {}, pictureImage(picture), h("figcaption", {}, picture.title || picture.name)))));
}
