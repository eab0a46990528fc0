# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The sliders that replace rqt, moved with a mouse on a virtual screen, and their effect on the arm."""

import json
import re
import subprocess

import pytest
import waiting
from franka_sim_mujoco.session import Session
from PIL import Image
from pyfranka.remote import Remote
from screen import children_of, click, drag, press, virtual_screen, window_of

ADDRESS = "127.0.7.21"
CONTROLLER = "cartesian_impedance_example_controller"
SERVER = f"/{CONTROLLER}/dynamic_reconfigure_compliance_param_node"
PATIENCE = 180.0  # limit for reactions on a busy machine [s]
SCALE_WIDTH, BORDER, KNOB = 364, 3, 30  # of the panel's sliders; [px]
WAY = SCALE_WIDTH - 2 * BORDER - KNOB  # of the knob's center [px]
ENTRY_WIDTH, BUTTON_WIDTH = 96, 118  # [px]
ABOVE_BOTTOM = 12  # position of the knob [px]
STIFFEST = 400.0  # [N/m]
PUSH = 8.0  # [N]
LONG = pytest.mark.long_form("moves every control of the panel")


def wait_for(session, condition, what):
    def checked():
        session.check()
        return condition()

    waiting.wait_for(checked, lambda: f"{session.tail(40)}\n{what}", PATIENCE, 0.1)


