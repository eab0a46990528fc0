# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Each service, each topic and each report of franka_control_node."""

import json
import xmlrpc.client
from pathlib import Path

import pytest
from fci_session import go_first, simulated
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

SUCCEEDED, IDLE, MOVE = 3, 1, 2
OK, ERROR = 0, 2  # levels of diagnostics
CONTROLLER = "position_joint_trajectory_controller"
AT_ONCE = 5.0  # [s] for an answer, on a busy machine


@pytest.fixture(scope="module", params=["panda", "fr3"])
def robot(request):
    return request.param


def all_go_first(pid: int) -> None:
    """Robot and node keep real time even on a busy machine."""
    for thread in Path(f"/proc/{pid}/task").iterdir():
        go_first(int(thread.name))


def pid_of(session, node: str) -> int:
    master = xmlrpc.client.ServerProxy(session.environment["ROS_MASTER_URI"])
    return xmlrpc.client.ServerProxy(master.lookupNode("/test", node)[2]).getPid("/test")[2]


@pytest.fixture(scope="module")
def report(robot, tmp_path_factory):
    log = tmp_path_factory.mktemp("control") / "launch.log"
    launch = ["franka_control", "franka_control.launch", f"robot:={robot}"]
    launch += ["load_gripper:=false", "realtime_config:=ignore"]
    # Patient, not in lock-step: its time is at most as fast as the clock, so that topics keep up with it.
    with (
        simulated(robot, "patient") as simulation,
        Session(*launch, f"robot_ip:={simulation.address}", log=log) as session,
    ):
        all_go_first(simulation.server.process.pid)
        session.wait_for_master()
        load = ["rosrun", "controller_manager", "controller_manager", "load", CONTROLLER]
        loaded = session.run(*load, check=False, timeout=60)
        assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
        all_go_first(pid_of(session, "/franka_control"))
        client = ["/usr/bin/python3", str(HERE / "control_node_client.py"), robot, simulation.address]
        result = session.run(*client, check=False, timeout=400)
        print(result.stdout, result.stderr, session.tail(60), sep="\n")
        assert result.returncode == 0, result.stderr
        session.check()
        return json.loads(result.stdout.strip().splitlines()[-1])


def test_setters_take_effect(report):
    idle = report["idle"]
    for name, (success, error, seen) in idle["good"].items():
        assert success and not error and seen, (name, error)
    assert idle["m_total"] == pytest.approx(0.0, abs=1e-6)


def test_impossible_values_are_refused(report):
    assert len(report["idle"]["bad"]) == 22
    for name, what, success, error, seconds in report["idle"]["bad"]:
        assert not success, (name, what)
        assert "invalid argument!" in error and error.endswith(("!", ".")), (name, what, error)
        assert seconds < AT_ONCE
    assert report["idle"]["still"] < 1e-6


def check_topics(robot, topics):
    """All topics of a cycle match its state; floats of an FR3's states have seven digits."""
    assert topics["cycles"] >= 20
    for name in ("F_ext", "joint_states", "joint_states_desired"):
        assert topics["differences"][name] == 0.0
    assert topics["differences"]["tf"] < 1e-6
    assert topics["differences"]["franka_states"] < 2e-6  # O_T_EE against the chain of the description
    assert topics["wrench_frame"] == f"{robot}_K"
    assert topics["names"] == [f"{robot}_joint{i}" for i in range(1, 8)]
    chain = [f"{robot}_{name}" for name in ("link8", "NE", "EE", "K")]
    assert topics["frames"] == [list(pair) for pair in zip(chain, chain[1:])]


def test_topics_of_a_resting_robot_agree(robot, report):
    check_topics(robot, report["idle"]["topics"])
    assert report["idle"]["topics"]["rate"] == pytest.approx(30.0, rel=0.05)


def test_topics_of_a_moving_robot_agree(robot, report):
    check_topics(robot, report["soft_joints"]["topics"])


