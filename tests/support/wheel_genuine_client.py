# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""panda-python at a franka_sim that this script starts: wheel_genuine_client.py FRANKA_SIM ADDRESS.

Prints as JSON how many cycles of a torque motion the client saw, and the robot's mode after it.
"""

import json
import subprocess
import sys

from panda_py import libfranka

program, address = sys.argv[1:]
arguments = [program, "--robot", "panda", "--ip", address, "--pace", "lockstep"]
with subprocess.Popen(arguments, stdout=subprocess.PIPE, text=True) as served:
    try:
        assert "waits for clients" in served.stdout.readline()
        robot = libfranka.Robot(address)
        cycles = []

        def hold(state, period):
            cycles.append(period)
            torques = libfranka.Torques([0.0] * 7)
            torques.motion_finished = len(cycles) == 1000
            return torques

        robot.control(hold, True)
        mode = str(robot.read_once().robot_mode)
    finally:
        served.terminate()
print(json.dumps({"cycles": len(cycles), "mode": mode}))
