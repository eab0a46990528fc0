// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The appearance of a robot: meshes of its links if they are installed, and the light at its base.
import * as THREE from "three";
import { ColladaLoader } from "three/addons/loaders/ColladaLoader.js";
import * as api from "../api.js";

const FINGERS = { leftfinger: 0, rightfinger: Math.PI }; // one mesh; the right one is turned
const LIGHTS = { yellow: 0xf2b705, white: 0xf4f6f8, blue: 0x2f7fe0, green: 0x2eaf5f, pink: 0xd658b5, red: 0xe0383e };
const loader = new ColladaLoader();
const loaded = new Map(); // address -> promise of a scene

/** [part, mesh, turn about z] of all parts that can have a mesh. */
function parts() {
  const links = ["link0", "link1", "link2", "link3", "link4", "link5", "link6", "link7", "hand"];
  return [...links.map((name) => [name, name, 0]), ...Object.entries(FINGERS).map(([name, turn]) => [name, "finger", turn])];
}

function load(type, mesh) {
  const address = `/page/robot-mesh/${type}/${mesh}`;
  if (!loaded.has(address)) {
    loaded.set(address, api.getText(address).then((text) => {
      // The files have z upwards, as the world; the loader would turn them.
      const { scene } = loader.parse(text.replace("Z_UP", "Y_UP"), "");
      scene.traverse((object) => object.isMesh && improve(object));
      return scene;
    }));
  }
  return loaded.get(address);
}

function improve(mesh) {
  mesh.castShadow = true;
  mesh.receiveShadow = true;
  for (const material of [mesh.material].flat()) material.side = THREE.DoubleSide;
}

/**
 * Puts the meshes of a robot's links on its bodies, instead of simple shapes. bodyOf(name): a body's group or
 * undefined. installed: names of the installed meshes. onLoaded(): called after each.
 */
export async function addMeshes({ arm_id: arm, type }, bodyOf, installed, onLoaded) {
  for (const [part, mesh, turn] of parts()) {
    const body = bodyOf(`${arm}_${part}`);
    if (!body || body.userData.hasMesh || !installed.includes(mesh)) continue;
    try {
      const look = (await load(type, mesh)).clone();
      look.rotation.z = turn;
      for (const shape of [...body.children]) if (shape.userData.simple) shape.visible = false;
      body.add(look);
      onLoaded();
    } catch {
      return; // the simple shapes stay
    }
  }
}

/** The ring of light on the floor around a robot's base. */
export class BaseLight {
  constructor(body) {
    this.material = new THREE.MeshBasicMaterial({ color: LIGHTS.yellow, side: THREE.DoubleSide, transparent: true });
    const ring = new THREE.Mesh(new THREE.RingGeometry(0.15, 0.175, 48), this.material);
    ring.position.z = 0.004;
    ring.raycast = () => {};
    body.add(ring);
  }

  /** Returns whether the picture has changed. */
  show({ color, blinking }, time) {
    const opacity = blinking && time % 1000 > 500 ? 0.15 : 0.95;
    const hex = LIGHTS[color] ?? LIGHTS.white;
    if (this.material.color.getHex() === hex && this.material.opacity === opacity) return false;
    this.material.color.setHex(hex);
    this.material.opacity = opacity;
    return true;
  }
}
