# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_gripper_node with a simulated hand and a stone, called as users do, also with invalid goals."""

import math
import os
import statistics
import subprocess
import threading
import time

import actionlib
import pytest
import rospy
from control_msgs.msg import GripperCommand, GripperCommandAction, GripperCommandGoal
from franka_gripper.gripper_node import tolerance
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
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import Panda
from ros_client import Action, launched
from ros_nodes import executable
from sensor_msgs.msg import JointState
from waiting import holds, wait_for

ADDRESS = "127.0.28.1"
PREEMPTED, SUCCEEDED, ABORTED = 2, 3, 4
RECALLED = 8
LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
STREAMED = 200 if LONG else 20  # goals, each before the end of the previous one
PACE = 4.0  # the hand's seconds in a second
SLOW = 0.0015  # [m/s] of motions that another command ends before they end by themselves

# Pairs of a running action and the one that ends it; the long form has all pairs.
ACTIONS = ("homing", "move", "grasp", "gripper_action")
PAIRS = [
    *(("homing", "move"), ("move", "move"), ("grasp", "gripper_action"), ("gripper_action", "grasp")),
    *((first, second) for second in ("stop", "cancel") for first in ACTIONS),
]
if LONG:
    PAIRS = [(first, second) for first in ACTIONS for second in (*ACTIONS, "stop", "cancel")]

# The stone stands on a pedestal below the fingers of an arm in its first pose; it is 30 mm wide.
STONE = (0.3069, 0.0, 0.4869)
WORLD = f"""<mujoco><worldbody>
  <light pos="0 0 3"/>
  <geom type="plane" size="2 2 0.1"/>
  <geom type="box" size="0.05 0.05 0.02" pos="{STONE[0]} 0 {STONE[2] - 0.051}"/>
  <body name="stone" pos="1.0 1.0 0.031"><freejoint/>
    <geom type="box" size="0.02 0.015 0.03" mass="0.1" friction="0.8 0.005 0.0001"/>
  </body>
</worldbody></mujoco>"""
# The speed of gripper_action is a parameter, here a low one: other commands end its motions.
LAUNCH = f"""<launch>
  <include file="$(find franka_gripper)/launch/franka_gripper.launch">
    <arg name="robot_ip" value="{ADDRESS}"/>
  </include>
  <param name="/franka_gripper/default_speed" value="0.01"/>
</launch>"""
KINDS = {
    "homing": HomingAction,
    "stop": StopAction,
    "move": MoveAction,
    "grasp": GraspAction,
    "gripper_action": GripperCommandAction,
}
TOLERANCE = GraspEpsilon(0.005, 0.005)

pytestmark = pytest.mark.own_process


class Fingers:
    """Follows joint_states."""

    def __init__(self):
        self.stamps, self.message = [], None
        rospy.Subscriber("/franka_gripper/joint_states", JointState, self._receive, queue_size=100)

    def _receive(self, message):
        self.message = message
        self.stamps.append(message.header.stamp.to_sec())

    @property
    def width(self):
        return sum(self.message.position)

    def until(self, condition):
        return holds(lambda: self.message is not None and condition(self.width))

    def next(self, count=3):
        """Waits for more messages; returns whether they arrived."""
        end = len(self.stamps) + count
        return holds(lambda: len(self.stamps) >= end)


class Goal:
    """A running goal, and the time of its end."""

    def __init__(self, action, goal):
        self.active, self.ended = threading.Event(), threading.Event()
        self.at, self.sent = None, time.monotonic()
        self.handle = action.send(goal, transition_cb=self._transition)

    def _transition(self, handle):
        state = handle.get_comm_state()
        if state == actionlib.CommState.ACTIVE:
            self.active.set()
        elif state == actionlib.CommState.DONE:
            self.at = time.monotonic()
            self.active.set()
            self.ended.set()

    def until_active(self):
        assert self.active.wait(60.0), "the goal was never accepted"

    def result(self, timeout=60.0):
        """State, success and message."""
        assert self.ended.wait(timeout), "the goal never ended"
        outcome = self.handle.get_result()
        text = getattr(outcome, "error", "") or self.handle.get_goal_status_text()
        success = getattr(outcome, "success", getattr(outcome, "reached_goal", None))
        return self.handle.get_terminal_state(), success, text


