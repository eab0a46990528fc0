// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Safety inputs and the self-test.
import { actionButton, card, toggle } from "../controls.js";
import { confirmed } from "../dialogs.js";
import { el, setText } from "../dom.js";
import { duration } from "../format.js";

const INPUTS = [
  ["x31", "X3.1 emergency stop"],
  ["x32", "X3.2 stop"],
  ["x33", "X3.3 stop"],
  ["x4", "X4 activation device"],
];

/** The inputs represent devices beside the robot, so they need no control. */
function inputSwitch(robot, [name, text]) {
  if (name === "x4" && robot.type === "fr3") text = "X4 enabling device";
  return toggle(robot, text, (report) => report.inputs[name], (on) => robot.command("input", name, on ? "on" : "off"), { free: true });
}

async function runSelfTest(robot) {
  if (await confirmed("Run the self-test?", "The brakes close and the robot cannot move until the test has ended.", "Run")) {
    if (robot.report.recoverable.includes("td2Timeout")) await robot.command("acknowledge", "td2Timeout");
    await robot.command("self_test");
  }
}

export function safetyCard(robot) {
  const due = el("p", { class: "state", "aria-live": "polite" });
  const element = card("Safety", [
    el("div", { class: "switches" }, ...INPUTS.map((input) => inputSwitch(robot, input))),
    el("h4", { text: "Self-test" }),
    el("div", { class: "row" },
      actionButton(robot, "Acknowledge and run", runSelfTest, { enabled: (report) => report.power && !report.self_test.running, text: (report) => report.recoverable.includes("td2Timeout") ? "Acknowledge and run" : "Run now" }),
      due),
  ], { open: false });
  const update = ({ report }) => {
    if (!report) return;
    const { running, left, due: seconds } = report.self_test;
    setText(due, running ? `Running, ${duration(left)} left` : seconds > 0 ? `Due in ${duration(seconds)}` : "Overdue");
    due.classList.toggle("bad", !running && seconds <= 0);
  };
  return { element, update };
}
