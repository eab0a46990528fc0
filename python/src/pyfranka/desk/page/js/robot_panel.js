// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Everything that belongs to one robot, without the 3D view.
import { controlBanner } from "./cards/control.js";
import { endEffectorCard } from "./cards/end_effector.js";
import { errorsCard } from "./cards/errors.js";
import { fciCard } from "./cards/fci.js";
import { guidingCard, pilotCard } from "./cards/guiding.js";
import { handCard } from "./cards/hand.js";
import { jointsCard } from "./cards/joints.js";
import { motionCard } from "./cards/motion.js";
import { safetyCard } from "./cards/safety.js";
import { systemCard } from "./cards/system.js";
import { valuesCard } from "./cards/values.js";
import { el, setAttribute, setHidden, setText, uniqueId } from "./dom.js";
import { externalPlot, forcePlot, torquePlot } from "./plots.js";

function heading(robot, id) {
  const light = el("span", { class: "light", role: "img" });
  const name = el("h2", { id });
  const mode = el("span", { class: "mode" });
  const element = el("header", { class: "robot-head" }, light, name, mode);
  const update = () => {
    const { report } = robot;
    setText(name, `${robot.label}`);
    setText(mode, report ? `${robot.kind} · ${robot.address} · ${report.power ? report.mode : "Off"}` : `${robot.address}`);
    const { color, blinking } = report?.light ?? { color: "off", blinking: false };
    setAttribute(light, "data-color", color);
    setAttribute(light, "data-blinking", blinking);
    setAttribute(light, "aria-label", `Light: ${color}${blinking ? ", blinking" : ""}`);
  };
  return { element, update };
}

function problemBox() {
  const element = el("p", { class: "problem", role: "alert", hidden: true });
  const update = ({ report, problem }) => {
    setHidden(element, report !== null);
    setText(element, report ? "" : problem || "The robot does not answer.");
  };
  return { element, update };
}

export function robotPanel(robot) {
  const id = uniqueId("robot");
  const add = (part) => robot.add(part);
  const cards = el("div", { class: "cards" },
    add(errorsCard(robot)), add(jointsCard(robot)), add(fciCard(robot)), add(guidingCard(robot)), add(motionCard(robot)),
    add(handCard(robot)), add(endEffectorCard(robot)), add(safetyCard(robot)), add(pilotCard(robot)), add(systemCard(robot)));
  const data = el("div", { class: "data" }, add(valuesCard()), el("div", { class: "plots" }, ...[torquePlot(), externalPlot(), forcePlot()].map(add)));
  const head = el("div", { class: "robot-top" }, add(heading(robot, id)), add(controlBanner(robot)), add(problemBox()));
  return el("section", { class: "robot", "aria-labelledby": id, data: { robot: robot.index } }, head, cards, data);
}