def test_published_states_match_the_robots_states(report):
    assert report["idle"]["second_source"] < 1e-5  # the robot's own report, besides its client's


def test_transforms_connect_the_base_with_the_end_effector(report):
    assert report["idle"]["tree"] < 1e-5


def test_joint_impedance_takes_effect(report):
    soft = report["soft_joints"]
    assert soft["set"] == [True, True] and soft["started"]
    assert soft["spring"] < 0.02  # K (q - q_d) against J^T F
    assert soft["external"] < 0.02  # the robot's estimate


def test_thresholds_of_forces_take_effect(report):
    soft = report["soft_joints"]
    assert soft["contacts"] == [True, False, MOVE]
    assert not soft["contact_before"]


def test_cartesian_impedance_takes_effect(report):
    soft = report["soft_hand"]
    assert soft["set"] == [True, True] and soft["started"] and soft["stopped"]
    x, y, z = soft["gives"]  # the hand's displacement over F / K
    assert z == pytest.approx(1.0, abs=0.01)
    assert abs(x) < 0.01 and abs(y) < 0.01


def test_all_thresholds_take_effect(report):
    assert report["soft_hand"]["contacts"] == [False, True]


def test_a_moving_robot_refuses_each_setter_at_once(report):
    refused = report["soft_joints"]["refused"]
    assert len(refused) == 9
    sentences = {
        "connect": "Already connected to robot. Cannot connect twice.",
        "disconnect": "Controller is active. Cannot disconnect while a controller is running.",
    }
    for name, (success, error, seconds) in refused.items():
        assert not success, name
        assert sentences.get(name, "Stop that controller") in error
        assert seconds < AT_ONCE, name
    assert report["soft_joints"]["goes_on"] == MOVE and report["soft_joints"]["stopped"]


def test_a_reflex_is_published_and_logged(report):
    reflex = report["reflex"]
    assert reflex["started"] and reflex["reflex"] and reflex["flagged"] and reflex["has_error"]
    assert "cartesian_reflex" in reflex["abort"].splitlines()[0]
    log = reflex["log"]
    assert log["rows"] == log["announced"] > 1
    assert log["rising"] and log["before_the_state"]
    assert log["apart"] < 0.01  # the last row is the arm's position at the start of braking [rad]
    assert log["echo"] < 1e-3
    assert log["columns"] == 2 + 6 * 7 + 7 + 7 + 16 + 6 + 7
    assert reflex["recovered"] == [SUCCEEDED, ""] and reflex["error_gone"]


def test_diagnostics_report_the_state(robot, report):
    for phase, mode in (("idle", "Idle"), ("soft_joints", "Move")):
        level, hardware, values = report[phase]["diagnosis"]
        assert (level, hardware, values["Mode"]) == (OK, robot, mode)
    _, _, values = report["soft_joints"]["response"]
    longest = float(values["From a state to its command, longest [ms]"])
    assert 0.0 < float(values["From a state to its command, mean [ms]"]) <= longest
    assert float(values["Latest state behind the promptest [ms]"]) > 0.0
    level, _, values = report["reflex"]["diagnosis"]
    assert level == ERROR and values["Mode"] == "Reflex"
    assert "cartesian_reflex" in values["Current errors"]
    assert report["connection"]["diagnosis"][0] == ERROR
    assert report["connection"]["diagnosis_again"][0] == OK
    level, _, values = report["idle"]["loop"]
    assert level == OK
    assert int(values["Cycles since the last report"]) > 0
    longest = float(values["Longest time of the controllers [ms]"])
    assert 0.0 < float(values["Mean time of the controllers [ms]"]) <= longest <= 1.0


def test_robot_services_exist_only_while_connected(report):
    connection = report["connection"]
    assert connection["offered"] == connection["offered_again"] == 8
    assert connection["disconnect"][:2] == [True, ""]
    assert connection["withdrawn"] == []
    assert connection["disconnect_again"][:2] == [True, ""]
    assert connection["connect"][:2] == [True, ""] and connection["set"]
