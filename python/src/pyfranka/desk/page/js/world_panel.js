// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The card with the 3D view of one world, and the form that pushes a body without a pointer.
import * as api from "./api.js";
import { card, numberField } from "./controls.js";
import { el, uniqueId } from "./dom.js";
import { notify } from "./dialogs.js";

const PUSH_TIME = 300; // [ms] of one push of the form

export class WorldPanel {
  /** robots: all robots of the page, of which `number` is one of this world. */
  constructor(number, robots, installed) {
    Object.assign(this, { number, robots, installed });
    this.version = null;
    this.stage = el("div", { class: "view-box" }, el("p", { class: "state", text: "Loading the 3D view …" }));
    this.select = el("select", { id: uniqueId("body") });
    this.element = el("section", { class: "card view", "aria-label": "3D view" }, this.stage, this.makeTools());
  }

  makeTools() {
    const views = el("div", { class: "row view-tools" },
      el("button", { type: "button", class: "small", text: "Reset view", on: { click: () => this.view?.resetCamera() } }),
      el("span", { class: "hint", text: "Drag a link to push it, the background to turn the view." }));
    return el("div", {}, views, this.makePushForm());
  }

  makePushForm() {
    const forces = ["x", "y", "z"].map((axis) => numberField(axis, "N", axis === "x" ? 20 : 0, { min: -200, max: 200, step: 1 }));
    const push = () => {
      if (forces.every((field) => field.input.reportValidity())) this.push(this.select.value, forces.map((field) => field.value()), PUSH_TIME);
    };
    const body = el("div", { class: "field grow" }, el("label", { for: this.select.id, text: "Body" }), this.select);
    const form = card("Push with numbers", [
      el("div", { class: "fields" }, body, ...forces.map((field) => field.element)),
      el("div", { class: "row" }, el("button", { type: "button", text: `Push for ${PUSH_TIME} ms`, on: { click: push } })),
    ], { open: false });
    form.classList.add("inner");
    return form;
  }

  async push(body, force, milliseconds) {
    try {
      await this.robots[this.number].tryCommand("push", body, ...force.map(String), String(milliseconds));
    } catch (refusal) {
      const now = performance.now();
      if (now - (this.notifiedAt ?? -Infinity) > 3000) notify(refusal.message, "error");
      this.notifiedAt = now;
    }
  }

  async update({ version, poses }) {
    if (version !== this.version) {
      this.version = version;
      await this.load();
    }
    if (!this.view || !this.ready) return;
    this.view.setPoses(poses);
    this.view.setReports(Object.fromEntries(this.robots.filter((robot) => robot.report).map((robot) => [robot.report.arm_id, robot.report])));
  }

  async load() {
    this.ready = false;
    const version = this.version;
    try {
      const view = await this.makeView();
      const { scene } = await api.get(`/page/scene?robot=${this.number}`);
      const fetchMesh = (name) => api.getBytes(`/page/mesh?robot=${this.number}&version=${version}&name=${encodeURIComponent(name)}`);
      await view.load(scene, fetchMesh, this.installed);
      this.listBodies(scene);
      this.ready = version === this.version;
    } catch (error) {
      this.stage.replaceChildren(el("p", { class: "state", text: error.message }));
      this.view = undefined;
    }
  }

  listBodies({ bodies, shapes }) {
    const names = bodies.filter(({ name }, i) => i > 0 && name && shapes.some(({ body }) => body === i)).map(({ name }) => name);
    this.select.replaceChildren(...names.map((name) => el("option", { value: name, text: name })));
    const arm = this.robots[this.number].label;
    this.select.value = [`${arm}_hand`, `${arm}_link7`].find((name) => names.includes(name)) ?? names[0];
  }

  async makeView() {
    if (this.view) return this.view;
    let module;
    try {
      module = await import("./view/world_view.js");
    } catch {
      throw new Error("The 3D view needs three.js, which is not installed: run ./franka install.");
    }
    try {
      this.view = new module.WorldView((...words) => this.push(...words));
    } catch {
      throw new Error("The 3D view needs WebGL, which this browser does not offer.");
    }
    this.stage.replaceChildren(this.view.element);
    return this.view;
  }
}
