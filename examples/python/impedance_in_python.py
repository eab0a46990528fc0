# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Cartesian impedance controller in Python at 1 kHz: a push moves the hand, which yields like a spring.

    python3 impedance_in_python.py [--robot fr3] [--output FOLDER]

Prints the measured deflection and that of an ideal spring, and writes impedance_in_python.png.
"""

# %%
import numpy
from common import options
from matplotlib import pyplot
from pyfranka import Frame
from pyfranka.sim import Simulation

STIFFNESS = numpy.array([600.0] * 3 + [40.0] * 3)  # [N/m, Nm/rad]
DAMPING = 2.0 * numpy.sqrt(STIFFNESS)  # [N s/m, Nm s/rad]
FORCE = 6.0  # [N], along y
PUSH = (500, 2500)  # first and last tick
TICKS = 4000


# %% [markdown]
# A small turn is a vector, so position and orientation have one spring each, with six stiffnesses.


# %%
def error_of(pose, target):
    """The translation and rotation from the target to the pose, in the axes of O: 3 [m] and 3 [rad] (small
    angles)."""
    turn = pose[:3, :3] @ target[:3, :3].T
    skew = 0.5 * (turn - turn.T)
    return numpy.concatenate([pose[:3, 3] - target[:3, 3], [skew[2, 1], skew[0, 2], skew[1, 0]]])


# %% [markdown]
# The controller computes a torque for each tick. Meanwhile a force acts on the hand for two seconds.

# %%
arguments, Robot = options(__doc__)
with Simulation(robots=[Robot()]) as sim:
    robot, model = sim[Robot.kind], sim[Robot.kind].model
    robot.set_collision_behavior([50.0] * 7, [50.0] * 7, [50.0] * 6, [50.0] * 6)
    target = robot.state.O_T_EE
    state = robot.live_state  # shows each tick
    moved = numpy.zeros((TICKS, 3))
    for tick in range(TICKS):
        jacobian = model.zero_jacobian(Frame.EndEffector, state)
        wrench = -STIFFNESS * error_of(state.O_T_EE, target) - DAMPING * (jacobian @ state.dq)
        robot.command(torque=jacobian.T @ wrench + model.coriolis(state))
        if PUSH[0] <= tick < PUSH[1]:
            # At the end effector, where the spring is.
            at_hand, _ = sim.body_pose(f"{robot.name}_hand")
            lever = state.O_T_EE[:3, 3] - at_hand
            force = numpy.array([0.0, FORCE, 0.0])
            sim.push(f"{robot.name}_hand", force, numpy.cross(lever, force))
        sim.step()
        moved[tick] = state.O_T_EE[:3, 3] - target[:3, 3]

# %%
yielded = moved[PUSH[1] - 100 : PUSH[1], 1].mean()
print(f"yielded {1e3 * yielded:.2f} mm; the spring says {1e3 * FORCE / STIFFNESS[1]:.2f} mm")

figure, axes = pyplot.subplots(figsize=(7, 3.5))
for values, name, style in zip(1e3 * moved.T, "xyz", ("-", "-", "--")):  # x and z are nearly the same
    axes.plot(1e-3 * numpy.arange(TICKS), values, style, label=name)
axes.axvspan(*(1e-3 * numpy.array(PUSH)), alpha=0.15, label=f"{FORCE:g} N along y")
axes.set_xlabel("time [s]")
axes.set_ylabel("end effector from its target [mm]")
axes.legend()
figure.tight_layout()
figure.savefig(arguments.output / "impedance_in_python.png", dpi=100)
