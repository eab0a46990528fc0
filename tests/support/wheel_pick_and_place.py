# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Panda carries the stone to the other tray; run with the Python of an environment that has the wheel.

Prints as JSON how far the stone is from the middle of the tray [m], whether the hand held it, the robot's
hash, and what the picture of a camera is, or why there is none.
"""

import json

import numpy
import pyfranka.sim

BASE = numpy.array([-0.5, 0.0, 0.0])
TRAY = numpy.array([0.004, 0.220])  # x, y of its middle [m]; stone.xml
ABOVE = 0.12  # [m] over the stone

with pyfranka.sim.Simulation(world="stone.xml", robots=[pyfranka.sim.Panda(base=BASE)]) as sim:
    robot = sim["panda"]
    hand = robot.state.O_T_EE.copy()

    def go(position, seconds):
        hand[:3, 3] = position - BASE
        robot.cartesian_impedance(hand, duration=seconds, stiffness=[1500, 1500, 1500, 80, 80, 80])
        sim.step(round(1000 * seconds) + 500)

    stone = sim.body_pose("stone")[0]
    robot.gripper.move(0.08)
    go(stone + [0, 0, ABOVE], 2.0)
    go(stone, 1.0)
    grasp = robot.gripper.grasp(0.032, 0.05, 20.0)
    sim.step(1500)
    go(stone + [0, 0, ABOVE], 1.0)
    go([*TRAY, stone[2] + ABOVE], 2.0)
    held = robot.gripper.is_grasped
    go([*TRAY, stone[2] + 0.005], 1.0)
    robot.gripper.move(0.08)
    sim.step(1000)
    away = float(numpy.linalg.norm(sim.body_pose("stone")[0][:2] - TRAY))
    try:
        picture = str(sim.render(width=64, height=48).rgb.shape)
    except RuntimeError as error:
        picture = str(error)
    print(
        json.dumps(
            {
                "away": away,
                "grasped": grasp.succeeded,
                "held": held,
                "hash": robot.state_hash(),
                "picture": picture,
            }
        )
    )
