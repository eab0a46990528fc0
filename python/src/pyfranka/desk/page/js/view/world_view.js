// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The live 3D view of one world. It draws only when something has changed.
import * as THREE from "three";
import { OrbitControls } from "three/addons/controls/OrbitControls.js";
import { el } from "../dom.js";
import { color, onColors } from "../theme.js";
import { PushTool } from "./push_tool.js";
import { addMeshes, BaseLight } from "./robot_look.js";
import { setPose, shapeObject } from "./shapes.js";

const SLOW = 25; // [ms] for a picture: a slower machine gets simpler ones, at the rate of the stream
const REST = 1.5; // pause after a picture, as a multiple of its drawing time: the page stays usable
const MEASURED_PICTURES = 20; // one picture in this many is timed, because waiting for its end takes time itself
const MIN_MOVE = 2e-4; // [m], and of a quaternion's numbers: below it nothing is drawn
const FRAME = 60; // [ms] between two frames of the stream, in which poses are interpolated
const TURN = 0.08; // [rad] of the camera for a key
const ZOOM = 1.1; // of its distance for a key
const MEASURED = 0x2f9de0; // color of the estimated external force
const MIN_FORCE = 2; // [N] that is drawn
const METRES_PER_NEWTON = 0.006;

export class WorldView {
  /** push(body, force, milliseconds): sends a push. */
  constructor(push) {
    this.label = el("div", { class: "force-label", hidden: true });
    this.canvas = el("canvas", { tabindex: "0", role: "img", "aria-label": "3D view of the robot. Arrow keys turn the view, plus and minus zoom, 0 resets it." });
    this.element = el("div", { class: "view-stage" }, this.canvas, this.label);
    this.bodies = [];
    this.lights = [];
    this.forces = [];
    this.cost = 0; // [ms] of a picture
    this.pictures = 0;
    this.drawnAt = 0;
    this.isSlow = false; // never reset, so that the picture does not change back and forth
    this.makeScene();
    this.makeTools(push);
    new ResizeObserver(() => this.resize()).observe(this.element);
    this.isSeen = true;
    new IntersectionObserver(([entry]) => this.see(entry.isIntersecting)).observe(this.element);
    onColors(() => this.applyColors());
    this.applyColors();
  }

  makeScene() {
    this.renderer = new THREE.WebGLRenderer({ canvas: this.canvas, antialias: true });
    this.renderer.setPixelRatio(Math.min(devicePixelRatio, 2));
    this.renderer.shadowMap.enabled = true;
    this.scene = new THREE.Scene();
    this.camera = new THREE.PerspectiveCamera(40, 1, 0.02, 60);
    this.camera.up.set(0, 0, 1);
    this.scene.add(new THREE.HemisphereLight(0xffffff, 0x8a8f98, 1.7));
    const sun = (this.sun = new THREE.DirectionalLight(0xffffff, 2.2));
    sun.position.set(1.5, -2, 4);
    sun.castShadow = true;
    sun.shadow.mapSize.set(1024, 1024);
    Object.assign(sun.shadow.camera, { left: -2, right: 2, top: 2, bottom: -2, near: 0.5, far: 9 });
    sun.shadow.bias = -0.001;
    sun.shadow.normalBias = 0.01; // without it surfaces that face the sun at a low angle get stripes
    this.scene.add(sun);
    this.world = new THREE.Group();
    this.scene.add(this.world);
  }

  makeTools(push) {
    const redraw = () => this.requestDraw();
    this.orbit = new OrbitControls(this.camera, this.canvas);
    this.orbit.addEventListener("change", redraw);
    this.orbit.minDistance = 0.2;
    this.orbit.maxDistance = 12;
    this.tool = new PushTool({ scene: this.scene, camera: this.camera, canvas: this.canvas, push, label: this.label, redraw });
    // Before the camera's handler, so that a body under the pointer is pushed and elsewhere the view turns.
    this.element.addEventListener("pointerdown", (event) => this.onPointerDown(event), { capture: true });
    this.canvas.addEventListener("pointermove", (event) => (this.tool.active ? this.tool.move(event) : this.hover(event)));
    for (const name of ["pointerup", "pointercancel", "lostpointercapture"]) {
      this.canvas.addEventListener(name, () => this.tool.release());
    }
    this.canvas.addEventListener("keydown", (event) => this.onKey(event));
  }

  onPointerDown(event) {
    if (event.target !== this.canvas || event.button !== 0 || !event.isPrimary) return;
    if (!this.tool.grab(event, this.bodies)) return;
    event.stopPropagation();
    event.preventDefault();
    this.canvas.focus({ preventScroll: true });
    this.canvas.setPointerCapture(event.pointerId);
  }

  hover(event) {
    if (event.buttons || event.pointerType !== "mouse") return;
    this.tool.aim(event);
    const hit = this.tool.ray.intersectObjects(this.bodies, true).find((each) => each.object.visible);
    let group = hit?.object;
    while (group && !group.userData.movable) group = group.parent;
    this.canvas.classList.toggle("grabbable", Boolean(group));
  }

