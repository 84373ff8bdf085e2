// SPDX-License-Identifier: BSD-3-Clause
/** Pictures that a folder holds. */
import "./pictures.css";
import type { Picture } from "./contract";
import { h } from "./dom";

export function pictureImage(picture: Picture): HTMLImageElement {
  const base64 = /^[A-Za-z0-9+/=\s]*$/.test(picture.png) ? picture.png : "";
  return h("img", { src: `data:image/png;base64,${base64}`, alt: picture.title || picture.name });
}

/** Picture in a figure; pressing it shows it as large as the window. */
function figure(picture: Picture): HTMLElement {
  const title = picture.title || picture.name;
  const open = () => {
    const dialog = h(
      "dialog",
      {
        class: "large",
        "aria-label": title,
        onclick: () => dialog.close(),
        onclose: () => dialog.remove(),
      },
      pictureImage(picture),
      h("form", { method: "dialog" }, h("button", {}, "Close")),
    );
    document.body.append(dialog);
    dialog.showModal();
  };
  return h(
    "figure",
    {},
    h(
      "button",
      { type: "button", class: "picture", "aria-label": `Enlarge: ${title}`, onclick: open },
      pictureImage(picture),
    ),
    h("figcaption", {}, title),
  );
}

/** The pictures beside one another; null without any. */
export function pictureGrid(pictures: Picture[] | null | undefined): HTMLElement | null {
  if (!pictures || pictures.length === 0) return null;
  return h("div", { class: "pictures" }, ...pictures.map(figure));
}
