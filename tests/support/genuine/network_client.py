# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A client that executes tasks: one JSON line in, one out, over one connection or several.

The same tasks with each library: `panda` (panda-python, protocol 5), `pylibfranka` (protocol 10), or
`pyfranka` (this project's own). Times are the robot's.
"""

import json
import sys
import time

from session_parts import smooth


class Motion:
    """Joint 4 there and back, or zero torque."""

    def __init__(self, seconds, amplitude, announce, held, pause):
        self.seconds, self.amplitude = seconds, amplitude
        self.announce, self.held, self.pause = announce, held, pause
        self.time, self.cycles, self.first = 0.0, 0, None

    def next(self, q_d, period):
        """@returns joint positions and whether they are the last."""
        self.time += period
        self.cycles += 1
        self.first = self.first or list(q_d)
        if self.cycles == 50 and self.announce:
            print("moving", flush=True)
            if self.held:
                sys.stdin.readline()
        if self.pause and self.cycles == 100:
            time.sleep(self.pause)  # the fault itself
        q = list(self.first)
        x = self.time / self.seconds
        q[3] += self.amplitude * (smooth(2 * x) - smooth(2 * x - 1))
        return q, self.time >= self.seconds


class Client:
    """What all libraries name alike."""

    def recover(self):
        self.robot.automatic_error_recovery()

    def set_load(self):
        self.robot.set_load(0.0, [0.0] * 3, [0.0] * 9)


class Panda(Client):
    def __init__(self, address):
        from panda_py import libfranka

        self.library, self.robot = libfranka, libfranka.Robot(address)

    def mode(self):
        self.robot.read_once()  # an old one may wait in the socket, which drops new ones when it is full
        return str(self.robot.read_once().robot_mode).split(".k")[-1]

    def move(self, motion, torque):
        kind = self.library.Torques if torque else self.library.JointPositions

        def callback(state, period):
            q, finished = motion.next(state.q_d, period.to_sec())
            command = kind([0.0] * 7 if torque else q)
            command.motion_finished = finished
            return command

        if torque:
            self.robot.control(callback, False)
        else:
            impedance = self.library.ControllerMode.kJointImpedance
            self.robot.control_joint_position(callback, impedance, False)


class Own(Client):
    def __init__(self, address):
        import pyfranka

        self.library = pyfranka
        self.robot = pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)

    def mode(self):
        return self.robot.read_once().robot_mode.name

    def move(self, motion, torque):
        kind = self.library.Torques if torque else self.library.JointPositions

        def callback(state, period):
            q, finished = motion.next(state.q_d, period)
            command = kind([0.0] * 7 if torque else q)
            command.motion_finished = finished
            return command

        if torque:
            self.robot.control_torques(callback, limit_rate=False)
        else:
            self.robot.control_joint_positions(callback, limit_rate=False, cutoff_frequency=1000.0)


class Pylibfranka(Client):
    def __init__(self, address):
        import pylibfranka

        self.library = pylibfranka
        self.robot = pylibfranka.Robot(address, pylibfranka.RealtimeConfig.kIgnore)

    def mode(self):
        self.robot.read_once()  # an old one may wait in the socket
        return self.robot.read_once().robot_mode.name

    def move(self, motion, torque):
        if torque:
            control, kind = self.robot.start_torque_control(), self.library.Torques
        else:
            impedance = self.library.ControllerMode.JointImpedance
            control = self.robot.start_joint_position_control(impedance)
            kind = self.library.JointPositions
        finished = False
        while not finished:
            state, period = control.readOnce()
            q, finished = motion.next(state.q_d, period.to_sec() if motion.cycles else 0.0)
            command = kind([0.0] * 7 if torque else q)
            command.motion_finished = finished
            control.writeOnce(command)


LIBRARIES = {"panda": Panda, "pyfranka": Own, "pylibfranka": Pylibfranka}


def attempt(act):
    """The outcome."""
    try:
        act()
        return {"outcome": "ok"}
    except Exception as error:  # noqa: BLE001 - its text is tested
        return {"outcome": f"{type(error).__name__}: {error}"}


class Session:
    def __init__(self, library):
        self.library, self.client = library, None

    def connect(self, address):
        def act():
            self.client = None  # one at a time
            self.client = LIBRARIES[self.library](address)

        return attempt(act)

    def move(self, seconds=1.0, amplitude=0.01, torque=False, announce=False, held=False, pause=0.0):
        motion = Motion(seconds, amplitude, announce, held, pause)
        return attempt(lambda: self.client.move(motion, torque))

    def recover(self):
        return {**attempt(self.client.recover), "mode": self.client.mode()}

    def set_load(self):
        return attempt(self.client.set_load)


def main():
    session = Session(sys.argv[1])
    for line in sys.stdin:
        task = json.loads(line)
        try:
            answer = getattr(session, task.pop("do"))(**task)
        except Exception as error:  # noqa: BLE001 - reported to the test
            answer = {"outcome": f"{type(error).__name__}: {error}", "mode": "unknown"}
        print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    main()
