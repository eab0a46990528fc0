# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_gripper_node with a simulated hand and a stone; checks the report of gripper_client.py."""

import json
import os
import statistics
import subprocess
import time
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session
from lines import Lines
from pyfranka.franka_sim import FrankaSim, SimRobot

HERE = Path(__file__).resolve().parent
ADDRESS = "127.0.31.1"
PREEMPTED, SUCCEEDED, ABORTED = 2, 3, 4
RECALLED = 8
LONG = bool(os.environ.get("FRANKA_TEST_LONG"))

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


def start_hand(world) -> FrankaSim:
    return FrankaSim(SimRobot("panda", address=ADDRESS), world=world, pace="realtime")


def talk(client, world, hand) -> tuple[dict, FrankaSim]:
    """Reads the client's output, and ends and starts the hand on request."""
    lines = Lines(client.stdout)
    deadline = time.monotonic() + 600
    while time.monotonic() < deadline:
        line = lines.next(120.0)
        if line is None:
            break
        if line == "kill":
            hand.kill()
        elif line == "restart":
            hand = start_hand(world)
            client.stdin.write("\n")
            client.stdin.flush()
        elif line.startswith("{"):
            return json.loads(line), hand
    pytest.fail("The client has ended early.")


def errors_of_nodes(session) -> dict:
    """Exit of nodes with errors: [status, output]."""
    names = "_joint_names:=[a, b]"
    cases = {
        "no address": [names],
        "one name": ["_robot_ip:=127.0.31.1", "_joint_names:=[a]"],
        "no rate": ["_robot_ip:=127.0.31.1", names, "_publish_rate:=0"],
        "no map": ["_robot_ip:=127.0.31.1", names, "_default_grasp_epsilon:=0.1"],
        "no such host": ["_robot_ip:=no.such.host.invalid", names],
        "no gripper": ["_robot_ip:=127.0.31.9", names],
    }
    nodes = {}
    for i, (name, arguments) in enumerate(cases.items()):
        nodes[name] = subprocess.Popen(
            ["rosrun", "franka_gripper", "franka_gripper_node", f"__name:=wrong_{i}", *arguments],
            env=session.environment,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
        )
    report = {}
    for name, node in nodes.items():
        try:
            report[name] = [node.wait(300), node.stdout.read()]
        except subprocess.TimeoutExpired:
            report[name] = ["does not end", ""]  # the session ends it
    return report


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    folder = tmp_path_factory.mktemp("gripper")
    world = folder / "stone.xml"
    world.write_text(WORLD)
    hand = start_hand(world)
    client = None
    launch = ["franka_gripper", "franka_gripper.launch", f"robot_ip:={ADDRESS}"]
    try:
        with Session(*launch, log=folder / "launch.log") as session:
            session.wait_for_master()
            command = ["/usr/bin/python3", str(HERE / "gripper_client.py"), ADDRESS]
            client = subprocess.Popen(
                [*command, *map(str, STONE), "200" if LONG else "40", *map(",".join, PAIRS)],
                env=session.environment,
                stdin=subprocess.PIPE,
                stdout=subprocess.PIPE,
                text=True,
            )
            result, hand = talk(client, world, hand)
            session.check()
            result["complaints"] = errors_of_nodes(session)
            print(session.tail(80))
            return result
    finally:
        hand.kill()
        if client is not None:
            client.kill()
            client.wait()


def test_each_action_moves_the_hand(report):
    plain = report["plain"]
    assert plain["homing"] == [SUCCEEDED, True, ""]
    assert plain["names"] == ["panda_finger_joint1", "panda_finger_joint2"]
    assert plain["move"] == [SUCCEEDED, True, "", True]


def test_a_grasp_without_object_is_reported(report):
    state, success, text, width = report["plain"]["empty grasp"]
    assert (state, success) == (SUCCEEDED, False)
    assert "there is no object between them" in text
    assert width < 0.002


def test_gripper_command_takes_one_finger_and_returns_the_whole_width(report):
    plain = report["plain"]
    assert plain["command moves"][:2] == [SUCCEEDED, True]
    assert plain["command moves"][3] == pytest.approx(0.02, abs=1e-3)
    assert plain["command is there"][:2] == [SUCCEEDED, True]
    assert plain["command grasps nothing"][:2] == [ABORTED, False]
    assert "did not reach" in plain["command grasps nothing"][2]
    assert report["with_stone"]["command grasps"][:2] == [SUCCEEDED, True]


def test_the_width_decides_whether_the_expected_object_is_grasped(report):
    stone = report["with_stone"]
    assert stone["fits"][:3] == [SUCCEEDED, True, ""]
    assert stone["fits"][3] == pytest.approx(0.03, abs=1e-3)
    for name in ("too wide", "too narrow"):
        state, success, text, _ = stone[name]
        assert (state, success) == (SUCCEEDED, False), name
        assert "another one than expected" in text


