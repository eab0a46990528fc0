// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Shapes of the control interface's scene as objects of three.js. Sizes are MuJoCo's half sizes.
import * as THREE from "three";

const ENDLESS = 10; // [m] half size at which a plane without one is drawn
const MIN_FLOOR = 1.5; // [m] half size
const ROUND = 32; // segments of a circle

const GEOMETRIES = {
  box: ([x, y, z]) => new THREE.BoxGeometry(2 * x, 2 * y, 2 * z),
  sphere: ([radius]) => new THREE.SphereGeometry(radius, ROUND, ROUND / 2),
  ellipsoid: (size) => new THREE.SphereGeometry(1, ROUND, ROUND / 2).scale(...size),
  cylinder: ([radius, half]) => new THREE.CylinderGeometry(radius, radius, 2 * half, ROUND).rotateX(Math.PI / 2),
  capsule: ([radius, half]) => new THREE.CapsuleGeometry(radius, 2 * half, 8, ROUND).rotateX(Math.PI / 2),
  plane: ([x, y]) => new THREE.PlaneGeometry(2 * (x || ENDLESS), 2 * (y || ENDLESS)),
};

/** A geometry from the bytes of /page/mesh: counts, vertices, faces. */
export function meshGeometry(buffer) {
  const [vertices, faces] = new Uint32Array(buffer, 0, 2);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(buffer, 8, 3 * vertices), 3));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(buffer, 8 + 12 * vertices, 3 * faces), 1));
  // Without shared vertices each face has its own normal, so that edges stay sharp.
  const flat = geometry.toNonIndexed();
  flat.computeVertexNormals();
  return flat;
}

export function setPose(object, [x, y, z, qw, qx, qy, qz]) {
  object.position.set(x, y, z);
  object.quaternion.set(qx, qy, qz, qw);
}

// A floor, endless or large, shows shadows only: the page draws its grid there, in its own colors.
const isFloor = ({ kind, size }) => kind === "plane" && size.slice(0, 2).every((half) => !half || half >= MIN_FLOOR);

function materialOf([red, green, blue, alpha]) {
  const color = new THREE.Color().setRGB(red, green, blue, THREE.SRGBColorSpace);
  return new THREE.MeshStandardMaterial({ color, roughness: 0.65, metalness: 0, transparent: alpha < 1, opacity: alpha, side: THREE.DoubleSide });
}

/** An object for a shape. fetchMesh(name): resolves with the bytes of a mesh. */
export async function shapeObject(shape, fetchMesh) {
  const make = GEOMETRIES[shape.kind];
  const geometry = make ? make(shape.size) : meshGeometry(await fetchMesh(shape.mesh));
  const material = isFloor(shape) ? new THREE.ShadowMaterial({ opacity: 0.16 }) : materialOf(shape.color);
  const object = new THREE.Mesh(geometry, material);
  setPose(object, shape.pose);
  object.castShadow = shape.kind !== "plane" && shape.color[3] > 0.5;
  object.receiveShadow = true;
  return object;
}
