# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Records a motion to a file of numpy and plots it: positions, torques and the force of a touch.

    python3 record_and_plot.py [--robot fr3] [--output FOLDER]

Writes recording.npz and record_and_plot.png. The arm has the friction and the noise of a recorded one.
"""

# %%
import numpy
from common import BASE, options, progress
from matplotlib import pyplot
from pyfranka.sim import Simulation

TICKS = 6000
EVERY = 5  # a sample in so many ticks
STYLES = ("-", "-", "--", "-", ":", "-", "-")  # of the joints, some of whose lines lie on each other
FIELDS = ("q", "dq", "tau_J", "tau_ext_hat_filtered", "O_F_ext_hat_K")


def record(robot, sim, ticks):
    """The fields of the state and the time, a row a sample."""
    rows = {name: [] for name in ("time", *FIELDS)}
    for tick in range(0, ticks, EVERY):
        sim.step(EVERY)
        if (tick + EVERY) % 1000 == 0:
            progress((tick + EVERY) // 1000, ticks // 1000, "recorded seconds")
        rows["time"].append(sim.time)
        state = robot.state
        for name in FIELDS:
            rows[name].append(getattr(state, name))
    return {name: numpy.array(values) for name, values in rows.items()}


# %%
arguments, Robot = options(__doc__)
file = arguments.output / "recording.npz"
with Simulation("stone.xml", [Robot(base=BASE, realism="recorded")], seed=1) as sim:
    robot = sim[Robot.kind]
    robot.set_collision_behavior([50.0] * 7, [50.0] * 7, [50.0] * 6, [50.0] * 6)
    down = robot.state.O_T_EE.copy()
    down[2, 3] = 0.37  # below the table's top, so that the hand presses on it
    robot.cartesian_impedance(down, duration=4.0, stiffness=[400.0] * 3 + [30.0] * 3)
    numpy.savez_compressed(file, **record(robot, sim, TICKS))

# %%
with numpy.load(file) as recording:
    time = recording["time"]
    figure, axes = pyplot.subplots(3, 1, figsize=(8, 7), sharex=True)
    for one, name in zip(axes, ("q", "tau_J")):
        for joint, style in enumerate(STYLES):
            one.plot(time, recording[name][:, joint], style, label=f"joint {joint + 1}")
    axes[0].set_ylabel("q [rad]")
    axes[1].set_ylabel("tau_J [Nm]")
    axes[2].plot(time, recording["O_F_ext_hat_K"][:, :3], label=["x", "y", "z"])
    axes[2].set_ylabel("O_F_ext_hat_K [N]")
    for one in axes:
        one.legend(loc="center left", bbox_to_anchor=(1.0, 0.5))
    axes[2].set_xlabel("time [s]")
    print(f"{len(time)} samples; the hand pressed with {recording['O_F_ext_hat_K'][-1, 2]:.1f} N at the end")
figure.align_ylabels()
figure.tight_layout()
figure.savefig(arguments.output / "record_and_plot.png", dpi=100)
