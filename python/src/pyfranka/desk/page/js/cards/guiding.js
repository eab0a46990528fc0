// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Guiding by hand, and the buttons at the robot's wrist: the Pilot.
import { actionButton, card, choice, holdButton, toggle } from "../controls.js";
import { el, setHidden, setText } from "../dom.js";
import * as icons from "../icons.js";

const AXES = ["x", "y", "z", "Rotation x", "Rotation y", "Rotation z", "Elbow"];

/** Whether the robot's rules allow guiding; closed brakes are another matter. */
function mayGuide({ type, inputs, operating_mode: mode, rules }) {
  return rules !== "desk" || (type === "panda" ? inputs.x4 : mode === "programming");
}

export const switchGuiding = (robot, on) => robot.command("guiding", on ? "on" : "off");

export function guidingCard(robot) {
  const axes = AXES.map((name, i) => axisBox(robot, name, i));
  const user = el("fieldset", { class: "axes" }, el("legend", { text: "Free axes" }), ...axes.map((axis) => axis.element));
  const hint = el("p", { class: "hint" });
  const element = card("Guiding", [
    toggle(robot, "Guide by hand", (report) => report.guiding.active, (on) => switchGuiding(robot, on), { enabled: mayGuide }),
    hint,
    choice(robot, "Guiding mode", [["free", "Free"], ["translation", "Translation"], ["rotation", "Rotation"], ["user", "User"]],
      (report) => report.guiding.mode, (mode) => setMode(robot, mode)),
    user,
  ]);
  const update = ({ report, inControl }) => {
    if (!report) return;
    setHidden(hint, report.guiding.active || mayGuide(report));
    setText(hint, report.type === "panda" ? "Press the activation device (X4, Safety) first." : "Switch to Programming first.");
    user.hidden = report.guiding.mode !== "user";
    user.disabled = !inControl;
    axes.forEach(({ input }, i) => (input.checked = report.guiding.axes[i]));
  };
  return { element, update };
}

const words = (axes) => axes.map((free) => (free ? "on" : "off"));

function setMode(robot, mode) {
  return robot.command("guiding_mode", mode, ...(mode === "user" ? words(robot.report.guiding.axes) : []));
}

function axisBox(robot, name, i) {
  const change = () => {
    const axes = [...robot.report.guiding.axes];
    axes[i] = input.checked;
    robot.command("guiding_mode", "user", ...words(axes));
  };
  const input = el("input", { type: "checkbox", on: { change } });
  return { input, element: el("label", { class: "check" }, input, el("span", { text: name })) };
}

const BUTTONS = ["up", "left", "check", "right", "down", "cross", "circle"];
const LABELS = { check: "Check button", cross: "Cross button", circle: "Circle button", up: "Up", down: "Down", left: "Left", right: "Right" };

export function pilotCard(robot) {
  const pad = el("div", { class: "pilot", role: "group", "aria-label": "Buttons of the Pilot" });
  for (const name of BUTTONS) {
    const press = (on) => robot.command("button", name, on ? "on" : "off");
    pad.append(holdButton(robot, icons[name](), LABELS[name], (report) => report.buttons[name], press, { class: `hold pilot-${name}` }));
  }
  const element = card("Pilot", [
    pad,
    el("div", { class: "row" },
      actionButton(robot, "Confirm with circle", (each) => pressCircle(each), { free: true, title: "Presses and releases the circle button, which confirms a forced take-over of control" }),
      holdButton(robot, el("span", { text: "Hold: guiding button" }), "Guiding enable button, as long as it is held", (report) => report.inputs.guiding,
        (on) => robot.command("input", "guiding", on ? "on" : "off")),
    ),
    choice(robot, "The arrows move through", [["desk", "Desk"], ["robot", "End effector"]],
      (report) => report.navigation, (mode) => robot.command("navigation", mode)),
  ], { open: false });
  return { element, update() {} };
}

/** Presses the circle button for a moment. */
export async function pressCircle(robot) {
  await robot.command("button", "circle", "on");
  await new Promise((resolve) => setTimeout(resolve, 150));
  await robot.command("button", "circle", "off");
}
