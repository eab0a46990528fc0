# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""franka_combined_control_node survives the loss of one robot: reports, the other arm, reconnection."""

import json
from contextlib import ExitStack
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session
from pyfranka.franka_sim import FrankaSim, SimRobot
from test_combined import arguments

HERE = Path(__file__).resolve().parent

SUCCEEDED, ABORTED, IDLE = 3, 4, 1
OK, ERROR = 0, 2  # levels of diagnostics
AT_ONCE = 5.0  # [s] for an answer, on a busy machine
CONTROLLER = "effort_joint_trajectory_controller"


@pytest.fixture(scope="module", params=["panda", "fr3"])
def robot(request, long_run):
    if request.param == "fr3" and not long_run:
        pytest.skip("the same with FR3s: ./franka test --long")
    return request.param


@pytest.fixture(scope="module")
def report(robot, tmp_path_factory):
    folder = tmp_path_factory.mktemp("combined_gone")
    arms = {f"{robot}_{i}": f"127.0.7.{14 + i}" for i in (1, 2)}
    launch = ["franka_control", "franka_combined_control.launch", *arguments(robot, arms, folder)]
    # The second arm reconnects automatically.
    ips = next(argument for argument in launch if argument.startswith("robot_ips:="))
    launch[launch.index(ips)] = ips.replace("}", f", {robot}_2/reconnect: true}}")
    launch += ["realtime_config:=ignore", "connect_timeout:=20"]
    with ExitStack() as stack:
        robots = []
        for address in arms.values():
            robots.append(FrankaSim(SimRobot(robot, address=address, hand="none"), pace="patient"))
            stack.callback(robots[-1].kill)  # the client kills them before
        with Session(*launch, log=folder / "launch.log") as session:
            session.wait_for_master()
            session.environment["ROS_NAMESPACE"] = "combined_panda"
            load = ["rosrun", "controller_manager", "controller_manager", "load", CONTROLLER]
            loaded = session.run(*load, check=False, timeout=90)
            assert "Loaded" in loaded.stdout, f"{loaded}\n{session.tail(60)}"
            del session.environment["ROS_NAMESPACE"]
            client = ["/usr/bin/python3", str(HERE / "combined_gone_client.py"), robot]
            processes = [each.process.pid for each in robots]
            client += [f"{arm}={ip}={pid}" for (arm, ip), pid in zip(arms.items(), processes)]
            result = session.run(*client, check=False, timeout=240)
            print(result.stdout, result.stderr, session.tail(80), sep="\n")
            assert result.returncode == 0, f"{result}\n{session.tail(60)}"
            session.check()
            return dict(json.loads(result.stdout.strip().splitlines()[-1]), log=session.log.read_text())


def test_the_diagnostics_report_each_arm(robot, report):
    for name in (f"{robot}_1", f"{robot}_2"):
        level, hardware, values = report["diagnosis"][name]
        assert (level, hardware, values["Mode"]) == (OK, name, "Move")
        assert int(values["Commands since the last report"]) > 0
        mean = float(values["From a state to its command, mean [ms]"])
        assert 0.0 < mean <= float(values["From a state to its command, longest [ms]"])
        assert float(values["Latest state behind the promptest [ms]"]) > 0.0
    assert int(report["diagnosis"]["Control loop"][2]["Cycles since the last report"]) > 0


def test_the_lost_arm_is_named(robot, report):
    lost = report["lost"]
    assert lost["noticed"]
    assert f"{robot}_1: the robot is lost. libfranka: " in report["log"]
    assert "Call the service connect when it is back." in report["log"]
    assert lost["abort"].startswith("libfranka: ")
    assert lost["diagnosis"][:2] == [ERROR, f"{robot}_1"]


def test_the_other_one_keeps_its_state_and_answers(robot, report):
    lost = report["lost"]
    assert lost["other"] == [IDLE, True], "One controller moves both: it waits."
    assert lost["fresh"] and lost["stays"] < 0.005
    assert lost["setter"] == [True, ""] and lost["listed"]
    assert lost["seconds"] < AT_ONCE
    assert lost["offered"] == [["connect", "disconnect", "set_load"], ["connect", "disconnect"]]
    assert lost["diagnosis of the other"][2]["Mode"] == "Idle"


def test_connect_reports_the_result_for_each_arm(robot, report):
    success, message = report["lost"]["connect"]
    assert not success
    assert f"'{robot}_1': libfranka" in message and "refused" in message
    assert f"'{robot}_2' is connected." in message
    status, text = report["lost"]["recovery"]
    assert status == ABORTED and f"{robot}_1: " in text and "connect" in text


def test_the_other_arm_moves_alone(robot, report):
    alone = report["alone"]
    success, message = alone["refused"]
    assert not success and f"A controller commands '{robot}_1'" in message
    assert alone["given_up"] == [True, ""]
    assert alone["error_gone"] and alone["started"] and alone["moves"]
    assert alone["error"] < 0.01
    assert not alone["both"], "One of them is not there."
    assert f"no controller can command '{robot}_1'" in report["log"]


def test_the_lost_arm_reconnects_while_the_other_one_moves(report):
    again = report["again"]
    assert again["connect"] == [True, ""]
    assert again["undisturbed"]
    assert again["both"] and again["move"]
    assert again["error"] < 0.01


def test_an_arm_that_reconnects_automatically_moves_on_command(robot, report):
    own = report["by_itself"]
    assert own["noticed"] and own["back"]
    assert f"{robot}_2: the robot is lost." in report["log"]
    assert "Trying to connect again every second." in report["log"]
    assert own["waits"], "It moved again without being told to."
    assert own["recovery"][0] == SUCCEEDED
    assert own["move"] and own["error"] < 0.01
