// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Questions and messages. Dialogs are the browser's own: they hold the focus and close with Escape.
import { el, uniqueId } from "./dom.js";

/** Shows a dialog; `make(close)` returns its elements. Resolves with the value given to close(), or undefined. */
export function showDialog(title, make) {
  return new Promise((resolve) => {
    let value;
    const id = uniqueId("dialog");
    const close = (result) => {
      value = result;
      dialog.close();
    };
    const dialog = el("dialog", { "aria-labelledby": id }, el("h2", { id, text: title }));
    dialog.append(...make(close));
    dialog.addEventListener("close", () => {
      dialog.remove();
      resolve(value);
    });
    document.body.append(dialog);
    dialog.showModal();
  });
}

/** A question; resolves with true if the user confirms. `danger`: the confirming button is red. */
export async function confirmed(title, sentence, agree, danger = false) {
  const answer = await showDialog(title, (close) => [
    el("p", { text: sentence }),
    el(
      "div", { class: "row end" },
      el("button", { type: "button", text: "Cancel", on: { click: () => close(false) } }),
      el("button", {
        type: "button", class: danger ? "danger" : "primary", text: agree, autofocus: true,
        on: { click: () => close(true) },
      }),
    ),
  ]);
  return answer === true;
}

const MESSAGE_TIME = 8000; // [ms]

/** A message at the edge of the page, read out by screen readers. kind: "info" or "error". */
export function notify(sentence, kind = "info") {
  const list = document.getElementById("messages");
  const message = el(
    "div", { class: `message ${kind}` },
    el("span", { text: sentence }),
    el("button", { type: "button", class: "plain", "aria-label": "Close the message", text: "×", on: { click: () => message.remove() } }),
  );
  while (list.children.length >= 4) list.firstChild.remove();
  list.append(message);
  setTimeout(() => message.remove(), MESSAGE_TIME);
}