class Hand:
    """The simulated hand and stone, and the node's actions and fingers."""

    def __init__(self, world):
        self._world, self.server, self.session = world, None, None

    def start(self):
        self.server = FrankaSim(Panda(address=ADDRESS), world=self._world, pace=PACE)

    def join(self, session):
        self.session = session
        self.actions = {name: Action(f"/franka_gripper/{name}", kind) for name, kind in KINDS.items()}
        self.fingers = Fingers()
        assert self.fingers.until(lambda width: True), "There are no joint states."

    def move(self, width, speed=0.1):
        return Goal(self.actions["move"], MoveGoal(width, speed))

    def grasp(self, width, speed=0.1, force=20.0, epsilon=TOLERANCE):
        return Goal(self.actions["grasp"], GraspGoal(width, epsilon, speed, force))

    def command(self, position, effort=0.0):
        return Goal(self.actions["gripper_action"], GripperCommandGoal(GripperCommand(position, effort)))

    def homing(self):
        return Goal(self.actions["homing"], HomingGoal())

    def stop(self):
        return Goal(self.actions["stop"], StopGoal())

    def open(self):
        if self.fingers.width < 0.0793:
            assert self.move(0.08).result()[0] == SUCCEEDED
            assert self.fingers.until(lambda width: width > 0.0793)

    def reaches(self, width):
        return self.fingers.until(lambda now: abs(now - width) < 1e-3)

    def place_stone(self, between_fingers):
        place = STONE if between_fingers else (1.0, 1.0, 0.031)
        self.server.robot.remote.place_body("stone", place)


