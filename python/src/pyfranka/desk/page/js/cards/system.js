// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Power of the robot, and faults for tests: both exist for simulated robots.
import { actionButton, card } from "../controls.js";
import { confirmed } from "../dialogs.js";
import { el, uniqueId } from "../dom.js";
import { recoverableSentence } from "../words.js";

const FAULTS = [
  "td2Timeout", "genericJointError", "safeInputErrorX31", "safeInputErrorX32", "safeInputErrorX33", "safeInputErrorX4",
  "guidingEnablingDevice", "environmentDataTimeout", "fsoeConnectionError",
];
const JOINT_FAULTS = [["jointLimitViolation", "A joint is beyond its limit."], ["jointPositionErrorDemand", "A joint has lost its position."]];

async function reboot(robot) {
  const sentence = "Motions stop, the brakes close, control is released and all logins end. Log in again after the boot.";
  if (await confirmed(`Reboot ${robot.label}?`, sentence, "Reboot", true)) await robot.command("reboot");
}

async function shutDown(robot) {
  if (await confirmed(`Shut down ${robot.label}?`, "Motions stop, the brakes close, and this page ends. The line power on of the control interface starts the robot again.", "Shut down", true)) {
    await robot.command("power", "off");
  }
}

export function systemCard(robot) {
  const element = card("System", [
    el("div", { class: "row" },
      actionButton(robot, "Reboot", reboot, { enabled: (report) => report.power }),
      actionButton(robot, "Shut down", shutDown, { class: "danger", enabled: (report) => report.power }),
      actionButton(robot, "Start", (each) => each.command("power", "on"), { free: true, enabled: (report) => !report.power })),
    el("h4", { text: "Inject an error" }),
    injector(robot),
  ], { open: false });
  return { element, update() {} };
}

function selectOf(label, options) {
  const id = uniqueId("select");
  const select = el("select", { id }, ...options.map(([value, text]) => el("option", { value, text })));
  return { select, element: el("div", { class: "field grow" }, el("label", { for: id, text: label }), select) };
}

function injector(robot) {
  const fault = selectOf("Error", [...FAULTS.map((name) => [name, recoverableSentence(name)]), ...JOINT_FAULTS]);
  const joint = selectOf("Joint", [1, 2, 3, 4, 5, 6, 7].map((number) => [String(number), `J${number}`]));
  const words = () => {
    const name = fault.select.value;
    return JOINT_FAULTS.some(([each]) => each === name) ? [name, joint.select.value] : [name];
  };
  const show = () => (joint.element.hidden = words().length === 1);
  fault.select.addEventListener("change", show);
  show();
  return el("div", {},
    el("div", { class: "row" }, fault.element, joint.element),
    el("div", { class: "row" },
      actionButton(robot, "Inject", (each) => each.command("inject", ...words(), "on"), { free: true }),
      actionButton(robot, "Remove", (each) => each.command("inject", ...words(), "off"), { free: true })),
  );
}
