// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// One robot of the page: its newest report, control of it, and commands to it.
import * as api from "./api.js";
import { notify } from "./dialogs.js";
import { History } from "./history.js";
import { ADVICE, kindOf } from "./words.js";

// Inputs that stop a robot. X4 of an FR3 is its enabling device.
const STOPS = { panda: ["x4"], fr3: ["x31", "x32", "x33"] };

export class Robot {
  /** listed: the robot's entry in /page/robots. user: the user that is logged in. */
  constructor(listed, user) {
    this.index = listed.index;
    this.name = listed.name;
    this.address = listed.address;
    this.type = listed.type;
    this.user = user;
    this.report = null;
    this.problem = "";
    this.control = { tokens: true, owner: null, id: null, request: null };
    this.history = new History();
    this.parts = []; // objects with update(robot)
    this.storageKey = `desk-control-${this.index}-${this.address}`;
    this.held = JSON.parse(localStorage.getItem(this.storageKey) ?? "null"); // {id, token}
  }

  get label() {
    return this.report?.arm_id || this.name;
  }

  get kind() {
    return kindOf(this.report?.type || this.type);
  }

  /** Whether this page may act: it holds control, or the robot's generation has no control token. */
  get inControl() {
    return !this.control.tokens || (this.held !== null && this.held.id === this.control.id);
  }

  /** Whether this page has requested control and waits. */
  get isWaiting() {
    return this.held !== null && this.control.request?.id === this.held.id;
  }

  get isUnlocked() {
    return this.report !== null && this.report.brakes.every((closed) => !closed);
  }

  /** The stops that are pressed. */
  get pressedStops() {
    return this.report ? (STOPS[this.report.type] ?? []).filter((name) => this.report.inputs[name]) : [];
  }

  get isStopped() {
    return this.pressedStops.length > 0 || this.report?.mode === "User stopped";
  }

  add(part) {
    this.parts.push(part);
    return part.element;
  }

  /** Takes the data of this robot from the stream. */
  receive({ report, problem, control }) {
    const before = this.isWaiting;
    this.report = report;
    this.problem = problem || "";
    if (control) this.control = control;
    if (before && this.inControl) notify(`You control ${this.label} now.`);
    if (report) this.history.add(performance.now() / 1000, report);
    for (const part of this.parts) part.update(this);
  }

  refresh() {
    for (const part of this.parts) part.update(this);
  }

  /** Sends a command; a refusal is shown as a message. Returns its value, or undefined if it was refused. */
  async command(action, ...words) {
    try {
      const answer = await this.tryCommand(action, ...words);
      return answer.value ?? "";
    } catch (refusal) {
      this.explain(refusal);
      return undefined;
    }
  }

  /** Sends a command; throws Refusal. */
  async tryCommand(action, ...words) {
    const answer = await api.post("/page/command", { robot: this.index, action, words }, this.held?.token);
    if (answer.refused) throw new api.Refusal(200, answer.refused);
    return answer;
  }

  explain(refusal) {
    const advice = ADVICE[refusal.code];
    const sentence = advice && !refusal.message.includes(advice) ? `${refusal.message} ${advice}` : refusal.message;
    notify(`${this.label}: ${sentence}`, "error");
  }

  /** Requests, releases, grants or denies control. what: take, force, release, withdraw, accept or deny. */
  async changeControl(what) {
    try {
      const answer = await api.post("/page/control", { robot: this.index, what }, this.held?.token);
      if (what === "take" || what === "force") this.hold({ id: answer.id, token: answer.token });
      if (what === "release" || what === "withdraw") this.hold(null);
      if (answer.control) this.control = answer.control;
    } catch (refusal) {
      this.explain(refusal);
    }
    this.refresh();
  }

  hold(held) {
    this.held = held;
    if (held) localStorage.setItem(this.storageKey, JSON.stringify(held));
    else localStorage.removeItem(this.storageKey);
  }
}
