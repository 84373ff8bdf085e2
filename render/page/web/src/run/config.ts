// SPDX-License-Identifier: BSD-3-Clause
/** How to repeat the run, and its differences from the defaults. */
import type { ConfigChange, Json, RunPayload } from "../contract";
import { h, section } from "../dom";
import { kNone } from "../format";
import { sortableTable } from "../table";

function textOf(value: Json | undefined): string {
  if (value === null || value === undefined) return kNone;
  return typeof value === "string" ? value : JSON.stringify(value);
}

/** Button that copies a text; where the clipboard is shut it selects the text instead. */
export function copyButton(text: string, source: HTMLElement): HTMLElement {
  const button = h(
    "button",
    {
      type: "button",
      class: "quiet",
      onclick: async () => {
        try {
          await navigator.clipboard.writeText(text);
          button.textContent = "Copied";
        } catch {
          getSelection()?.selectAllChildren(source);
          button.textContent = "Selected";
        }
        setTimeout(() => {
          button.textContent = "Copy";
        }, 1500);
      },
    },
    "Copy",
  );
  return button;
}

/** Null for scores of foreign trajectories, which have no configuration. */
export function configSection(data: RunPayload): HTMLElement | null {
  if (!data.command && !data.config_yaml) return null;
  const command = h("code", { "data-command": true }, data.command ?? kNone);
  const yaml = h("code", {}, data.config_yaml ?? "");
  const changes = data.config_changes ?? [];
  const table =
    changes.length === 0
      ? h("p", { class: "nothing" }, "Nothing differs from the defaults.")
      : sortableTable<ConfigChange>(
          changes,
          [
            { title: "Key", value: (row) => row.key },
            {
              title: "Value",
              value: (row) => textOf(row.value),
              show: (row) => h("strong", {}, textOf(row.value)),
            },
            { title: "Default", value: (row) => textOf(row.default) },
            { title: "Unit", value: (row) => row.unit ?? "" },
          ],
          { caption: "Differences from the defaults", rowName: (row) => row.key },
        );
  return section(
    "config",
    "Configuration",
    ...(data.command
      ? [
          h("p", { class: "soft" }, "The command that repeats this run, in the folder of its results:"),
          h(
            "div",
            { class: "command" },
            h("pre", { tabindex: 0 }, command),
            copyButton(data.command, command),
          ),
        ]
      : []),
    table,
    data.config_yaml
      ? h(
          "details",
          {},
          h("summary", {}, "Effective configuration, config.yaml"),
          h("pre", { class: "yaml", tabindex: 0 }, yaml),
        )
      : null,
  );
}
