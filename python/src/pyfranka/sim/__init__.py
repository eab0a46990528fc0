# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulated robots in this process: no sockets, no threads, no clock. A tick is a millisecond.

    import numpy as np
    import pyfranka.sim

    with pyfranka.sim.Simulation(world="stone.xml", robots=[pyfranka.sim.Panda(base=(-0.5, 0, 0))]) as sim:
        robot = sim["panda"]
        for _ in range(1000):
            robot.command(torque=robot.model.coriolis(robot.state))
            sim.step()
        print(robot.state.q)

A robot obeys the rules of a real one: its limits, reflexes and recovery. What it refuses raises
RequestRefused; a motion that it aborts is seen in `state.robot_mode` and `state.last_motion_errors`. One
thread at a time may use a simulation.
"""

from _pyfranka._sim import ArmModel, GripperOutcome, LiveState, RequestRefused, Snapshot

from pyfranka.remote import LineRefused, Remote, RemoteMesh, RemoteScene, RemoteShape, RemoteState
from pyfranka.robot_report import Report

from .batch import SimulationBatch
from .robot import Action, Gripper, SimulatedRobot
from .setups import FR3, KINDS, Panda
from .simulation import Contact, Picture, Simulation

__all__ = [
    "FR3",
    "KINDS",
    "Action",
    "ArmModel",
    "Contact",
    "Gripper",
    "GripperOutcome",
    "LineRefused",
    "LiveState",
    "Panda",
    "Picture",
    "Remote",
    "RemoteMesh",
    "RemoteScene",
    "RemoteShape",
    "RemoteState",
    "Report",
    "RequestRefused",
    "SimulatedRobot",
    "Simulation",
    "SimulationBatch",
    "Snapshot",
]
