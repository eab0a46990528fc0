// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The page: login, then the robots side by side.
import * as api from "./api.js";
import { takeOrRelease } from "./cards/control.js";
import { recover } from "./cards/errors.js";
import { switchFci } from "./cards/fci.js";
import { switchGuiding } from "./cards/guiding.js";
import { lock, unlock } from "./cards/joints.js";
import { showDialog, notify } from "./dialogs.js";
import { el, setText } from "./dom.js";
import * as icons from "./icons.js";
import { Live } from "./live.js";
import { showLogin } from "./login.js";
import { Robot } from "./robot.js";
import { robotPanel } from "./robot_panel.js";
import { listenForShortcuts, SHORTCUTS, shortcutsOn, switchShortcuts } from "./shortcuts.js";
import { pressStop, stopBar } from "./stop_bar.js";
import { choice, nextTheme, startTheme } from "./theme.js";
import { WorldPanel } from "./world_panel.js";

const place = document.getElementById("content");

class Page {
  constructor({ user, robots, meshes }) {
    this.user = user;
    this.meshes = meshes;
    this.robots = robots.map((listed) => new Robot(listed, user));
    this.panels = new Map(); // world panels by the number of their first robot
    this.selected = 0;
    this.frames = 0; // received so far, for tests
    this.build();
    this.live = new Live({
      onFrame: (frame) => this.onFrame(frame),
      onConnection: (connected) => this.showConnection(connected),
      onLoginEnded: () => start("Your login has ended. The robot was rebooted, or you have logged out elsewhere."),
    });
  }

  build() {
    this.worlds = el("div", { class: "worlds" });
    const panels = this.robots.map((robot) => robotPanel(robot));
    const several = this.robots.length > 1;
    place.replaceChildren(el("div", { class: several ? "layout several" : "layout single" }, this.worlds, el("div", { class: "robots" }, ...panels)), stopBar(this.robots));
    document.title = `Desk – ${this.robots.map((robot) => robot.label).join(", ")}`;
    setText(document.getElementById("user"), this.user);
    document.getElementById("log-out").hidden = false;
  }

  onFrame({ robots, worlds }) {
    this.frames += 1;
    this.robots.forEach((robot, i) => robot.receive(robots[i]));
    const numbers = worlds.map((world) => world.robots[0]);
    for (const [number, panel] of this.panels) {
      if (numbers.includes(number)) continue;
      panel.element.remove();
      this.panels.delete(number);
    }
    for (const world of worlds) this.panelOf(world.robots[0]).update(world);
  }

  panelOf(number) {
    if (!this.panels.has(number)) {
      const panel = new WorldPanel(number, this.robots, this.meshes);
      this.panels.set(number, panel);
      this.worlds.append(panel.element);
    }
    return this.panels.get(number);
  }

  showConnection(connected) {
    const state = document.getElementById("connection");
    state.dataset.connected = String(connected);
    setText(state, connected ? "Live" : "Connecting …");
    if (connected) return;
    for (const robot of this.robots) robot.receive({ report: null, problem: "The connection to Desk is interrupted." });
  }

  get robot() {
    return this.robots[this.selected];
  }

  select(index) {
    if (!this.robots[index]) return;
    this.selected = index;
    const section = document.querySelector(`[data-robot="${index}"]`);
    section.scrollIntoView({ block: "nearest" });
    section.querySelector("button:not(:disabled)")?.focus();
    notify(`Shortcuts act on ${this.robot.label}.`);
  }

  /** Where a body is on the page [px], for tests: null while it is unknown. */
  project(body) {
    for (const { view } of this.panels.values()) {
      const at = view?.project(body);
      if (at) return at;
    }
    return null;
  }

  end() {
    this.live.end();
  }
}

let page = null; // also window.desk, for tests and the console

async function start(reason = "") {
  page?.end();
  page = window.desk = null;
  document.getElementById("log-out").hidden = true;
  setText(document.getElementById("user"), "");
  setText(document.getElementById("connection"), "");
  const { user } = await api.get("/page/session");
  if (!user) await showLogin(place, reason);
  page = window.desk = new Page(await api.get("/page/robots"));
}

async function logOut() {
  await api.post("/page/logout").catch(() => {});
  await start("You have logged out.");
}

function showHelp() {
  const box = el("input", { type: "checkbox", on: { change: (event) => switchShortcuts(event.target.checked) } });
  box.checked = shortcutsOn();
  return showDialog("Keyboard shortcuts", (close) => [
    el("dl", { class: "shortcuts" }, ...SHORTCUTS.map(([key, what]) => el("div", {}, el("dt", {}, el("kbd", { text: key })), el("dd", { text: what })))),
    el("p", { class: "state", text: "In the 3D view arrow keys turn the view, + and − zoom, 0 resets it. Tab and Shift+Tab go through all controls." }),
    el("label", { class: "check" }, box, el("span", { text: "Use these shortcuts" })),
    el("div", { class: "row end" }, el("button", { type: "button", class: "primary", text: "Close", autofocus: true, on: { click: () => close() } })),
  ]);
}

function changeTheme() {
  const chosen = nextTheme();
  showTheme();
  notify(`Colors: ${chosen === "auto" ? "as the system" : chosen}.`);
}

function showTheme() {
  document.getElementById("theme").setAttribute("aria-label", `Colors: ${choice()}. Change them`);
}

function connectHeader() {
  const buttons = { theme: [icons.theme, changeTheme], help: [icons.help, showHelp], "log-out": [icons.leave, logOut] };
  for (const [id, [icon, action]] of Object.entries(buttons)) {
    const button = document.getElementById(id);
    button.append(icon());
    button.addEventListener("click", action);
  }
  showTheme();
}

function connectShortcuts() {
  const withRobot = (action) => () => page && action(page.robot);
  const handlers = {
    s: () => page?.robots.forEach((robot) => pressStop(robot, true)),
    u: withRobot(unlock),
    l: withRobot(lock),
    f: withRobot((robot) => robot.report && switchFci(robot, !robot.report.fci)),
    g: withRobot((robot) => robot.report && switchGuiding(robot, !robot.report.guiding.active)),
    r: withRobot(recover),
    c: withRobot(takeOrRelease),
    v: () => document.querySelector(".view canvas")?.focus(),
    t: changeTheme,
    "?": showHelp,
  };
  for (let i = 0; i < 9; i++) handlers[String(i + 1)] = () => page?.select(i);
  listenForShortcuts(handlers);
}

startTheme();
connectHeader();
connectShortcuts();
start().catch((error) => notify(error.message, "error"));
