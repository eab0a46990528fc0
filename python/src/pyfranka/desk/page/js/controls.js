// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Buttons, switches and fields that send a command and know when they may be used.
import { el, setAttribute, setText, uniqueId } from "./dom.js";

/** Whether a control may be used: control is needed unless `free`, and the robot must be there. */
function usable(robot, { free, enabled }) {
  return robot.report !== null && (free || robot.inControl) && (!enabled || enabled(robot.report, robot));
}

async function busily(button, work) {
  if (button.getAttribute("aria-busy") === "true") return;
  button.setAttribute("aria-busy", "true");
  try {
    await work();
  } finally {
    button.removeAttribute("aria-busy");
  }
}

/** A button that does `work(robot)`. options: class, free (needs no control), enabled(report, robot), label. */
export function actionButton(robot, text, work, options = {}) {
  const button = el(
    "button",
    { type: "button", class: options.class, title: options.title, "aria-label": options.label, on: { click: () => busily(button, () => work(robot)) } },
  );
  if (options.icon) button.append(options.icon);
  const label = el("span", { text });
  if (text) button.append(label);
  robot.parts.push({
    update: () => {
      button.disabled = !usable(robot, options);
      if (options.text && robot.report) setText(label, options.text(robot.report));
    },
  });
  return button;
}

/** A switch; `read(report)` says whether it is on, `change(on)` asks for it. */
export function toggle(robot, text, read, change, options = {}) {
  const button = el(
    "button",
    { type: "button", class: "switch", role: "switch", "aria-checked": "false", on: { click: () => busily(button, () => change(button.getAttribute("aria-checked") !== "true")) } },
    el("span", { class: "track" }), el("span", { class: "switch-text", text }),
  );
  robot.parts.push({
    update: () => {
      button.disabled = !usable(robot, options);
      if (robot.report) setAttribute(button, "aria-checked", read(robot.report));
    },
  });
  return button;
}

/** One of several: a row of radio buttons. choices: [value, text]. */
export function choice(robot, legend, choices, read, change, options = {}) {
  const name = uniqueId("choice");
  const inputs = choices.map(([value]) =>
    el("input", { type: "radio", name, value, on: { change: (event) => event.target.checked && change(value) } }));
  const labels = choices.map(([, text], i) => el("label", {}, inputs[i], el("span", { text })));
  const group = el("fieldset", { class: "segments" }, el("legend", { text: legend }), el("div", { class: "segments-row" }, ...labels));
  robot.parts.push({
    update: () => {
      group.disabled = !usable(robot, options);
      if (!robot.report || group.contains(document.activeElement) && group.matches(":focus-within:active")) return;
      for (const input of inputs) input.checked = input.value === read(robot.report);
    },
  });
  return group;
}

/** A button that is pressed as long as a finger, the mouse or a key holds it. press(on) sends it. */
export function holdButton(robot, content, label, read, press, options = {}) {
  let held = false;
  const hold = (on) => {
    if (on === held) return;
    held = on;
    press(on);
  };
  const isKey = (event) => event.key === "Enter" || event.key === " ";
  const button = el("button", {
    type: "button", class: options.class ?? "hold", "aria-label": label, title: label, "aria-pressed": "false",
    on: {
      pointerdown: (event) => {
        button.setPointerCapture(event.pointerId);
        hold(true);
      },
      pointerup: () => hold(false),
      pointercancel: () => hold(false),
      keydown: (event) => {
        if (!isKey(event)) return;
        event.preventDefault();
        if (!event.repeat) hold(true);
      },
      keyup: (event) => isKey(event) && hold(false),
      blur: () => hold(false),
      contextmenu: (event) => event.preventDefault(),
    },
  }, content);
  robot.parts.push({
    update: () => {
      const may = usable(robot, { free: true, ...options });
      if (!may) hold(false);
      button.disabled = !may;
      if (robot.report && read) setAttribute(button, "aria-pressed", read(robot.report));
    },
  });
  return button;
}

/** A field for a number with its unit. Returns {element, input, value()}; value() is NaN for no number. */
export function numberField(label, unit, value, options = {}) {
  const id = uniqueId("field");
  const input = el("input", {
    id, type: "number", step: options.step ?? "any", min: options.min, max: options.max, value, inputmode: "decimal",
    required: true, autocomplete: "off",
  });
  const element = el(
    "div", { class: "field" },
    el("label", { for: id, text: label }),
    el("span", { class: "with-unit", data: { unit: unit.length === 0 ? "none" : unit.length < 3 ? "short" : "long" } }, input, el("span", { class: "unit", text: unit })),
  );
  return { element, input, value: () => input.valueAsNumber };
}

/** A card with a title. options: open (a card that folds), id. */
export function card(title, children, options = {}) {
  const id = uniqueId("card");
  if (options.open !== undefined) {
    return el("details", { class: "card", open: options.open }, el("summary", {}, el("h3", { text: title })), ...children);
  }
  return el("section", { class: "card", "aria-labelledby": id }, el("h3", { id, text: title }), ...children);
}
