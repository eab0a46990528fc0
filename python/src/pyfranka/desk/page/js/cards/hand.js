// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The gripper: home, open to a width, grasp, stop.
import { actionButton, card, numberField } from "../controls.js";
import { el, setText } from "../dom.js";
import { notify } from "../dialogs.js";
import { number } from "../format.js";

const MM = 1000;

export function handCard(robot) {
  const width = numberField("Width", "mm", 80, { min: 0, max: 80, step: 1 });
  const speed = numberField("Speed", "mm/s", 50, { min: 1, max: 100, step: 1 });
  const force = numberField("Force", "N", 30, { min: 1, max: 140, step: 1 });
  const state = el("p", { class: "state", "aria-live": "polite" });
  const meters = (field) => String(field.value() / MM);
  const valid = (...fields) => fields.every((field) => field.input.reportValidity());
  const ready = (report) => report.hand.kind === "gripper" && report.hand.homed && !report.hand.busy;
  const element = card("Gripper", [
    state,
    el("div", { class: "fields" }, width.element, speed.element, force.element),
    el("div", { class: "row" },
      actionButton(robot, "Home", (each) => each.command("hand", "homing"), { enabled: (report) => report.hand.kind === "gripper" && !report.hand.busy }),
      actionButton(robot, "Move", (each) => valid(width, speed) && each.command("hand", "move", meters(width), meters(speed)), { enabled: ready }),
      actionButton(robot, "Grasp", (each) => valid(width, speed, force) && grasp(each, meters(width), meters(speed), String(force.value())), { enabled: ready }),
      actionButton(robot, "Stop", (each) => each.command("hand", "stop"), { enabled: (report) => report.hand.busy }),
    ),
  ], { open: false });
  const update = ({ report }) => {
    if (!report) return;
    setText(state, describe(report.hand));
    const largest = report.hand.max_width > 0 ? Math.round(MM * report.hand.max_width) : 80;
    if (width.input.max !== String(largest)) width.input.max = String(largest);
  };
  return { element, update };
}

async function grasp(robot, ...words) {
  const value = await robot.command("hand", "grasp", ...words);
  if (value !== undefined) notify(`${robot.label}: the gripper holds an object.`);
}

function describe(hand) {
  if (hand.kind === "none") return "This robot has no gripper.";
  if (hand.kind === "vacuum") return "A vacuum gripper; the FCI operates it.";
  const width = `${number(MM * hand.width, 1)} mm wide`;
  if (hand.busy) return `Moving, ${width}`;
  if (!hand.homed) return "Not homed. Home it once after power-up.";
  return hand.grasped ? `Holds an object, ${width}` : `Ready, ${width}`;
}