class Panel:
    """Reads and moves the sliders like a user."""

    def __init__(self, folder):
        self._picture = folder / "panel.png"

    @staticmethod
    def scales():
        window = window_of("Parameters")
        return [place for place in children_of(window) if place[2] == SCALE_WIDTH] if window else []

    def type(self, number, *keys):
        """Replaces the text of a number's entry."""
        self._click(number, ENTRY_WIDTH)
        press("a", hold="Control_L")
        press(*keys, "Return")

    def reset(self, number):
        """Presses the button that sets the default."""
        self._click(number, BUTTON_WIDTH)

    def _click(self, number, width):
        window = window_of("Parameters")
        x, y, width, height = [place for place in children_of(window) if place[2] == width][number]
        click(x + width // 2, y + height // 2)

    def shows(self, number, most):
        """The value at a slider's knob, which is brighter than the rest."""
        subprocess.run(["import", "-window", "root", str(self._picture)], check=True, timeout=30)
        x, y, _, height = self.scales()[number]
        with Image.open(self._picture) as picture:
            left, top = x + BORDER, y + height - ABOVE_BOTTOM
            line = picture.convert("L").crop((left, top, left + WAY + KNOB, top + 1))
            bright = [place + 0.5 for place, gray in enumerate(line.getdata()) if gray > 200]
        middle = (min(bright) + max(bright)) / 2
        return (middle - KNOB / 2) / WAY * most

    def pull(self, number, value, to, most):
        x, y, _, height = self.scales()[number]

        def place(value):
            return round(x + BORDER + KNOB / 2 + value / most * WAY)

        drag(place(value), y + height - ABOVE_BOTTOM, place(to))


class Robot:
    """The simulated robot, and the parameters of its controller."""

    def __init__(self, session):
        self._session = session
        self._start = self._height()

    @staticmethod
    def _height():
        return Remote(ADDRESS).body_position("panda_link7")[2]

    @staticmethod
    def push():
        """Pushes straight up along the end effector's axis, for longer than the test."""
        Remote(ADDRESS).push("panda_link7", (0, 0, PUSH), ticks=900000)

    def yields(self, distance):
        """Waits until it has been at the position of a spring under the push for a while of its time."""
        since = None

        def stays():
            nonlocal since
            now = Remote(ADDRESS).time
            if since is None or abs(self._height() - self._start - distance) > 0.03 * distance:
                since = now
            return now - since > 1.0

        wait_for(self._session, stays, f"a push of {PUSH} N moves the arm by {distance} m")

    def parameters(self):
        output = self._session.run("rosrun", "dynamic_reconfigure", "dynparam", "get", SERVER).stdout
        return {name: float(value) for name, value in re.findall(r"'(\w+_stiffness)': ([\d.]+)", output)}

    def set(self, **values):
        self._session.run("rosrun", "dynamic_reconfigure", "dynparam", "set", SERVER, json.dumps(values))

    def controller(self, *words):
        command = ["rosrun", "controller_manager", "controller_manager", *words, CONTROLLER]
        self._session.run(*command, timeout=PATIENCE, check=False)  # one that stands stops no more


@pytest.fixture(scope="module")
def sliders(tmp_path_factory):
    """The example with its panel and its robot, from the launch file."""
    folder = tmp_path_factory.mktemp("sliders")
    launch = ["franka_example_controllers", f"{CONTROLLER}.launch", "sim:=true", "rqt:=true", "rviz:=false"]
    launch += ["load_gripper:=false", f"robot_ip:={ADDRESS}", "realism:=ideal"]  # friction adds to springs
    with virtual_screen(), Session(*launch, log=folder / "launch.log") as session:
        session.wait_for_master()
        panel = Panel(folder)
        wait_for(session, lambda: len(panel.scales()) == 3, "three sliders")
        wait_for(session, lambda: "Started controllers: cartesian" in session.tail(100), "a controller")
        yield session, panel, Robot(session)
        assert "could not be set" not in session.tail(1000)


def test_a_slider_changes_the_stiffness(sliders):
    session, panel, robot = sliders
    assert robot.parameters()["translational_stiffness"] == 200.0
    assert panel.shows(0, STIFFEST) == pytest.approx(200.0, abs=2.0)
    robot.push()
    robot.yields(PUSH / 200.0)
    panel.pull(0, 200.0, 2 * STIFFEST, STIFFEST)
    robot.yields(PUSH / STIFFEST)
    assert robot.parameters()["translational_stiffness"] == STIFFEST
    assert panel.shows(0, STIFFEST) == pytest.approx(STIFFEST, abs=2.0)


@LONG
def test_sliders_follow_changes_by_others(sliders):
    session, panel, robot = sliders
    robot.set(translational_stiffness=120.0, rotational_stiffness=20.04)
    wait_for(session, lambda: abs(panel.shows(0, STIFFEST) - 120.0) < 2.0, "the slider moves")
    assert panel.shows(1, 30.0) == pytest.approx(20.04, abs=0.2)
    # A slider that follows a change sets no value, not even its rounded one.
    assert robot.parameters()["rotational_stiffness"] == 20.04


@LONG
def test_numbers_can_be_typed_and_reset(sliders):
    session, panel, robot = sliders

    def is_set(name, value):
        wait_for(session, lambda: robot.parameters()[name] == value, f"{name} is {value}")

    panel.type(0, "3", "0", "7", "period", "5")
    is_set("translational_stiffness", 307.5)
    assert panel.shows(0, STIFFEST) == pytest.approx(307.5, abs=2.0)
    panel.type(0, "4", "0", "1")  # beyond the limit: refused, in red
    panel.type(1, "7")
    is_set("rotational_stiffness", 7.0)
    assert robot.parameters()["translational_stiffness"] == 307.5
    panel.reset(0)
    panel.reset(1)
    is_set("translational_stiffness", 200.0)
    is_set("rotational_stiffness", 10.0)


@LONG
def test_a_stopped_controller_keeps_its_sliders(sliders):
    session, panel, robot = sliders
    robot.controller("stop")
    panel.pull(2, 0.5, 50.0, 100.0)
    wait_for(session, lambda: abs(robot.parameters()["nullspace_stiffness"] - 50.0) < 1.0, "the new value")


@LONG
def test_sliders_appear_and_disappear_with_their_controller(sliders):
    session, panel, robot = sliders
    robot.controller("stop")
    robot.controller("unload")
    wait_for(session, lambda: not panel.scales(), "the sliders go")
    robot.controller("load")
    wait_for(session, lambda: len(panel.scales()) == 3, "the sliders come back")
    panel.pull(0, panel.shows(0, STIFFEST), -STIFFEST, STIFFEST)
    wait_for(session, lambda: robot.parameters()["translational_stiffness"] == 0.0, "the new value")
