// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Brakes: lock and unlock, and the state of each joint's brake.
import { actionButton, card } from "../controls.js";
import { el, setAttribute, setText } from "../dom.js";
import * as icons from "../icons.js";

export const unlock = (robot) => robot.command("joints", "unlock");
export const lock = (robot) => robot.command("joints", "lock");

function brakeList() {
  const items = [1, 2, 3, 4, 5, 6, 7].map((joint) =>
    el("li", { data: { locked: "true" } }, el("span", { class: "joint", text: `J${joint}` }), el("span", { class: "when-locked" }, icons.locked()), el("span", { class: "when-open" }, icons.unlocked()), el("span", { class: "hidden-text" })));
  const update = (report) =>
    items.forEach((item, i) => {
      setAttribute(item, "data-locked", report.brakes[i]);
      setText(item.lastChild, report.brakes[i] ? "locked" : "unlocked");
    });
  return { element: el("ul", { class: "brakes", "aria-label": "Brakes of the joints" }, ...items), update };
}

export function jointsCard(robot) {
  const brakes = brakeList();
  const state = el("p", { class: "state", "aria-live": "polite" });
  const element = card("Joints", [
    el("div", { class: "row" },
      actionButton(robot, "Unlock", unlock, { class: "primary", icon: icons.unlocked(), enabled: (report) => report.power && !report.brakes_moving && report.brakes.some(Boolean) }),
      actionButton(robot, "Lock", lock, { free: true, icon: icons.locked(), enabled: (report) => report.power && !report.brakes_moving && !report.brakes.every(Boolean) }),
      state,
    ),
    brakes.element,
  ]);
  const update = ({ report }) => {
    if (!report) return;
    brakes.update(report);
    const closed = report.brakes.filter(Boolean).length;
    setText(state, report.brakes_moving ? `${7 - closed} of 7 open …` : closed === 7 ? "Locked" : closed === 0 ? "Unlocked" : `${closed} of 7 locked`);
  };
  return { element, update };
}
