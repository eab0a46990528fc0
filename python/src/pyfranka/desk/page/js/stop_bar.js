// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The user stops, always in reach at the edge of the page.
import { el, setAttribute, setText } from "./dom.js";
import * as icons from "./icons.js";

/** Presses the user stop, or releases it and the other stops. */
export async function pressStop(robot, on) {
  const others = on ? [] : robot.pressedStops;
  await robot.command("user_stop", on ? "on" : "off");
  for (const name of others) await robot.command("input", name, "off");
}

function stopButton(robot, several) {
  const text = el("span");
  const button = el("button", {
    type: "button", class: "stop", "aria-pressed": "false",
    on: { click: () => pressStop(robot, !robot.isStopped) },
  }, icons.stop(), text);
  const update = () => {
    const name = several ? ` ${robot.label}` : "";
    setText(text, robot.isStopped ? `Release stop${name}` : `Stop${name}`);
    setAttribute(button, "aria-pressed", robot.isStopped);
    button.disabled = robot.report === null;
  };
  return { element: button, update };
}

export function stopBar(robots) {
  const buttons = robots.map((robot) => robot.add(stopButton(robot, robots.length > 1)));
  return el("div", { class: "stop-bar", role: "region", "aria-label": "User stop" }, ...buttons);
}
