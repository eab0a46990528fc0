// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Pushing a body with the pointer: a spring from the grabbed point to the pointer.
import * as THREE from "three";
import { number } from "../format.js";

const STIFFNESS = 150; // [N/m] (chosen here: a hand's width is about 15 N)
export const MAX_FORCE = 60; // [N] (chosen here)
const PERIOD = 50; // [ms] of one push
const METRES_PER_NEWTON = 0.006; // of the arrow
const MIN_FORCE = 0.5; // [N] that is drawn and sent

export class PushTool {
  /** push(body, [fx, fy, fz], milliseconds): sends a push; label: an element for the force. */
  constructor({ scene, camera, canvas, push, label, redraw }) {
    Object.assign(this, { camera, canvas, push, label, redraw });
    this.arrow = new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 0.1, 0xff7a1a, 0.06, 0.035);
    this.arrow.visible = false;
    for (const part of [this.arrow.line, this.arrow.cone]) {
      part.material.depthTest = false;
      part.renderOrder = 2;
    }
    scene.add(this.arrow);
    this.ray = new THREE.Raycaster();
    this.force = new THREE.Vector3();
  }

  get active() {
    return this.body !== undefined;
  }

  aim(event) {
    const box = this.canvas.getBoundingClientRect();
    const x = ((event.clientX - box.left) / box.width) * 2 - 1;
    const y = 1 - ((event.clientY - box.top) / box.height) * 2;
    this.ray.setFromCamera(new THREE.Vector2(x, y), this.camera);
  }

  /** Grabs the body under the pointer; `bodies`: groups with a name. Returns whether there is one. */
  grab(event, bodies) {
    this.aim(event);
    const hit = this.ray.intersectObjects(bodies, true).find((each) => each.object.visible);
    if (!hit) return false;
    let group = hit.object;
    while (group && !group.userData.movable) group = group.parent;
    if (!group) return false;
    this.body = group;
    this.anchor = group.worldToLocal(hit.point.clone()); // moves with the body
    this.plane = new THREE.Plane().setFromNormalAndCoplanarPoint(this.camera.getWorldDirection(new THREE.Vector3()), hit.point);
    this.target = hit.point.clone();
    this.timer = setInterval(() => this.send(), PERIOD);
    this.update();
    return true;
  }

  move(event) {
    this.aim(event);
    this.ray.ray.intersectPlane(this.plane, this.target);
    this.update();
  }

  release() {
    if (!this.active) return;
    clearInterval(this.timer);
    this.body = undefined;
    this.arrow.visible = false;
    this.label.hidden = true;
    this.redraw();
  }

  /** Computes the force and draws it; called when the pointer or the body has moved. */
  update() {
    if (!this.active) return;
    const from = this.body.localToWorld(this.anchor.clone());
    this.force.subVectors(this.target, from).multiplyScalar(STIFFNESS).clampLength(0, MAX_FORCE);
    const strength = this.force.length();
    this.arrow.visible = strength > MIN_FORCE;
    if (this.arrow.visible) {
      this.arrow.position.copy(from);
      this.arrow.setDirection(this.force.clone().normalize());
      this.arrow.setLength(Math.max(0.08, strength * METRES_PER_NEWTON), 0.06, 0.035);
    }
    this.write(from, strength);
    this.redraw();
  }

  write(from, strength) {
    const at = from.clone().project(this.camera);
    const { clientWidth: width, clientHeight: height } = this.canvas;
    this.label.hidden = false;
    this.label.style.transform = `translate(${((at.x + 1) / 2) * width + 14}px, ${((1 - at.y) / 2) * height - 14}px)`;
    const [x, y, z] = this.force.toArray().map((value) => number(value, 1));
    this.label.textContent = `${number(strength, 1)} N  (${x}, ${y}, ${z})`;
  }

  send() {
    if (!this.active || this.force.length() < MIN_FORCE || this.waiting) return;
    this.waiting = true;
    Promise.resolve(this.push(this.body.name, this.force.toArray(), PERIOD)).finally(() => (this.waiting = false));
  }
}
