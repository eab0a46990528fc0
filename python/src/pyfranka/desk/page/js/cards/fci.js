// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The FCI: whether clients may control the robot over the network.
import { card, choice, toggle } from "../controls.js";
import { confirmed } from "../dialogs.js";
import { el, setHidden, setText } from "../dom.js";

export async function switchFci(robot, on) {
  const agreed = on
    ? await confirmed("Activate the FCI?", `Programs on the network can then move ${robot.label}. Keep everyone out of its reach.`, "Activate")
    : await confirmed("Deactivate the FCI?", "A motion is stopped and its client is disconnected.", "Deactivate", true);
  if (agreed) await robot.command("fci", on ? "on" : "off");
}

export function fciCard(robot) {
  const client = el("p", { class: "state" });
  const mode = choice(robot, "Operating mode", [["execution", "Execution"], ["programming", "Programming"]],
    (report) => report.operating_mode, (chosen) => changeMode(robot, chosen), { enabled: (report) => report.power });
  const element = card("Franka Control Interface", [
    toggle(robot, "FCI active", (report) => report.fci, (on) => switchFci(robot, on), { enabled: (report) => report.power }),
    client,
    mode,
  ]);
  const update = ({ report }) => {
    if (!report) return;
    setHidden(mode, report.type === "panda"); // its activation device decides
    const quality = `${Math.round(100 * report.success_rate)} % of its commands arrive`;
    setText(client, report.client ? `A client of version ${report.client} is connected; ${quality}.` : "No client is connected.");
  };
  return { element, update };
}

async function changeMode(robot, mode) {
  if (mode === "programming" && robot.report.fci) {
    const agreed = await confirmed("Switch to Programming?", "This deactivates the FCI and ends the motion of its client.", "Switch", true);
    if (!agreed) return robot.refresh();
  }
  await robot.command("operating_mode", mode);
  robot.refresh();
}
