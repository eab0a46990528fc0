# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""First steps: a robot in a world, its state, a motion, and a picture of where it ended.

    python3 first_steps.py [--robot fr3] [--output FOLDER]

Writes first_steps.png.
"""

# %%
from common import BASE, options
from matplotlib import pyplot
from pyfranka.sim import Simulation

# %%
arguments, Robot = options(__doc__)
with Simulation("stone.xml", [Robot(base=BASE)]) as sim:
    robot = sim[Robot.kind]
    print("joints [rad]:", robot.state.q.round(3))
    print("torques [Nm]:", robot.state.tau_J.round(2))
    print("bodies of the world that move:", [name for name in sim.bodies() if name == "stone"])

    # A controller in C++ holds the joints by springs. Its target moves within two seconds.
    robot.joint_impedance(robot.state.q + [0.4, 0, 0, 0, 0, 0, 0.5], duration=2.0)
    opening = robot.gripper.move(0.06)
    sim.step(2500)  # milliseconds
    robot.finish()
    sim.step(500)
    print("after 3 s:", robot.state.q.round(3), robot.state.robot_mode, opening.outcome)

    picture = sim.render(width=640, height=480).rgb

# %%
pyplot.imsave(arguments.output / "first_steps.png", picture)
pyplot.imshow(picture)
