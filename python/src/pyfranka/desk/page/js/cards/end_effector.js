// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The end effector that the robot assumes.
import { actionButton, card, numberField, toggle } from "../controls.js";
import { el, setText } from "../dom.js";
import { notify } from "../dialogs.js";
import { partsOf, toDegrees, toRadians, transformOf } from "../rotation.js";

const INERTIA = [["Ixx", 0], ["Iyy", 4], ["Izz", 8], ["Ixy", 1], ["Ixz", 2], ["Iyz", 5]]; // entries of the 3x3 matrix
const round = (value, digits) => Number(value.toFixed(digits));

function makeFields() {
  return {
    mass: [numberField("Mass", "kg", 0, { min: 0, max: 10 })],
    center: ["x", "y", "z"].map((axis) => numberField(axis, "m", 0, { min: -1, max: 1 })),
    inertia: INERTIA.map(([name]) => numberField(name, "", 0, { min: -10, max: 10 })),
    translation: ["x", "y", "z"].map((axis) => numberField(axis, "m", 0, { min: -10, max: 10 })),
    rotation: ["Roll", "Pitch", "Yaw"].map((axis) => numberField(axis, "°", 0, { min: -180, max: 180 })),
  };
}

function fill(fields, effector) {
  const { translation, rotation } = partsOf(effector.F_T_NE);
  const set = (group, values, digits) => fields[group].forEach((field, i) => (field.input.value = round(values[i], digits)));
  set("mass", [effector.mass], 4);
  set("center", effector.center, 5);
  set("inertia", INERTIA.map(([, entry]) => effector.inertia[entry]), 6);
  set("translation", translation, 5);
  set("rotation", rotation.map(toDegrees), 3);
}

function wordsOf(fields) {
  const values = (group) => fields[group].map((field) => field.value());
  const [xx, yy, zz, xy, xz, yz] = values("inertia");
  return [
    ...values("mass"), ...values("center"), xx, xy, xz, xy, yy, yz, xz, yz, zz,
    ...transformOf(values("translation"), values("rotation").map(toRadians)),
  ].map(String);
}

const group = (title, fields) =>
  el("fieldset", { class: "fields narrow" }, el("legend", { text: title }), ...fields.map((field) => field.element));

export function endEffectorCard(robot) {
  const fields = makeFields();
  const state = el("p", { class: "state", "aria-live": "polite" });
  const all = Object.values(fields).flat();
  let key = "";
  const apply = async (each) => {
    if (!all.every((field) => field.input.reportValidity())) return;
    if ((await each.command("end_effector", ...wordsOf(fields))) === undefined) return;
    key = ""; // shows what the robot has accepted
    notify(`${each.label}: the end effector's settings are in force.`);
  };
  const reset = (each) => fill(fields, each.report.end_effector);
  const element = card("End effector", [
    toggle(robot, "Power", (report) => report.end_effector.power, (on) => robot.command("end_effector_power", on ? "on" : "off")),
    group("Mass", fields.mass), group("Center of mass, in the flange's frame", fields.center),
    group("Inertia about the center of mass [kg m²]", fields.inertia),
    group("Tool, from the flange: position", fields.translation), group("Tool, from the flange: orientation", fields.rotation),
    el("div", { class: "row" },
      actionButton(robot, "Apply", apply, { class: "primary" }),
      actionButton(robot, "Discard changes", reset, { free: true }), state),
  ], { open: false });
  element.classList.add("end-effector");
  const update = ({ report }) => {
    if (!report) return;
    const { mass, center, inertia, F_T_NE: frame } = report.end_effector;
    const now = JSON.stringify([mass, center, inertia, frame]);
    if (now !== key && !element.contains(document.activeElement)) fill(fields, report.end_effector);
    else if (now !== key && key === "") fill(fields, report.end_effector);
    key = now;
    setText(state, `In force: ${round(mass, 3)} kg`);
  };
  return { element, update };
}
