// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Errors in words, with recovery and acknowledgment.
import { actionButton, card } from "../controls.js";
import { el, renderIfChanged, setHidden } from "../dom.js";
import * as icons from "../icons.js";
import { errorSentence, recoverableSentence } from "../words.js";

export const recover = (robot) => robot.command("recover");

function entry(sentence, detail, name, button) {
  return el("li", {},
    icons.warning(),
    el("div", {}, el("strong", { text: sentence }), detail ? el("p", { text: detail }) : null, el("code", { text: name })),
    button,
  );
}

function acknowledgeButton(robot, name) {
  const button = el("button", { type: "button", text: "Acknowledge", on: { click: () => robot.command("acknowledge", name) } });
  button.disabled = !robot.inControl;
  return button;
}

function jointSentences(report) {
  const named = (flags, what, name) => flags.flatMap((set, i) => (set ? [[`Joint ${i + 1} ${what}`, "Hold the enabling device (X4) to acknowledge it.", name]] : []));
  return [
    ...named(report.joint_limit_violation, "is beyond its limit.", "jointLimitViolation"),
    ...named(report.joint_position_error, "has lost its position.", "jointPositionErrorDemand"),
  ];
}

function entries(robot) {
  const { report } = robot;
  return [
    ...(report.fault ? [entry(report.fault, "", "world", null)] : []),
    ...report.errors.map((name) => entry(errorSentence(name), report.details[name], name, null)),
    ...report.recoverable.map((name) => entry(recoverableSentence(name), "", name, acknowledgeButton(robot, name))),
    ...jointSentences(report).map((parts) => entry(...parts, acknowledgeButton(robot, parts[2]))),
  ];
}

export function errorsCard(robot) {
  const list = el("ul", { class: "errors", "aria-live": "assertive" });
  const none = el("p", { class: "state good", text: "No errors." });
  const button = actionButton(robot, "Recover", recover, { class: "primary", enabled: (report) => report.errors.length > 0 || report.mode === "Reflex" });
  const element = card("Errors", [none, list, button]);
  const update = ({ report, inControl }) => {
    if (!report) return;
    const { errors, details, recoverable, fault, joint_limit_violation: limits, joint_position_error: positions } = report;
    renderIfChanged(list, JSON.stringify([errors, details, recoverable, fault, limits, positions, inControl]), () => entries(robot));
    setHidden(none, list.children.length > 0);
    setHidden(button, errors.length === 0 && report.mode !== "Reflex");
    element.classList.toggle("alarm", list.children.length > 0);
  };
  return { element, update };
}