  onKey(event) {
    const turns = { ArrowLeft: [-TURN, 0], ArrowRight: [TURN, 0], ArrowUp: [0, -TURN], ArrowDown: [0, TURN] };
    const zooms = { "+": 1 / ZOOM, "=": 1 / ZOOM, "-": ZOOM };
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (turns[event.key]) this.turn(...turns[event.key]);
    else if (zooms[event.key]) this.zoom(zooms[event.key]);
    else if (event.key === "0") this.resetCamera();
    else return;
    event.preventDefault();
  }

  turn(azimuth, polar) {
    const offset = this.camera.position.clone().sub(this.orbit.target);
    const spherical = new THREE.Spherical().setFromVector3(new THREE.Vector3(offset.x, offset.z, -offset.y));
    spherical.theta += azimuth;
    spherical.phi = Math.min(Math.PI - 0.05, Math.max(0.05, spherical.phi + polar));
    const turned = new THREE.Vector3().setFromSpherical(spherical);
    this.camera.position.set(turned.x, -turned.z, turned.y).add(this.orbit.target);
    this.orbit.update();
  }

  zoom(factor) {
    const offset = this.camera.position.clone().sub(this.orbit.target).multiplyScalar(factor);
    offset.clampLength(this.orbit.minDistance, this.orbit.maxDistance);
    this.camera.position.copy(this.orbit.target).add(offset);
    this.orbit.update();
  }

  // ---- contents ---------------------------------------------------------------------------------------------

  /** Replaces the world. fetchMesh(name): bytes of a mesh; installed: {type: names of robot meshes}. */
  async load(scene, fetchMesh, installed) {
    this.tool.release();
    this.world.clear();
    this.robots = scene.robots;
    this.bodies = scene.bodies.map(({ name }, i) => {
      const group = new THREE.Group();
      group.name = name;
      group.userData.movable = i > 0 && !/_link0$/.test(name);
      this.world.add(group);
      return group;
    });
    this.byName = new Map(this.bodies.map((body) => [body.name, body]));
    await Promise.all(scene.shapes.map((shape) => this.addShape(shape, fetchMesh)));
    this.addRobots(installed);
    this.resetPending = true; // the camera looks at the robots as soon as their poses are known
    this.requestDraw();
  }

  async addShape(shape, fetchMesh) {
    if (shape.color[3] === 0) return;
    const body = this.bodies[shape.body];
    const object = await shapeObject(shape, fetchMesh);
    object.userData.simple = shape.kind !== "mesh";
    if (shape.kind === "mesh") body.userData.hasMesh = true;
    body.add(object);
  }

  addRobots(installed) {
    const bodyOf = (name) => this.byName.get(name);
    this.lights = this.robots.map(({ arm_id: arm }) => {
      const base = bodyOf(`${arm}_link0`);
      return base ? [arm, new BaseLight(base)] : null;
    }).filter(Boolean);
    this.forces = this.robots.map(({ arm_id: arm }) => {
      const arrow = new THREE.ArrowHelper(new THREE.Vector3(1, 0, 0), new THREE.Vector3(), 0.1, MEASURED, 0.05, 0.03);
      arrow.visible = false;
      this.world.add(arrow);
      return [arm, arrow];
    });
    for (const robot of this.robots) {
      addMeshes(robot, bodyOf, installed[robot.type] ?? [], () => this.requestDraw());
    }
  }

  /** New poses of all bodies, in the order of the scene. */
  setPoses(poses) {
    if (!poses || poses.length !== this.bodies.length) return;
    if (!this.resetPending && this.areDrawn(poses)) return;
    const first = this.resetPending;
    this.drawnPoses = poses;
    this.moves = this.bodies.map((body, i) => {
      const move = { from: body.position.clone(), turned: body.quaternion.clone() };
      setPose(body, poses[i]);
      move.to = body.position.clone();
      move.turn = body.quaternion.clone();
      return move;
    });
    this.movedAt = performance.now();
    if (first) this.finishMoves();
    if (this.resetPending) this.resetCamera();
    this.resetPending = false;
    this.tool.update();
    this.requestDraw();
  }

  // Measured positions always have some noise.
  areDrawn(poses) {
    return this.drawnPoses?.length === poses.length &&
      poses.every((pose, i) => pose.every((value, k) => Math.abs(value - this.drawnPoses[i][k]) < MIN_MOVE));
  }

  /** Shows lights and estimated forces. reports: by arm_id. */
  setReports(reports) {
    const now = performance.now();
    let changed = false;
    for (const [arm, light] of this.lights) if (reports[arm]) changed = light.show(reports[arm].light, now) || changed;
    for (const [arm, arrow] of this.forces) if (reports[arm]) changed = this.showForce(arm, arrow, reports[arm]) || changed;
    if (changed) this.requestDraw();
  }

