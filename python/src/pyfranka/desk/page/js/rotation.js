// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Rotations as users type them: roll, pitch and yaw [rad], R = Rz(yaw) Ry(pitch) Rx(roll).

/** A column-major 4x4 matrix of a translation [m] and of roll, pitch, yaw [rad]. */
export function transformOf([x, y, z], [roll, pitch, yaw]) {
  const [sr, cr, sp, cp, sy, cy] = [
    Math.sin(roll), Math.cos(roll), Math.sin(pitch), Math.cos(pitch), Math.sin(yaw), Math.cos(yaw),
  ];
  return [
    cy * cp, sy * cp, -sp, 0,
    cy * sp * sr - sy * cr, sy * sp * sr + cy * cr, cp * sr, 0,
    cy * sp * cr + sy * sr, sy * sp * cr - cy * sr, cp * cr, 0,
    x, y, z, 1,
  ];
}

/** The translation and roll, pitch, yaw of a column-major 4x4 matrix. At a pitch of 90 degrees roll is 0. */
export function partsOf(matrix) {
  const pitch = Math.atan2(-matrix[2], Math.hypot(matrix[0], matrix[1]));
  const upright = Math.hypot(matrix[0], matrix[1]) > 1e-9;
  const roll = upright ? Math.atan2(matrix[6], matrix[10]) : 0;
  const yaw = upright ? Math.atan2(matrix[1], matrix[0]) : Math.atan2(-matrix[4], matrix[5]);
  return { translation: matrix.slice(12, 15), rotation: [roll, pitch, yaw] };
}

export const toDegrees = (radians) => (radians * 180) / Math.PI;
export const toRadians = (degrees) => (degrees * Math.PI) / 180;
