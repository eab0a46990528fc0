// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Desk's own motions: to the pack pose, or to joint positions that the user types.
import { actionButton, card, numberField } from "../controls.js";
import { el, setText } from "../dom.js";
import { confirmed } from "../dialogs.js";
import { toDegrees, toRadians } from "../rotation.js";

const mayMove = (report) => report.power && !report.motion && report.brakes.every((closed) => !closed);

async function moveToPackPose(robot) {
  if (await confirmed("Move to the pack pose?", `${robot.label} folds its arm. Keep its path free.`, "Move")) {
    await robot.command("move", "pack");
  }
}

export function motionCard(robot) {
  const fields = [1, 2, 3, 4, 5, 6, 7].map((joint) => numberField(`J${joint}`, "°", 0, { min: -360, max: 360 }));
  const fill = () => fields.forEach((field, i) => (field.input.value = toDegrees(robot.report.q[i]).toFixed(1)));
  const go = async (each) => {
    if (!fields.every((field) => field.input.reportValidity())) return;
    if (!(await confirmed("Move to these joint positions?", `${each.label} moves on a straight line in joint space.`, "Move"))) return;
    await each.command("move", ...fields.map((field) => String(toRadians(field.value()))), "0.2");
  };
  const state = el("p", { class: "state", "aria-live": "polite" });
  const element = card("Motion", [
    el("div", { class: "row" },
      actionButton(robot, "Move to pack pose", moveToPackPose, { enabled: mayMove }),
      actionButton(robot, "Stop motion", (each) => each.command("move", "stop"), { class: "danger", free: true, enabled: (report) => report.motion }),
      state),
    el("div", { class: "fields narrow" }, ...fields.map((field) => field.element)),
    el("div", { class: "row" },
      actionButton(robot, "Use present positions", fill, { free: true }),
      actionButton(robot, "Move to these positions", go, { enabled: mayMove })),
  ], { open: false });
  let filled = false;
  const update = ({ report }) => {
    if (!report) return;
    if (!filled) fill();
    filled = true;
    setText(state, report.motion ? "Desk moves the arm." : "");
  };
  return { element, update };
}
