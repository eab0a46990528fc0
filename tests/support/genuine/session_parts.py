# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What the sessions of the genuine clients have in common: courses of motions, and the text of errors.

`library` is the client's module. A course is called with the start {"q", "pose"} and the share of the
motion's time that has passed, and returns a command.
"""

LOOSE = ([100.0] * 7, [100.0] * 7, [200.0] * 6, [200.0] * 6)
SENSITIVE = ([20.0] * 7, [20.0] * 7, [10.0] * 6, [15.0] * 6)


def smooth(x):
    """From 0 to 1 with velocity and acceleration zero at both ends."""
    x = min(max(x, 0.0), 1.0)
    return x * x * x * (10.0 + x * (6.0 * x - 15.0))


def joints(library, amplitude):
    def command(first, x):
        q = list(first["q"])
        q[3] += amplitude * smooth(x)
        return library.JointPositions(q)

    return command


def pose(library, amplitude):
    def command(first, x):
        values = list(first["pose"])
        values[14] += amplitude * (smooth(2 * x) - smooth(2 * x - 1))
        return library.CartesianPose(values)

    return command


def rise(library, height):
    def command(first, x):
        values = list(first["pose"])
        values[14] += height * smooth(x)
        return library.CartesianPose(values)

    return command


def down(library, speed):
    def command(_, x):
        return library.CartesianVelocities([0, 0, -speed * smooth(x / 0.1), 0, 0, 0])

    return command


def torques(library):
    return lambda first, x: library.Torques([0.0] * 7)


def attempt(act):
    try:
        act()
        return "ok"
    except Exception as error:  # noqa: BLE001 - its text is tested
        return f"{type(error).__name__}: {error}"
