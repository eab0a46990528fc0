# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The Python examples move a simulated FR3; a failing script stops only its controller."""

import math
from pathlib import Path

import pytest
import rospy
from franka_msgs.msg import FrankaState
from franka_msgs.srv import SetJointConfiguration
from ros_client import START, Controllers, call, launched
from rosgraph_msgs.msg import Log
from waiting import wait_for

HERE = Path(__file__).resolve().parent
ARM = "fr3"
JOINTS = [f"{ARM}_joint{i}" for i in range(1, 8)]
FIRST_POSE = [0.0, -math.pi / 4, 0.0, -3 * math.pi / 4, 0.0, math.pi / 2, math.pi / 4]
IMPEDANCE = "python_joint_impedance_example_controller"
CIRCLE = "python_cartesian_circle_example_controller"
MODEL = "model_example_controller"
FAULTY = """
class Faulty:
  def starting(self, state, model): self.n = 0
  def update(self, state, model, period):
    self.n += 1
    if self.n > 300: raise ArithmeticError("three hundred")
    return [0.1 * min(self.n, 100) / 100] + [0.0] * 6
"""

pytestmark = pytest.mark.own_process


class Robot:
    """The FR3's states and controllers, and the errors that its nodes log."""

    def __init__(self):
        self.states, self.errors, self.controllers = [], [], Controllers()
        rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, self.states.append)
        rospy.Subscriber("/rosout", Log, lambda m: m.level >= Log.ERROR and self.errors.append(m.msg))

    def wait_for(self, condition, what):
        wait_for(condition, f"{what} (errors: {self.errors})", START)

    def wait_until_idle(self):
        """Waits for a state that was sent from now on."""
        known = len(self.states)
        self.wait_for(
            lambda: any(s.robot_mode == FrankaState.ROBOT_MODE_IDLE for s in self.states[known:]),
            "The mode Idle",
        )

    def record(self, name, seconds, is_seen):
        """The states of a controller's first seconds, and until one meets a condition."""
        self.controllers.load(name)
        self.controllers.start(name)
        begin = self.states[-1].header.stamp
        first = len(self.states)
        self.wait_for(
            lambda: (
                (self.states[-1].header.stamp - begin).to_sec() > seconds
                and any(map(is_seen, self.states[first:]))
            ),
            f"{seconds} s, and the awaited state",
        )
        self.controllers.stop(name)
        recorded = [s for s in list(self.states) if s.header.stamp >= begin]
        return [s for s in recorded if s.robot_mode == FrankaState.ROBOT_MODE_MOVE]


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    log = tmp_path_factory.mktemp("python_controllers") / "launch.log"
    with launched(str(HERE / "python_controllers.launch"), log=log, disable_rostime=True):
        robot = Robot()
        robot.controllers.wait_for("franka_state_controller")
        yield robot


@pytest.fixture
def robot(started):
    """The robot in its first pose, with its state controller only."""
    others = [name for name in started.controllers.states() if name != "franka_state_controller"]
    running = [name for name in others if name in started.controllers.running()]
    if running:
        started.controllers.stop(*running)
    for name in others:
        started.controllers.unload(name)
    answer = call("/set_franka_model_configuration", SetJointConfiguration, JOINTS, FIRST_POSE)
    assert answer.success, answer.error
    started.wait_until_idle()
    started.errors.clear()
    return started


def test_the_joint_impedance_example_moves_the_fourth_joint(robot):
    begin = robot.states[-1].q
    # Half a swing of 0.1 rad in 2.5 s.
    states = robot.record(IMPEDANCE, 4.0, lambda state: state.q[3] - begin[3] > 0.095)
    assert max(s.q[3] - begin[3] for s in states) < 0.105
    for joint in (0, 1, 2, 4, 5, 6):
        assert max(abs(s.q[joint] - begin[joint]) for s in states) < 0.01


def test_the_cartesian_example_moves_on_a_circle(robot):
    first = robot.states[-1].O_T_EE
    states = robot.record(CIRCLE, 5.0, lambda state: abs(state.O_T_EE_d[13] - first[13]) > 0.09)
    begin = states[0].O_T_EE_d
    center = begin[13] + 0.05
    for state in states:
        radius = math.hypot(state.O_T_EE_d[13] - center, state.O_T_EE_d[14] - begin[14])
        assert radius == pytest.approx(0.05, abs=1e-4)
        assert state.O_T_EE_d[12] == pytest.approx(begin[12], abs=1e-4)
    assert not [e for e in robot.errors if "Python" in e]


def test_a_failing_script_stops_only_its_controller(robot, tmp_path):
    script = tmp_path / "faulty.py"
    script.write_text(FAULTY)
    parameters = {"class": "Faulty", "command": "joint_velocity", "arm_id": ARM, "joint_names": JOINTS}
    limits = {"max_update_time": 5.0, "max_starting_time": 20.0}
    kind = "franka_example_controllers/PythonController"
    rospy.set_param("/faulty", {"type": kind, "script": str(script), **parameters, **limits})
    rospy.set_param(f"/{MODEL}", {"type": "franka_example_controllers/ModelExampleController", "arm_id": ARM})
    robot.controllers.load("faulty", MODEL)
    robot.controllers.start(MODEL)
    for _ in range(2):  # It can be started again.
        robot.controllers.start("faulty")
        robot.wait_for(lambda: robot.controllers.states()["faulty"] == "stopped", "Its stop")
        robot.wait_for(lambda: any("three hundred" in e for e in robot.errors), "Its error")
        robot.errors.clear()
        robot.wait_until_idle()
        assert MODEL in robot.controllers.running()
        assert max(abs(v) for v in robot.states[-1].dq) < 0.01
        assert not any("reflex" in e for e in robot.errors)
    robot.controllers.unload("faulty")
