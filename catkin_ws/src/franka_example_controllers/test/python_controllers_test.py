#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The Python examples move a simulated FR3; a failing script stops only its controller."""

import math
import tempfile
import time
import unittest
from pathlib import Path

import rospy
import rospy_connections
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController, UnloadController
from franka_msgs.msg import FrankaState
from rosgraph_msgs.msg import Log

ARM = "fr3"
IMPEDANCE = "python_joint_impedance_example_controller"
CIRCLE = "python_cartesian_circle_example_controller"
MODEL = "model_example_controller"
LIMIT = 120.0  # [s] of the wall
STRICT = 2


class PythonControllersTest(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.states, cls.errors = [], []
        rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, cls.states.append)
        rospy.Subscriber("/rosout", Log, lambda m: m.level >= Log.ERROR and cls.errors.append(m.msg))
        rospy.wait_for_service("/controller_manager/list_controllers", LIMIT)
        cls.list = rospy.ServiceProxy("/controller_manager/list_controllers", ListControllers)
        cls.load = rospy.ServiceProxy("/controller_manager/load_controller", LoadController)
        cls.unload = rospy.ServiceProxy("/controller_manager/unload_controller", UnloadController)
        cls.switch_service = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)

    def wait_for(self, condition, what):
        end = time.monotonic() + LIMIT
        while not condition():
            self.assertLess(time.monotonic(), end, f"{what} {self.errors}")
            time.sleep(0.02)

    def state_of(self, name):
        return next((c.state for c in self.list().controller if c.name == name), "absent")

    def switch(self, start=(), stop=()):
        answer = self.switch_service(
            start_controllers=list(start), stop_controllers=list(stop), strictness=STRICT, timeout=20.0
        )
        self.assertTrue(answer.ok, self.errors)

    def record(self, name, seconds):
        """The states of a controller's first seconds."""
        self.assertTrue(self.load(name).ok, self.errors)
        self.wait_for(
            lambda: self.states and self.states[-1].robot_mode == FrankaState.ROBOT_MODE_IDLE, "Not idle."
        )
        self.switch(start=[name])
        begin = self.states[-1].header.stamp
        self.wait_for(lambda: (self.states[-1].header.stamp - begin).to_sec() > seconds, "Time stands.")
        self.switch(stop=[name])
        return [
            s
            for s in list(self.states)
            if s.header.stamp >= begin and s.robot_mode == FrankaState.ROBOT_MODE_MOVE
        ]

    def test_1_joint_impedance_moves_the_fourth_joint(self):
        self.wait_for(lambda: self.states, "There is no state.")
        begin = self.states[-1].q
        states = self.record(IMPEDANCE, 4.0)
        self.assertGreater(len(states), 60)
        # Half a swing of 0.1 rad in 2.5 s; the time of the start is not known better than a state.
        swing = [s.q[3] - begin[3] for s in states]
        self.assertAlmostEqual(0.1, max(swing), delta=0.005)
        for joint in (0, 1, 2, 4, 5, 6):
            self.assertLess(max(abs(s.q[joint] - begin[joint]) for s in states), 0.01)

    def test_2_cartesian_example_moves_on_a_circle(self):
        states = self.record(CIRCLE, 5.0)
        begin = states[0].O_T_EE_d
        centre = begin[13] + 0.05
        for state in states:
            radius = math.hypot(state.O_T_EE_d[13] - centre, state.O_T_EE_d[14] - begin[14])
            self.assertAlmostEqual(0.05, radius, delta=1e-4)
            self.assertAlmostEqual(begin[12], state.O_T_EE_d[12], delta=1e-4)
        self.assertGreater(max(abs(s.O_T_EE_d[13] - begin[13]) for s in states), 0.09)
        self.assertEqual([], [e for e in self.errors if "Python" in e])

    def test_3_a_failing_script_stops_only_its_controller(self):
        with tempfile.TemporaryDirectory() as folder:
            script = Path(folder) / "faulty.py"
            script.write_text(
                "class Faulty:\n"
                "  def starting(self, state, model): self.n = 0\n"
                "  def update(self, state, model, period):\n"
                "    self.n += 1\n"
                "    if self.n > 300: raise ArithmeticError('three hundred')\n"
                "    return [0.1 * min(self.n, 100) / 100] + [0.0] * 6\n"
            )
            joints = [f"{ARM}_joint{i}" for i in range(1, 8)]
            rospy.set_param("faulty", {
                "type": "franka_example_controllers/PythonController", "script": str(script),
                "class": "Faulty", "command": "joint_velocity", "arm_id": ARM, "joint_names": joints,
                "max_update_time": 5.0, "max_starting_time": 20.0,
            })  # fmt: skip
            rospy.set_param(
                MODEL, {"type": "franka_example_controllers/ModelExampleController", "arm_id": ARM}
            )
            self.assertTrue(self.load("faulty").ok)
            self.assertTrue(self.load(MODEL).ok)
            for _ in range(2):  # It can be started again.
                self.switch(start=["faulty"] + ([MODEL] if self.state_of(MODEL) != "running" else []))
                self.wait_for(lambda: self.state_of("faulty") == "stopped", "It is not stopped.")
                self.wait_for(lambda: any("three hundred" in e for e in self.errors), "Nothing is said.")
                self.errors.clear()
                self.wait_for(lambda: self.states[-1].robot_mode == FrankaState.ROBOT_MODE_IDLE, "Not idle.")
                self.assertEqual("running", self.state_of(MODEL))
                self.assertLess(max(abs(v) for v in self.states[-1].dq), 0.01)
                self.assertFalse(any("reflex" in e for e in self.errors))
            self.assertTrue(self.unload("faulty").ok)
            self.switch(stop=[MODEL])


if __name__ == "__main__":
    import rostest

    rospy_connections.init_node("python_controllers_test", disable_rostime=True)
    rostest.rosrun("franka_example_controllers", "python_controllers", PythonControllersTest)
