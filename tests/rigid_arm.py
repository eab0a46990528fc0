# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""An arm's kinematics and dynamics by the textbook, as a reference for other models.

Sums over the links' Jacobians, unlike all models of the product. Joint positions are (7,) [rad], poses 4x4 in
the base, Jacobians 6x7 (linear over angular), all of a Panda or FR3 with a load fixed to its flange.
"""

from dataclasses import dataclass
from pathlib import Path

import numpy as np
import yaml

ROBOTS = Path(__file__).parent.parent / "catkin_ws/src/franka_description/robots"
LINKS = {"panda": ROBOTS / "common/inertial.yaml", "fr3": ROBOTS / "fr3/inertials.yaml"}
GRAVITY = np.array([0.0, 0.0, -9.81])  # [m/s^2]
FLANGE = 8

# Modified Denavit-Hartenberg parameters as Franka documents them [m], [m], [rad]; the last row: the flange.
TABLE = [
    (0, 0.333, 0),
    (0, 0, -np.pi / 2),
    (0, 0.316, np.pi / 2),
    (0.0825, 0, np.pi / 2),
    (-0.0825, 0.384, -np.pi / 2),
    (0, 0, np.pi / 2),
    (0.088, 0, np.pi / 2),
    (0, 0.107, 0),
]


@dataclass
class Body:
    """Mass [kg], center (3,) [m] and inertia about it (3, 3) [kg m^2], in the frame of a link."""

    link: int
    mass: float
    center: np.ndarray
    inertia: np.ndarray


def bodies(load: Body, robot: str) -> list[Body]:
    """The moving links of `panda` or `fr3`, and the load."""
    found = [load]
    links = yaml.safe_load(LINKS[robot].read_text())
    for link in range(1, 8):
        values = links[f"link{link}"]
        center = np.array([float(number) for number in values["origin"]["xyz"].split()])
        of = {axes: float(number) for axes, number in values["inertia"].items()}
        inertia = [[of["".join(sorted(row + column))] for column in "xyz"] for row in "xyz"]
        found.append(Body(link, values["mass"], center, np.array(inertia)))
    return found


def poses(q) -> np.ndarray:
    """(9, 4, 4): poses of the base, the links 1 to 7 and the flange."""
    found = [np.eye(4)]
    for (a, d, alpha), angle in zip(TABLE, [*q, 0.0]):
        ca, sa, cq, sq = np.cos(alpha), np.sin(alpha), np.cos(angle), np.sin(angle)
        step = [
            [cq, -sq, 0, a],
            [sq * ca, cq * ca, -sa, -sa * d],
            [sq * sa, cq * sa, ca, ca * d],
            [0, 0, 0, 1],
        ]
        found.append(found[-1] @ np.array(step))
    return np.array(found)


def jacobian(links: np.ndarray, point: np.ndarray, link: int = 7) -> np.ndarray:
    """Jacobian of a point [m] in the base that moves with a link; `links` are the arm's `poses`."""
    found = np.zeros((6, 7))
    for i in range(min(link, 7)):
        axis = links[i + 1, :3, 2]
        found[:3, i], found[3:, i] = np.cross(axis, point - links[i + 1, :3, 3]), axis
    return found


def mass(q, parts: list[Body]) -> np.ndarray:
    """(7, 7) [kg m^2]"""
    links, total = poses(q), np.zeros((7, 7))
    for body in parts:
        rotation, J = links[body.link, :3, :3], center_jacobian(links, body)
        inertia = rotation @ body.inertia @ rotation.T
        total += body.mass * J[:3].T @ J[:3] + J[3:].T @ inertia @ J[3:]
    return total


def center_jacobian(links: np.ndarray, body: Body) -> np.ndarray:
    at = links[body.link]
    return jacobian(links, at[:3, :3] @ body.center + at[:3, 3], body.link)


def gravity(q, parts: list[Body]) -> np.ndarray:
    """Torques that compensate gravity (7,) [Nm]"""
    links = poses(q)
    return -sum(body.mass * center_jacobian(links, body)[:3].T @ GRAVITY for body in parts)


def coriolis(q, dq, parts: list[Body]) -> np.ndarray:
    """(7,) [Nm], from differences of the mass matrix: dM/dt dq - d(dq M dq)/dq / 2."""
    h = 1e-6
    slopes = [
        (mass(q + h * direction, parts) - mass(q - h * direction, parts)) / (2 * h) for direction in np.eye(7)
    ]
    change = sum(slope * velocity for slope, velocity in zip(slopes, dq))
    return change @ dq - np.array([dq @ slope @ dq for slope in slopes]) / 2
