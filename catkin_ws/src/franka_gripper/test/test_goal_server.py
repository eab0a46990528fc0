# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Goals of the gripper's actions after a jump of the clock, without a node."""

import threading

import pytest
import rospy
from franka_gripper.gripper_node import GoalServer


class Goal:
    """A goal handle of actionlib. stamp: when the client sent it [s]."""

    def __init__(self, stamp=None):
        self.id = type("Id", (), {"id": "", "stamp": stamp is not None and rospy.Time.from_sec(stamp)})
        self.canceled = False

    def get_goal(self):
        return bool(self.id.stamp)

    def get_goal_id(self):
        return self.id

    def set_canceled(self, *_):
        self.canceled = True


@pytest.mark.parametrize(
    ("earlier", "sent", "arrives", "canceled"),
    [
        (1000.0, 100.0, 100.0, False),
        (1000.0, 100.0, 100.2, False),  # the clock went on meanwhile
        (100.0, 101.0, 101.1, False),
        (100.0, 99.0, 101.0, True),  # overtaken, without a jump
    ],
)
def test_only_goals_that_were_overtaken_are_canceled(earlier, sent, arrives, canceled, monkeypatch):
    monkeypatch.setattr(rospy.Time, "now", lambda: rospy.Time.from_sec(arrives))
    server = GoalServer.__new__(GoalServer)
    server.execute_condition = threading.Condition()
    server.current_goal, server.next_goal = Goal(earlier), Goal()
    server.is_active = lambda: False
    server.goal_callback = None
    server.refuse = lambda _handle: False
    goal = Goal(sent)
    server.internal_goal_callback(goal)
    assert goal.canceled == canceled
    assert (server.next_goal is goal) != canceled
