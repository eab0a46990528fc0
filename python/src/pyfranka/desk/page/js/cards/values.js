// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Joint positions, velocities, torques and the hand's pose as numbers.
import { card } from "../controls.js";
import { el, setText } from "../dom.js";
import { degrees, number } from "../format.js";
import { partsOf } from "../rotation.js";

const PERIOD = 100; // [ms] between two updates of the text
const JOINTS = [1, 2, 3, 4, 5, 6, 7];

function jointTable() {
  const cells = JOINTS.map(() => [el("td"), el("td"), el("td"), el("td")]);
  const heads = ["Joint", "Position", "Velocity", "Torque", "External"].map((text) => el("th", { scope: "col", text }));
  const units = ["", "°", "°/s", "Nm", "Nm"].map((text) => el("td", { class: "unit", text }));
  const rows = JOINTS.map((joint, i) => el("tr", {}, el("th", { scope: "row", text: `J${joint}` }), ...cells[i]));
  const element = el("table", { class: "values" },
    el("caption", { class: "hidden-text", text: "Values of the joints" }),
    el("thead", {}, el("tr", {}, ...heads), el("tr", { "aria-hidden": "true" }, ...units)), el("tbody", {}, ...rows));
  const update = (report) =>
    cells.forEach((row, i) => {
      setText(row[0], number((report.q[i] * 180) / Math.PI, 2));
      setText(row[1], number((report.dq[i] * 180) / Math.PI, 1));
      setText(row[2], number(report.tau_J[i], 1));
      setText(row[3], number(report.tau_ext[i], 1));
    });
  return { element, update };
}

function poseList() {
  const names = ["x", "y", "z", "Roll", "Pitch", "Yaw", "Force", "Moment"];
  const values = names.map(() => el("dd", { text: "–" }));
  const element = el("dl", { class: "pose" }, ...names.map((name, i) => el("div", {}, el("dt", { text: name }), values[i])));
  const update = (report) => {
    const { translation, rotation } = partsOf(report.O_T_EE);
    const wrench = report.O_F_ext;
    const texts = [
      ...translation.map((value) => `${number(value, 4)} m`), ...rotation.map(degrees),
      `${number(Math.hypot(...wrench.slice(0, 3)), 1)} N`, `${number(Math.hypot(...wrench.slice(3)), 1)} Nm`,
    ];
    texts.forEach((text, i) => setText(values[i], text));
  };
  return { element, update };
}

export function valuesCard() {
  const [table, pose] = [jointTable(), poseList()];
  const element = card("Values", [el("div", { class: "scroll-x", tabindex: "0", role: "region", "aria-label": "Values of the joints" }, table.element), el("h4", { text: "End effector in the base frame" }), pose.element]);
  let drawn = 0;
  const update = ({ report }) => {
    if (!report || performance.now() - drawn < PERIOD) return;
    drawn = performance.now();
    table.update(report);
    pose.update(report);
  };
  return { element, update };
}
