# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Calls franka_gripper_node as users do, also with invalid goals; prints the results as JSON.

Run by test_gripper_node.py with the interpreter that ROS uses. Arguments: the robot's address, the place
of the stone between the fingers, the goals of the stream, and which action shall end which, as `move,grasp`.
"""

import json
import math
import sys
import threading
import time

import actionlib
import rospy
import rospy_connections
from control_msgs.msg import GripperCommand, GripperCommandAction, GripperCommandGoal
from franka_gripper.msg import (
    GraspAction,
    GraspEpsilon,
    GraspGoal,
    HomingAction,
    HomingGoal,
    MoveAction,
    MoveGoal,
    StopAction,
    StopGoal,
)
from pyfranka.remote import Remote
from sensor_msgs.msg import JointState

REMOTE, PLACE, PAIRS = Remote(sys.argv[1], timeout=20.0), list(map(float, sys.argv[2:5])), sys.argv[6:]
KINDS = {
    "homing": HomingAction,
    "stop": StopAction,
    "move": MoveAction,
    "grasp": GraspAction,
    "gripper_action": GripperCommandAction,
}
TOLERANCE = GraspEpsilon(0.005, 0.005)


class Fingers:
    """Follows joint_states."""

    def __init__(self):
        self.stamps, self.message = [], None
        self._changed = threading.Condition()
        rospy.Subscriber("/franka_gripper/joint_states", JointState, self._receive, queue_size=100)

    def _receive(self, message):
        with self._changed:
            self.message = message
            self.stamps.append(message.header.stamp.to_sec())
            self._changed.notify_all()

    @property
    def width(self):
        return sum(self.message.position)

    def until(self, condition, timeout=20.0):
        with self._changed:
            return self._changed.wait_for(lambda: self.message is not None and condition(self.width), timeout)

    def next(self, count=3, timeout=20.0):
        """Waits for more messages; returns whether they arrived."""
        with self._changed:
            end = len(self.stamps) + count
            return self._changed.wait_for(lambda: len(self.stamps) >= end, timeout)


class Goal:
    """A running goal, and the time of its end."""

    def __init__(self, name, goal):
        self.name, self.active, self.ended = name, threading.Event(), threading.Event()
        self.at, self.sent = None, time.monotonic()
        self.client = CLIENTS[name]
        self.handle = self.client.send_goal(goal, transition_cb=self._transition)

    def _transition(self, handle):
        state = handle.get_comm_state()
        if state == actionlib.CommState.ACTIVE:
            self.active.set()
        elif state == actionlib.CommState.DONE:
            self.at = time.monotonic()
            self.active.set()
            self.ended.set()

    def until_active(self):
        self.active.wait(20.0)

    def result(self, timeout=30.0):
        """[state, success, message], or what is missing."""
        if not self.ended.wait(timeout):
            return ["never ended", None, self.name]
        outcome = self.handle.get_result()
        text = getattr(outcome, "error", "") or self.handle.get_goal_status_text()
        success = getattr(outcome, "success", getattr(outcome, "reached_goal", None))
        return [self.handle.get_terminal_state(), success, text]


CLIENTS = {}


def move(width, speed=0.1):
    return Goal("move", MoveGoal(width, speed))


def grasp(width, speed=0.1, force=20.0, epsilon=TOLERANCE):
    return Goal("grasp", GraspGoal(width, epsilon, speed, force))


def command(position, effort=0.0):
    return Goal("gripper_action", GripperCommandGoal(GripperCommand(position, effort)))


def homing():
    return Goal("homing", HomingGoal())


def stop():
    return Goal("stop", StopGoal())


def stone(between):
    REMOTE.place("stone", PLACE if between else (1.0, 1.0, 0.031))


def opened(fingers):
    return [move(0.08).result(), fingers.until(lambda width: width > 0.0793)]


def plain(fingers):
    """Each action in normal use."""
    report = {"homing": homing().result(), "names": fingers.message.name}
    report["move"] = move(0.03).result() + [fingers.until(lambda width: abs(width - 0.03) < 1e-3)]
    report["empty grasp"] = grasp(0.02).result() + [fingers.width]
    opened(fingers)
    moved = command(0.01)
    report["command moves"] = moved.result() + [moved.handle.get_result().position]
    report["command is there"] = command(0.01).result()
    report["command grasps nothing"] = command(0.0025, 10.0).result()
    opened(fingers)
    return report


def with_stone(fingers):
    """The stone is 30 mm wide."""
    report = {}
    for name, width in {"fits": 0.03, "too wide": 0.015, "too narrow": 0.05}.items():
        stone(True)
        report[name] = grasp(width).result() + [fingers.width]
        report[name + " opened"] = opened(fingers)
    stone(True)
    begin = time.monotonic()
    report["obstacle"] = move(0.0, 0.05).result() + [time.monotonic() - begin, fingers.width]
    opened(fingers)
    stone(True)
    report["command grasps"] = command(0.014, 20.0).result()
    opened(fingers)
    stone(True)
    report["hold"] = grasp(0.03, force=5.0).result()
    REMOTE.push("stone", (20, 0, 0), 60)  # out of the fingers, but not out of the world
    report["slipped"] = fingers.until(lambda width: width < 0.005)
    opened(fingers)
    stone(False)
    return report


def interrupted(fingers):
    """Actions ended by others, or cancelled: state and duration of each."""
    slow = {
        "homing": homing,
        "move": lambda: move(0.0, 0.02),
        "grasp": lambda: grasp(0.02, 0.02),
        "gripper_action": lambda: command(0.0),
    }
    starts = {
        "homing": homing,
        "move": lambda: move(0.03, 0.02),
        "grasp": lambda: grasp(0.01, 0.02),
        "gripper_action": lambda: command(0.0),  # the longest motion: it must not end by itself
        "stop": stop,
    }
    report = {}
    for pair in PAIRS:
        first, second = pair.split(",")
        opened(fingers)
        running = slow[first]()
        moving = fingers.until(lambda width: width < 0.0785)
        if second == "cancel":
            at, new = time.monotonic(), None
            running.handle.cancel()
        else:
            new = starts[second]()
            at = new.sent
        outcome = running.result()
        report[pair] = outcome + [running.at and running.at - at, moving]
        if second in slow:
            new.until_active()
            stop().result()
        report[pair].append(new and new.result()[0])
    return report


def stopped_on_the_way(fingers):
    opened(fingers)
    running = grasp(0.02, 0.05)
    fingers.until(lambda width: width < 0.06)
    ended = stop().result()
    fingers.next(3)
    begin = fingers.width
    fingers.next(15)
    return {"stop": ended, "grasp": running.result(), "begin": begin, "end": fingers.width}


def stream(fingers, count):
    """Goals at 20 Hz, each before the end of the previous one."""
    opened(fingers)
    begin = len(fingers.stamps)
    at = time.monotonic()
    goals = []
    for i in range(count):
        goals.append(move(0.02 if i % 2 else 0.06, 0.05))
        time.sleep(max(0.0, at + 0.05 * (i + 1) - time.monotonic()))
    states = [goal.result()[0] for goal in goals]
    reached = fingers.until(lambda width: abs(width - 0.02) < 1e-3)
    stamps = fingers.stamps[begin:]
    return {"states": states, "reached": reached, "gaps": [b - a for a, b in zip(stamps, stamps[1:])]}


def nonsense(fingers):
    nan, inf = math.nan, math.inf
    goals = {
        "move nan": lambda: move(nan),
        "move below": lambda: move(-0.01),
        "move beyond": lambda: move(0.2),
        "move speed nan": lambda: move(0.04, nan),
        "move speed below": lambda: move(0.04, -0.1),
        "move speed zero": lambda: move(0.04, 0.0),
        "grasp nan": lambda: grasp(nan),
        "grasp beyond": lambda: grasp(inf),
        "grasp speed": lambda: grasp(0.02, -1.0),
        "grasp force nan": lambda: grasp(0.02, force=nan),
        "grasp force below": lambda: grasp(0.02, force=-1.0),
        "grasp epsilon": lambda: grasp(0.02, epsilon=GraspEpsilon(-0.1, 0.005)),
        "command nan": lambda: command(nan),
        "command below": lambda: command(-0.01),
        "command beyond": lambda: command(0.08),
        "command effort": lambda: command(0.02, nan),
    }
    opened(fingers)
    report = {name: begin().result() for name, begin in goals.items()}
    report["width"] = fingers.width
    return report


def death(fingers):
    """The hand is lost during a move, and is started again."""
    opened(fingers)
    running = move(0.0, 0.01)
    fingers.until(lambda width: width < 0.0785)
    print("kill", flush=True)
    report = {"running": running.result()}
    report["meanwhile"] = move(0.05).result()
    deadline = time.monotonic() + 30.0
    while time.time() - fingers.stamps[-1] < 1.0 and time.monotonic() < deadline:
        time.sleep(0.05)
    report["silent"] = time.time() - fingers.stamps[-1] >= 1.0
    print("restart", flush=True)
    sys.stdin.readline()
    report["again"] = fingers.next(5, 60.0)
    report["move"] = move(0.05).result() + [fingers.until(lambda width: abs(width - 0.05) < 1e-3)]
    return report


def main():
    rospy_connections.init_node("gripper_client", anonymous=True)
    for name, kind in KINDS.items():
        CLIENTS[name] = actionlib.ActionClient(f"/franka_gripper/{name}", kind)
        if not CLIENTS[name].wait_for_server(rospy.Duration(60)):
            raise RuntimeError(f"There is no action {name}.")
    fingers = Fingers()
    fingers.until(lambda width: True)
    report = {}
    for scenario in (plain, with_stone, interrupted, stopped_on_the_way, nonsense):
        report[scenario.__name__] = scenario(fingers)
    report["stream"] = stream(fingers, int(sys.argv[5]))
    report["death"] = death(fingers)
    print(json.dumps(report), flush=True)


if __name__ == "__main__":
    main()
