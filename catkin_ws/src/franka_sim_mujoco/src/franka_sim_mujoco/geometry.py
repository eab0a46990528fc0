# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Poses as 4x4 numpy arrays, from and to the ROS messages. Quaternions are (x, y, z, w)."""

import math

import numpy as np
from geometry_msgs.msg import Point, Pose, Quaternion
from numpy.typing import NDArray
from tf.transformations import quaternion_about_axis, quaternion_from_matrix, quaternion_matrix

Array = NDArray[np.float64]


def matrix_of(pose: Pose) -> Array:
    """The 4x4 transform of a pose message."""
    q, p = pose.orientation, pose.position
    transform: Array = quaternion_matrix([q.x, q.y, q.z, q.w])
    transform[:3, 3] = [p.x, p.y, p.z]
    return transform


def pose_of(transform: Array) -> Pose:
    """The pose message of a 4x4 transform."""
    return Pose(Point(*transform[:3, 3]), Quaternion(*quaternion_from_matrix(transform)))


def downwards(x: float, y: float, z: float, yaw: float = 0.0) -> Array:
    """A gripper that points down at (x, y, z) [m], rotated by yaw about the vertical [rad]."""
    c, s = math.cos(yaw), math.sin(yaw)
    transform = np.eye(4)
    transform[:3, :3] = [[c, s, 0.0], [s, -c, 0.0], [0.0, 0.0, -1.0]]
    transform[:3, 3] = [x, y, z]
    return transform


def yaw_of(transform: Array) -> float:
    """Rotation of the x axis about the vertical [rad]."""
    return math.atan2(transform[1, 0], transform[0, 0])


def rotation_vector(rotation: Array) -> Array:
    """Axis times angle [rad] of a 3x3 rotation by less than half a turn."""
    whole = np.eye(4)
    whole[:3, :3] = rotation
    *axis, w = quaternion_from_matrix(whole)
    sine = float(np.linalg.norm(axis))  # of half the angle
    angle = 2.0 * math.atan2(sine, abs(w))
    return np.array(axis) * math.copysign(angle / sine if sine > 0.0 else 2.0, w)


def rotation_of(vector: Array) -> Array:
    """The 3x3 rotation of an axis times an angle [rad]."""
    angle = float(np.linalg.norm(vector))
    rotation: Array = quaternion_matrix(quaternion_about_axis(angle, vector))[:3, :3]
    return rotation


def shortened(vector: Array, longest: float) -> Array:
    """The vector, or one of the same direction with the largest length allowed."""
    length = float(np.linalg.norm(vector))
    return vector if length <= longest else vector * (longest / length)


def wrap(angle: float, period: float) -> float:
    """The same angle in [-period/2, period/2)."""
    return (angle + period / 2) % period - period / 2


def minimum_jerk(fraction: float) -> float:
    """Profile of a motion that starts and ends at rest, 0..1 -> 0..1."""
    s = min(max(fraction, 0.0), 1.0)
    return s * s * s * (10.0 + s * (6.0 * s - 15.0))
