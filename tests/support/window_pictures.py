#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of windows and plots in docs/pictures.

./franka shell .venv/bin/python3 tests/support/window_pictures.py [NAME...]

NAME is a function below, such as viewer; without names all pictures are made.
"""

import sys
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np
import pyfranka
import pyfranka.plot
from franka_sim_mujoco.session import Session
from PIL import Image
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import Panda
from screen import colors, dragged, move_pointer, picture_of, press, virtual_screen, window_of
from waiting import wait_for

PICTURES = Path(__file__).resolve().parents[2] / "docs" / "pictures"
COLORS = 256  # of a picture of a plot or a panel, for a small file
TABLE = """<mujoco><worldbody>
  <geom name="table" type="box" pos="0.4 0 0.2" size="0.2 0.4 0.2"/>
</worldbody></mujoco>"""


def save(picture: Image.Image, name: str, colors_left: int = COLORS) -> None:
    picture = picture.convert("RGB")
    (picture.quantize(colors_left) if colors_left else picture).save(PICTURES / name, optimize=True)
    print(PICTURES / name)


def plot_states() -> None:
    """An arm that moves down onto a table, and stops by a reflex."""
    with TemporaryDirectory() as folder:
        world, states = Path(folder) / "table.xml", Path(folder) / "states.png"
        world.write_text(TABLE)
        with FrankaSim(Panda(), world=world, pace="lockstep") as sim:
            robot, collector = sim.robot.connect(), pyfranka.plot.Collector("panda", version=5)
            start: list[float] = []

            def down(state, period):
                collector.add(state)
                start[:] = start or list(state.O_T_EE_c.T.flatten())
                elapsed = len(collector) * 1e-3
                pose = np.array(start)
                pose[14] -= 0.1 * max(0.0, elapsed - 0.3) ** 2
                return pyfranka.CartesianPose(pose.reshape(4, 4).T)

            try:
                robot.control_cartesian_pose(down)
            except pyfranka.ControlException:
                pass
            robot.read(lambda state: collector.add(state) or len(collector) < 3500)
        recording = collector.recording()
        panels = ["q", "dq+dq_d", "tau_J", "O_F_ext_hat_K"]
        figure = pyfranka.plot.plot(recording, panels, title="Panda that pushes the table")
        figure.savefig(states)
        save(Image.open(states), "plot_states.png")


def plot_abort() -> None:
    """A motion in which two joints jump."""
    with TemporaryDirectory() as folder, FrankaSim(Panda(), pace="lockstep") as sim:
        robot, ticks = sim.robot.connect(), 0

        def jump(state, period):
            nonlocal ticks
            ticks += 1
            speed = 0.25 * (1 - np.cos(np.pi * min(1.0, ticks / 500))) + (0.03 if ticks > 500 else 0.0)
            return pyfranka.JointVelocities([speed, 0, 0, 0, 0, 0, -speed])

        try:
            robot.control_joint_velocities(jump, limit_rate=False, cutoff_frequency=1000.0)
        except pyfranka.ControlException as error:
            figure = pyfranka.plot.abort_figure(error, robot.server_version())
            figure.savefig(Path(folder) / "abort.png")
            save(Image.open(Path(folder) / "abort.png"), "plot_abort.png")


def viewer() -> None:
    """The window of franka_sim with its help, while the stone is pushed by mouse."""
    robot = Panda(base=(-0.5, 0, 0))
    with TemporaryDirectory() as folder, virtual_screen():
        picture = Path(folder) / "window.png"
        with FrankaSim(robot, world="stone.xml", pace="realtime", viewer=True) as sim:
            wait_for(lambda: window_of("franka_sim") and colors(picture) > 200, "A picture")
            move_pointer(600, 450)
            press("h")
            from test_display import Viewer  # where the stone is drawn

            seen, stone = Viewer(picture), np.array(sim.robot.remote.body_position("stone")[:3])
            x, y = seen.pixel(stone)

            def moved() -> float:  # [m]
                return float(np.linalg.norm(np.array(sim.robot.remote.body_position("stone")[:3]) - stone))

            with dragged(x, y, x + 250, y - 300, hold="Control_L"):
                wait_for(lambda: moved() > 0.1, "The stone")
                colors(picture, window_of("franka_sim"))
            save(Image.open(picture), "viewer.png", 0)


def sliders() -> None:
    """The panel of the Cartesian impedance example."""
    launch = ["franka_example_controllers", "cartesian_impedance_example_controller.launch", "sim:=true"]
    launch += ["rqt:=true", "rviz:=false", "load_gripper:=false", "robot_ip:=127.0.7.41"]
    with TemporaryDirectory() as folder, virtual_screen():
        picture = Path(folder) / "window.png"
        with Session(*launch, log=Path(folder) / "launch.log") as session:
            session.wait_for_master()
            wait_for(lambda: "Started controllers: cartesian" in session.tail(100), "A controller", 180)
            from test_parameter_sliders import STIFFEST, Panel

            panel = Panel(Path(folder))
            wait_for(lambda: len(panel.scales()) == 3, "Three sliders", 180)
            wait_for(lambda: abs(panel.shows(0, STIFFEST) - 200.0) < 2.0, "Their values", 180)
            picture_of("Parameters", picture)
            save(Image.open(picture), "sliders.png")


FUNCTIONS = {each.__name__: each for each in (plot_states, plot_abort, viewer, sliders)}

if __name__ == "__main__":
    sys.dont_write_bytecode = True
    sys.path.insert(0, str(Path(__file__).resolve().parents[1]))
    for name in sys.argv[1:] or FUNCTIONS:
        FUNCTIONS[name]()