@pytest.fixture(scope="module")
def started(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gripper")
    world = folder / "stone.xml"
    world.write_text(WORLD)
    hand = Hand(world)
    hand.start()
    launch = folder / "gripper.launch"
    launch.write_text(LAUNCH)
    try:
        with launched(str(launch), log=folder / "launch.log") as session:
            hand.join(session)
            yield hand
    finally:
        hand.server.kill()


@pytest.fixture
def hand(started):
    """Open, and without the stone."""
    started.open()
    started.place_stone(False)
    return started


@pytest.fixture
def hand_with_stone(hand):
    hand.place_stone(True)
    yield hand
    hand.open()
    hand.place_stone(False)


def test_homing_succeeds(hand):
    assert hand.homing().result() == (SUCCEEDED, True, "")


def test_joint_states_name_the_fingers(hand):
    assert hand.fingers.message.name == ["panda_finger_joint1", "panda_finger_joint2"]


def test_a_move_reaches_its_width(hand):
    assert hand.move(0.03).result() == (SUCCEEDED, True, "")
    assert hand.reaches(0.03)


def test_a_grasp_without_object_is_reported(hand):
    hand.move(0.03).result()
    state, success, text = hand.grasp(0.02).result()
    assert (state, success) == (SUCCEEDED, False)
    assert "there is no object between them" in text
    assert hand.fingers.until(lambda width: width < 0.002)


def test_gripper_command_takes_one_finger_and_returns_the_whole_width(hand):
    moved = hand.command(0.01)
    assert moved.result()[:2] == (SUCCEEDED, True)
    assert moved.handle.get_result().position == pytest.approx(0.02, abs=1e-3)
    assert hand.command(0.01).result()[:2] == (SUCCEEDED, True)  # it is there already
    missed = hand.command(0.0025, 10.0)
    state, success, text = missed.result()
    assert (state, success) == (ABORTED, False)
    assert "did not reach" in text
    assert outcome_of(missed) == (pytest.approx(0.0, abs=2e-3), True, 0.0)
    beyond = hand.command(0.05)
    assert beyond.result()[0] == ABORTED
    assert outcome_of(beyond) == (pytest.approx(0.0, abs=2e-3), False, 0.0)


def outcome_of(goal):
    """A GripperCommand's width, whether the fingers are stalled, and their effort."""
    result = goal.handle.get_result()
    return result.position, result.stalled, result.effort


def test_gripper_command_grasps_the_stone(hand_with_stone):
    grasp = hand_with_stone.command(0.014, 20.0)
    assert grasp.result()[:2] == (SUCCEEDED, True)
    assert outcome_of(grasp) == (pytest.approx(0.03, abs=1e-3), True, 20.0)


def test_a_grasp_of_the_expected_width_succeeds(hand_with_stone):
    assert hand_with_stone.grasp(0.03).result() == (SUCCEEDED, True, "")
    assert hand_with_stone.reaches(0.03)


@pytest.mark.parametrize("expected, grasped", [(0.04, True), (0.02, False)])
def test_a_grasp_allows_the_inner_epsilon_below_and_the_outer_above(hand_with_stone, expected, grasped):
    """The stone is 0.03 m wide."""
    epsilon = GraspEpsilon(inner=0.015, outer=0.002)
    state, success, text = hand_with_stone.grasp(expected, epsilon=epsilon).result()
    assert (state, success) == (SUCCEEDED, grasped)
    assert grasped or "another one than expected" in text


def test_a_blocked_move_ends_and_reports_the_width(hand_with_stone):
    state, success, text = hand_with_stone.move(0.0, 0.05).result()
    assert (state, success) == (SUCCEEDED, False)
    assert "something is in their way" in text and "instead of 0.0 mm" in text
    assert hand_with_stone.fingers.until(lambda width: abs(width - 0.03) < 2e-3)


class Interruption:
    """An action that another one ends: its outcome, the time that this took, and the new one's state."""

    def __init__(self, hand, first, second):
        slow = {
            "homing": hand.homing,
            "move": lambda: hand.move(0.0, SLOW),
            "grasp": lambda: hand.grasp(0.02, SLOW),
            "gripper_action": lambda: hand.command(0.0),
        }
        others = {
            "homing": hand.homing,
            "move": lambda: hand.move(0.03, SLOW),
            "grasp": lambda: hand.grasp(0.01, SLOW),
            "gripper_action": lambda: hand.command(0.0),
            "stop": hand.stop,
        }
        hand.open()
        running, new = slow[first](), None
        self.moved = hand.fingers.until(lambda width: width < 0.0785)
        if second == "cancel":
            begin = time.monotonic()
            running.handle.cancel()
        else:
            new = others[second]()
            begin = new.sent
        self.outcome = running.result()
        self.seconds = running.at - begin
        self.position = getattr(running.handle.get_result(), "position", None)
        if second in slow:
            new.until_active()
            hand.stop().result()
        self.new_state = new and new.result()[0]


@pytest.fixture(scope="module")
def interruption(started):
    """Interruptions by their pairs of actions; each is made once."""
    made = {}

    def make(*pair):
        if pair not in made:
            made[pair] = Interruption(started, *pair)
        return made[pair]

    return make


@pytest.mark.parametrize("first, second", PAIRS)
def test_a_new_goal_or_stop_ends_the_running_action(interruption, first, second):
    seen = interruption(first, second)
    assert seen.moved
    state, success, text = seen.outcome
    assert state == (ABORTED if second == "stop" else PREEMPTED), text
    assert not success
    assert "ended this one" in text
    if first == "gripper_action":
        assert 0.04 < seen.position < 0.0785, "the width"
    assert seen.new_state == {"stop": SUCCEEDED, "cancel": None}.get(second, ABORTED)


@pytest.mark.realtime("the latency of an interruption")
def test_interruptions_take_less_than_100_ms(interruption):
    assert statistics.median(interruption(*pair).seconds for pair in PAIRS) < 0.1


@pytest.fixture(scope="module")
def stream(started):
    """Goals, each once the previous one is carried out: their states, and joint states meanwhile."""
    started.open()
    begin, goals = len(started.fingers.stamps), []
    for i in range(STREAMED):
        goals.append(started.move(0.02 if i % 2 else 0.06, SLOW if i < STREAMED - 1 else 0.1))
        goals[-1].until_active()
    states = [goal.result()[0] for goal in goals]
    return states, started.reaches(0.02), started.fingers.stamps[begin:]


def test_the_last_goal_of_a_stream_is_carried_out(stream):
    states, reached, _ = stream
    assert set(states[:-1]) <= {PREEMPTED, RECALLED}
    assert states[-1] == SUCCEEDED
    assert reached


@pytest.mark.realtime("the rate of joint states")
def test_joint_states_keep_their_rate_during_actions(stream):
    stamps = stream[2]
    gaps = [b - a for a, b in zip(stamps, stamps[1:])]
    assert statistics.median(gaps) == pytest.approx(1 / 30, rel=0.05)
    assert max(gaps) < 0.5


WIDTH = "it must lie between 0 and 0.08 m"


INVALID = [
    (lambda hand: hand.move(math.nan), WIDTH),
    (lambda hand: hand.move(-0.01), WIDTH),
    (lambda hand: hand.move(0.2), WIDTH),
    (lambda hand: hand.grasp(math.nan), WIDTH),
    (lambda hand: hand.grasp(math.inf), WIDTH),
    (lambda hand: hand.move(0.04, math.nan), "Only positive speeds"),
    (lambda hand: hand.move(0.04, -0.1), "Only positive speeds"),
    (lambda hand: hand.move(0.04, 0.0), "Only positive speeds"),
    (lambda hand: hand.grasp(0.02, -1.0), "Only positive speeds"),
    (lambda hand: hand.grasp(0.02, force=math.nan), "The force must be"),
    (lambda hand: hand.grasp(0.02, force=-1.0), "The force must be"),
    (lambda hand: hand.grasp(0.02, epsilon=GraspEpsilon(-0.1, 0.005)), "The epsilons must be"),
    (lambda hand: hand.command(math.nan), "it must lie between"),
    (lambda hand: hand.command(-0.01), "it must lie between"),
    (lambda hand: hand.command(0.08), "it must lie between"),
    (lambda hand: hand.command(0.02, math.nan), "max_effort must be"),
]


@pytest.mark.parametrize("kind", ["move", "grasp"])
def test_invalid_goals_are_refused_and_end_no_running_one(hand, kind):
    running = getattr(hand, kind)(0.0, SLOW)
    running.until_active()
    for row, (send, sentence) in enumerate(INVALID):
        state, success, text = send(hand).result()
        assert (state, success) == (ABORTED, False), row
        assert sentence in text, row
    assert not running.ended.is_set()
    running.handle.cancel()
    assert running.result()[0] == PREEMPTED


def test_a_lost_hand_is_reported_and_reconnected(hand):
    running = hand.move(0.0, SLOW)
    hand.fingers.until(lambda width: width < 0.0785)
    hand.server.kill()
    state, _, text = running.result()
    assert state == ABORTED and "libfranka" in text
    state, _, text = hand.move(0.05).result()
    assert state == ABORTED and text
    # No old widths with new time stamps.
    wait_for(lambda: time.time() - hand.fingers.stamps[-1] >= 1.0, "The end of joint states", 30.0)
    hand.start()
    assert hand.fingers.next(5)
    assert hand.move(0.05).result() == (SUCCEEDED, True, "")
    assert hand.reaches(0.05)


def test_a_missing_default_epsilon_is_zero_beside_the_other_one(started):
    def epsilons():
        return tolerance("inner"), tolerance("outer")

    assert epsilons() == (0.005, 0.005), "without the parameter"
    for given, expected in (({"inner": 0.01}, (0.01, 0.0)), ({"outer": 0.02}, (0.0, 0.02))):
        rospy.set_param("~default_grasp_epsilon", given)
        assert epsilons() == expected


NAMES = "_joint_names:=[a, b]"
WRONG = {
    "no address": ([NAMES], "/robot_ip is missing"),
    "one name": ([f"_robot_ip:={ADDRESS}", "_joint_names:=[a]"], "must hold two names"),
    "no rate": (
        [f"_robot_ip:={ADDRESS}", NAMES, "_publish_rate:=0"],
        "publish_rate must be a number not below 0.001",
    ),
    "no map": (
        [f"_robot_ip:={ADDRESS}", NAMES, "_default_grasp_epsilon:=0.1"],
        "default_grasp_epsilon must be a map",
    ),
    "no gripper": (["_robot_ip:=127.0.28.9", NAMES], "no gripper at 127.0.28.9"),
}


@pytest.fixture(scope="module")
def wrong_nodes(started):
    """Nodes with wrong parameters; all are started at once."""
    nodes = {}
    for i, (case, (arguments, _)) in enumerate(WRONG.items()):
        nodes[case] = subprocess.Popen(
            [executable("franka_gripper", "franka_gripper_node"), f"__name:=wrong_{i}", *arguments],
            env=started.session.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
    yield nodes
    for node in nodes.values():
        node.kill()
        node.wait()


@pytest.mark.parametrize("case", WRONG)
def test_a_node_that_cannot_start_reports_why_and_exits(wrong_nodes, case):
    text, _ = wrong_nodes[case].communicate(timeout=300)
    assert wrong_nodes[case].returncode == 255
    assert WRONG[case][1] in text
    assert "Traceback" not in text
