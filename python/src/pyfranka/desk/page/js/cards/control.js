// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Single point of control: the holder, requests for control, and the holder's answer.
import { pressCircle } from "./guiding.js";
import { confirmed } from "../dialogs.js";
import { el, renderIfChanged } from "../dom.js";

export function takeOrRelease(robot) {
  if (!robot.control.tokens) return undefined;
  if (robot.inControl) return robot.changeControl("release");
  return robot.changeControl(robot.isWaiting ? "withdraw" : "take");
}

async function force(robot) {
  const sentence = `${robot.control.owner} loses control, and the FCI is switched off. Confirm it with the circle button at the robot.`;
  if (await confirmed("Take over by force?", sentence, "Take over", true)) await robot.changeControl("force");
}

const button = (text, click, kind = "") => el("button", { type: "button", class: kind, text, on: { click } });

/** The sentence and the buttons of the banner for each situation. */
function contents(robot) {
  const { owner, request } = robot.control;
  if (robot.isWaiting && request.force) {
    return ["forced", `Press the circle button of the Pilot to take over control from ${owner}.`, [
      el("span", { class: "countdown" }),
      button("Press circle", () => pressCircle(robot), "primary"),
      button("Cancel", () => robot.changeControl("withdraw"))]];
  }
  if (robot.isWaiting) {
    return ["waiting", `${owner} was asked to hand over control.`, [
      button("Take over by force", () => force(robot)), button("Cancel", () => robot.changeControl("withdraw"))]];
  }
  if (robot.inControl && request && !request.force) {
    return ["asked", `${request.owner} requests control of ${robot.label}.`, [
      button("Accept", () => robot.changeControl("accept"), "primary"), button("Deny", () => robot.changeControl("deny"))]];
  }
  if (robot.inControl && request) {
    return ["asked", `${request.owner} takes over control by force, if the circle button is pressed.`, []];
  }
  if (robot.inControl) return ["mine", `You control ${robot.label}.`, [button("Release control", () => takeOrRelease(robot))]];
  if (owner) {
    return ["watching", `${owner} controls ${robot.label}. You can watch it.`, [
      button("Request control", () => robot.changeControl("take"), "primary"), button("Take over by force", () => force(robot))]];
  }
  return ["free", `No user controls ${robot.label}. You can watch it.`, [button("Take control", () => takeOrRelease(robot), "primary")]];
}

export function controlBanner(robot) {
  const element = el("div", { class: "banner", role: "status" });
  const update = () => {
    element.hidden = !robot.control.tokens;
    if (element.hidden) return;
    const { owner, id, request } = robot.control;
    const key = JSON.stringify([owner, id, request?.id, request?.force, robot.held?.id, robot.label]);
    renderIfChanged(element, key, () => {
      const [situation, sentence, buttons] = contents(robot);
      element.dataset.situation = situation;
      return [el("p", { text: sentence }), el("div", { class: "row" }, ...buttons)];
    });
    const countdown = element.querySelector(".countdown");
    if (countdown && request?.left !== undefined) countdown.textContent = `${Math.ceil(request.left)} s left`;
  };
  return { element, update };
}