  showForce(arm, arrow, report) {
    const force = new THREE.Vector3(...report.O_F_ext.slice(0, 3));
    const strength = force.length();
    const was = arrow.visible;
    const shown = arrow.userData.force ?? new THREE.Vector3();
    if (was === strength > MIN_FORCE && force.distanceTo(shown) < 0.1 * MIN_FORCE) return false;
    arrow.userData.force = force.clone();
    arrow.visible = strength > MIN_FORCE;
    const base = this.byName.get(`${arm}_link0`);
    if (!arrow.visible || !base) return was;
    arrow.position.copy(base.localToWorld(new THREE.Vector3(...report.O_T_EE.slice(12, 15))));
    arrow.setDirection(force.normalize().applyQuaternion(base.quaternion));
    arrow.setLength(Math.max(0.06, strength * METRES_PER_NEWTON), 0.05, 0.03);
    return true;
  }

  // Between two frames of the stream bodies move evenly, on machines that draw fast enough.
  interpolate() {
    if (!this.moves) return false;
    const part = this.isSlow ? 1 : Math.min(1, (performance.now() - this.movedAt) / FRAME);
    this.moves.forEach(({ from, to, turned, turn }, i) => {
      this.bodies[i].position.lerpVectors(from, to, part);
      this.bodies[i].quaternion.slerpQuaternions(turned, turn, part);
    });
    if (part === 1) this.moves = null;
    return part < 1;
  }

  finishMoves() {
    this.movedAt = -Infinity;
    this.interpolate();
  }

  // ---- drawing ----------------------------------------------------------------------------------------------

  applyColors() {
    const background = new THREE.Color(color("--view"));
    this.scene.background = background;
    this.scene.fog = new THREE.Fog(background, 6, 20);
    if (this.grid) this.scene.remove(this.grid);
    this.grid = new THREE.GridHelper(10, 40, color("--view-grid-strong"), color("--view-grid"));
    this.grid.rotation.x = Math.PI / 2;
    this.grid.position.z = 0.001;
    this.scene.add(this.grid);
    this.requestDraw();
  }

  resize() {
    const { clientWidth: width, clientHeight: height } = this.element;
    if (!width || !height) return;
    this.renderer.setSize(width, height, false);
    this.camera.aspect = width / height;
    this.camera.updateProjectionMatrix();
    this.requestDraw();
  }

  /** Looks at the robots from the front right. */
  resetCamera() {
    const box = new THREE.Box3();
    for (const { arm_id: arm } of this.robots) {
      for (const body of this.bodies) if (body.name.startsWith(`${arm}_`)) box.expandByPoint(body.position);
    }
    if (box.isEmpty()) box.set(new THREE.Vector3(-0.5, -0.5, 0), new THREE.Vector3(0.5, 0.5, 0.8));
    const size = Math.max(0.9, box.getSize(new THREE.Vector3()).length());
    const aspect = Math.min(1, this.camera.aspect);
    box.getCenter(this.orbit.target);
    this.orbit.target.z *= 0.85;
    const direction = new THREE.Vector3(1, -0.95, 0.55).normalize();
    this.camera.position.copy(this.orbit.target).addScaledVector(direction, (1.75 * size) / aspect);
    this.orbit.update();
    this.requestDraw();
  }

  see(isSeen) {
    this.isSeen = isSeen;
    this.requestDraw();
  }

  requestDraw() {
    if (this.requested || !this.isSeen) return;
    const early = this.isSlow ? this.drawnAt + REST * this.cost - performance.now() : 0;
    if (early > 0) {
      this.requested = setTimeout(() => {
        this.requested = 0;
        this.requestDraw();
      }, early);
      return;
    }
    this.requested = requestAnimationFrame(() => {
      this.requested = 0;
      const goOn = this.interpolate();
      this.draw();
      if (goOn) this.requestDraw();
    });
  }

  draw() {
    const begin = performance.now();
    this.renderer.render(this.scene, this.camera);
    this.pictures += 1;
    if (this.pictures % MEASURED_PICTURES === 0) this.measure(begin);
    this.drawnAt = performance.now();
  }

  // Drawing continues after render(): reading a pixel waits for its end.
  measure(begin) {
    const gl = this.renderer.getContext();
    gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, new Uint8Array(4));
    this.cost = performance.now() - begin;
    if (this.cost < SLOW || this.isSlow) return;
    this.isSlow = true;
    this.sun.castShadow = false;
    this.renderer.setPixelRatio(1);
    this.resize();
  }

  /** Where a body's origin is on the page [px], for tests. */
  project(name) {
    const body = this.byName?.get(name);
    if (!body) return null;
    const at = body.getWorldPosition(new THREE.Vector3()).project(this.camera);
    const box = this.canvas.getBoundingClientRect();
    return { x: box.left + ((at.x + 1) / 2) * box.width, y: box.top + ((1 - at.y) / 2) * box.height };
  }
}
