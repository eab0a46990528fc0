# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Desired motions of the example controllers over time, from their description.

Times `t` are seconds since a controller's start (n,). Poses are those of the end effector in the base (4, 4).
"""

import numpy as np

ACCELERATION_TIME = 2.0  # [s] until joint_impedance's circle is up to speed


def joint_position(t, start):
    """Joint positions (n, 7) [rad]; the fifth joint goes the other way."""
    swing = 0.2 * np.pi / 16 * (1 - np.cos(np.pi * t / 5))
    return start + swing[:, None] * np.array([1, 1, 1, 1, -1, 1, 1])


def there_and_back(t, period, highest):
    """Integral of highest / 2 (1 - cos(2 pi t / period)), with reversed sign in every other period."""
    number, rest = np.divmod(t, period)
    way = highest / 2 * (rest - period / (2 * np.pi) * np.sin(2 * np.pi * rest / period))
    return np.where(number % 2 == 0, way, highest / 2 * period - way)


def joint_velocity(t, start):
    """Joint positions (n, 7) [rad]: the integral of the commanded velocities."""
    return start + there_and_back(t, 8.0, 0.1)[:, None] * np.ones(7)


def shifted(start, x, y, z):
    poses = np.repeat(start[None], len(x), axis=0)
    poses[:, :3, 3] += np.stack([x, y, z], axis=1)
    return poses


def cartesian_pose(t, start):
    """Poses (n, 4, 4) [m]"""
    angle = np.pi / 4 * (1 - np.cos(np.pi * t / 5))
    return shifted(start, -0.15 * np.sin(angle), 0 * t, -0.15 * (np.cos(angle) - 1))


def cartesian_velocity(t, start):
    """Poses (n, 4, 4) [m]: the integral of the commanded velocities."""
    way = there_and_back(t, 4.0, 0.05)
    return shifted(start, way * np.cos(np.pi / 4), 0 * t, -way * np.sin(np.pi / 4))


def elbow(t, start):
    """Position of the third joint (n,) [rad]"""
    return start + np.pi / 10 * (1 - np.cos(np.pi * t / 5))


def joint_impedance(t, start, radius=0.1, highest=0.15, acceleration_time=ACCELERATION_TIME):
    """Poses (n, 4, 4) [m] on a circle that starts with constant acceleration."""
    gaining = np.minimum(t, acceleration_time)
    angle = highest * (gaining**2 / (2 * acceleration_time) + (t - gaining)) / radius
    return shifted(start, 0 * t, radius * (1 - np.cos(angle)), radius * np.sin(angle))


def joint_impedance_torques(error, error_rate):
    """(n, 7) [Nm] without Coriolis torques, from the errors of q and dq [rad], [rad/s]."""
    k_gains = np.array([600.0, 600.0, 600.0, 600.0, 250.0, 150.0, 50.0])
    d_gains = np.array([50.0, 50.0, 50.0, 20.0, 20.0, 20.0, 10.0])
    return k_gains * error + d_gains * error_rate


def start_time(times, desired, formula, earliest, latest):
    """Start time of a controller: the time at which desired values match its formula, to 0.1 ms.

    @param times (n,) of the states [s]; desired (n, ...) their desired values
    @param formula of times (n,) since the begin, constant before it
    """
    candidates = np.arange(earliest, latest, 1e-4)
    deviations = [np.abs(formula(np.maximum(times - begin, 0.0)) - desired).max() for begin in candidates]
    return candidates[int(np.argmin(deviations))]
