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
from waiting import holds, wait_for

START, MIN_DURATION = 0.2, 1.0  # [s], franka_description's physics.yaml
WAIT = 120.0  # [s]
MOVED = 2e-4  # [m]
STEP = 20  # [ticks], shorter than the time between two widths
# [s] of the wall clock until a width counts as lost: a publisher drops one that comes while it still sends
# the one before, and a world that is paused brings no further one.
ARRIVAL = 1.0
PUBLISHED = rospy.Duration(0.04)  # [s] between two widths, at most
LAUNCH = ["franka_gazebo", "panda.launch", "headless:=true", "realism:=real"]


class Hand:
    """The hand of a robot in a world that is paused: each move takes the ticks that the test steps."""

    def __init__(self):
        self._widths = []  # of all joint states: time, width [m]
        self._results = []
        rospy.Subscriber("/franka_gripper/joint_states", JointState, self._take, queue_size=1000)
        rospy.Subscriber("/franka_gripper/move/result", MoveActionResult, self._results.append)
        self._action = Action("/franka_gripper/move", MoveAction, WAIT)
        wait_for(lambda: self._widths, "The first width", WAIT)
        call("/gazebo/pause_physics", Empty)
        self.next_width()  # sets the world's time

    def _take(self, state):
        self._widths.append((state.header.stamp, sum(state.position)))

    def move(self, width):
        """Moves the fingers [m]. @returns times [s] until the first motion and until the result, or more: the
        goal, the widths and the result may arrive some steps late."""
        begin, before, count = self._time, self._widths[-1][1], len(self._results)
        goal, first = self._action.send(MoveGoal(width=width, speed=0.1)), None
        while len(self._results) == count:
            if abs(self.next_width() - before) > MOVED and first is None:
                first = self._widths[-1][0] - begin
            assert (self._time - begin).to_sec() < WAIT, "The hand gives no result"
        status, text = outcome(goal, WAIT)
        assert status == GoalStatus.SUCCEEDED, text
        return {"first": first and first.to_sec(), "took": (self._time - begin).to_sec()}

    def next_width(self):
        """Steps the world, again if the width was lost. @returns the width then [m]"""

        def arrives():
            self._time = call("/gazebo/step", Step, STEP).time
            return holds(lambda: self._widths[-1][0] > self._time - PUBLISHED, ARRIVAL)

        wait_for(arrives, "The next width", WAIT)
        return self._widths[-1][1]


@pytest.mark.own_process
def test_moves_of_a_real_hand_take_a_second(tmp_path):
    with launched(*LAUNCH, log=tmp_path / "launch.log"):
        hand = Hand()
        hand.move(0.04)
        small, large = hand.move(0.041), hand.move(0.08)
    assert small["took"] >= MIN_DURATION and large["took"] >= MIN_DURATION, (small, large)
    assert large["first"] >= START, large