def test_a_blocked_move_ends_at_once_and_reports_the_width(report):
    state, success, text, seconds, width = report["with_stone"]["obstacle"]
    assert (state, success) == (SUCCEEDED, False)
    assert "something is in their way" in text and "instead of 0.0 mm" in text
    # 50 mm at 50 mm/s, and the time to detect the end.
    assert 0.9 < seconds < 2.5
    assert width == pytest.approx(0.03, abs=2e-3)


def test_a_lost_object_shows_in_the_width(report):
    assert report["with_stone"]["hold"][:2] == [SUCCEEDED, True]
    assert report["with_stone"]["slipped"]


@pytest.mark.parametrize("first, second", PAIRS)
def test_a_new_goal_or_stop_ends_the_running_action(report, first, second):
    state, success, text, seconds, moving, new = report["interrupted"][f"{first},{second}"]
    assert moving
    assert state == (ABORTED if second == "stop" else PREEMPTED), text
    assert not success
    assert "ended this one" in text
    assert seconds < 1.0
    assert new == {"stop": SUCCEEDED, "cancel": None}.get(second, ABORTED)


def test_interruptions_take_less_than_100_ms(report):
    latencies = [outcome[3] for outcome in report["interrupted"].values()]
    assert len(latencies) == len(PAIRS)
    # The median: other processes may use both cores.
    assert statistics.median(latencies) < 0.1


def test_a_stopped_grasp_stays_where_it_is(report):
    stopped = report["stopped_on_the_way"]
    assert stopped["stop"][:2] == [SUCCEEDED, True]
    assert stopped["grasp"][0] == ABORTED
    assert 0.03 < stopped["begin"] < 0.061
    assert stopped["end"] == pytest.approx(stopped["begin"], abs=5e-4)


def test_the_last_goal_of_a_stream_is_carried_out(report):
    stream = report["stream"]
    assert set(stream["states"][:-1]) <= {PREEMPTED, RECALLED, SUCCEEDED}
    assert stream["states"].count(SUCCEEDED) < len(stream["states"]) // 2
    assert stream["states"][-1] == SUCCEEDED
    assert stream["reached"]


def test_joint_states_keep_their_rate_during_actions(report):
    gaps = report["stream"]["gaps"]
    # The median, and an upper bound: other processes may use both cores.
    assert statistics.median(gaps) == pytest.approx(1 / 30, rel=0.05)
    assert max(gaps) < 0.5


@pytest.mark.parametrize("goal", ["move nan", "move below", "move beyond", "grasp nan", "grasp beyond"])
def test_impossible_widths_are_refused(report, goal):
    state, success, text = report["nonsense"][goal]
    assert (state, success) == (ABORTED, False)
    assert "it must lie between 0 and 0.08 m" in text


@pytest.mark.parametrize(
    "goal, sentence",
    [
        ("move speed nan", "Only positive speeds"),
        ("move speed below", "Only positive speeds"),
        ("move speed zero", "Only positive speeds"),
        ("grasp speed", "Only positive speeds"),
        ("grasp force nan", "The force must be"),
        ("grasp force below", "The force must be"),
        ("grasp epsilon", "The epsilons must be"),
        ("command nan", "it must lie between"),
        ("command below", "it must lie between"),
        ("command beyond", "it must lie between"),
        ("command effort", "max_effort must be"),
    ],
)
def test_other_invalid_goals_are_refused(report, goal, sentence):
    state, success, text = report["nonsense"][goal]
    assert (state, success) == (ABORTED, False)
    assert sentence in text


def test_refused_goals_move_nothing(report):
    assert report["nonsense"]["width"] == pytest.approx(0.08, abs=2e-3)


def test_a_lost_hand_is_reported_and_reconnected(report):
    death = report["death"]
    assert death["running"][0] == ABORTED and "libfranka" in death["running"][2]
    assert death["meanwhile"][0] == ABORTED and death["meanwhile"][2]
    assert death["again"]
    assert death["silent"]  # no old widths with new time stamps
    assert death["move"] == [SUCCEEDED, True, "", True]


@pytest.mark.parametrize(
    "case, sentence",
    [
        ("no address", "/robot_ip is missing"),
        ("one name", "must hold two names"),
        ("no rate", "publish_rate must be a number not below 0.001"),
        ("no map", "default_grasp_epsilon must be a map"),
        ("no such host", "no gripper at no.such.host.invalid"),
        ("no gripper", "no gripper at 127.0.31.9"),
    ],
)
def test_a_node_that_cannot_start_reports_why_and_exits(report, case, sentence):
    status, text = report["complaints"][case]
    assert status == 255
    assert sentence in text
    assert "Traceback" not in text
