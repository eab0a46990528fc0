# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The hand's latency over ROS, by the simulation's own controller (on the network: test_hardware)."""

import pytest
import rospy
from actionlib_msgs.msg import GoalStatus
from franka_gripper.msg import MoveAction, MoveActionResult, MoveGoal
from franka_sim_mujoco.srv import Step
from ros_client import Action, call, launched, outcome
from sensor_msgs.msg import JointState
from std_srvs.srv import Empty
from waiting import wait_for

START, MIN_DURATION = 0.2, 1.0  # [s], franka_description's physics.yaml
WAIT = 120.0  # [s]
MOVED = 2e-4  # [m]
STEP = 20  # [ticks], shorter than the time between two widths, the second of which could be lost
PUBLISHED = rospy.Duration(0.04)  # [s] between two widths, at most
LAUNCHES = {
    "ideal": ["franka_gazebo", "fr3.launch", "headless:=true"],
    "in-simulation": [
        "franka_gazebo",
        "panda.launch",
        "headless:=true",
        "realism:=real",
        "real_time_factor:=4",
    ],
}


class Hand:
    """The hand of a simulated robot, and how long each of its moves takes in simulated time."""

    def __init__(self):
        self._widths = []  # of all joint states: time, width [m]
        self._results = []
        rospy.Subscriber("/franka_gripper/joint_states", JointState, self._take, queue_size=1000)
        rospy.Subscriber("/franka_gripper/move/result", MoveActionResult, self._results.append)
        self._action = Action("/franka_gripper/move", MoveAction, WAIT)
        wait_for(lambda: self._widths, "The first width", WAIT)

    def _take(self, state):
        self._widths.append((state.header.stamp, sum(state.position)))

    def move(self, width):
        """Moves the fingers [m]. @returns times [s] until the first motion and until the result."""
        before, count = self._widths[-1][1], len(self._results)
        status, text = outcome(self.begin(width), WAIT)
        wait_for(lambda: len(self._results) > count, "The result", WAIT)
        result = self._results[-1]  # whose times do not depend on when this process gets it
        begin = result.status.goal_id.stamp
        assert status == GoalStatus.SUCCEEDED, text
        moved = [time for time, value in list(self._widths) if time > begin and abs(value - before) > MOVED]
        return {
            "first": (moved[0] - begin).to_sec() if moved else None,
            "took": (result.header.stamp - begin).to_sec(),  # exact, in whole nanoseconds
        }

    def begin(self, width):
        """Begins a move of the fingers [m]. @returns the goal's handle"""
        return self._action.send(MoveGoal(width=width, speed=0.1))

    def next_width(self):
        """Steps a paused world. @returns the width then [m]"""
        end = call("/gazebo/step", Step, STEP).time - PUBLISHED
        wait_for(lambda: self._widths[-1][0] > end, "The next width", WAIT)
        return self._widths[-1][1]


@pytest.mark.own_process
def test_moves_of_a_real_hand_take_a_second(tmp_path):
    with launched(*LAUNCHES["in-simulation"], log=tmp_path / "launch.log"):
        hand = Hand()
        hand.move(0.04)
        small, large = hand.move(0.041), hand.move(0.08)
    assert small["took"] >= MIN_DURATION and large["took"] >= MIN_DURATION, (small, large)
    assert large["first"] >= START, large


@pytest.mark.own_process
def test_an_ideal_hand_moves_at_once(tmp_path):
    """The result follows the arrival of the fingers within 0.2 s: a real hand would take until 1 s."""
    with launched(*LAUNCHES["ideal"], log=tmp_path / "launch.log"):
        hand = Hand()
        hand.move(0.04)
        call("/gazebo/pause_physics", Empty)
        result = hand.begin(0.041)
        wait_for(lambda: abs(hand.next_width() - 0.041) < MOVED, "The fingers' arrival", WAIT)
        for _ in range(10):
            hand.next_width()
        assert outcome(result, WAIT)[0] == GoalStatus.SUCCEEDED
