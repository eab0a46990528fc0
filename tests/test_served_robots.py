# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Robots of a ROS world that are served over the FCI, each with its address, beside one that is not."""

import json
from pathlib import Path

import pytest
from fci_wire import COMMUNICATION, IDLE, LAYOUTS, REFLEX
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

VERSIONS = {"panda": 5, "fr3": 10}
READY = [0, -0.785398163, 0, -2.35619449, 0, 1.57079632679, 0.785398163397]
USER_STOPPED = 5
OK = [True, ""]


@pytest.fixture(scope="module")
def report(tmp_path_factory):
    log = tmp_path_factory.mktemp("served") / "launch.log"
    with Session(str(HERE / "data" / "served_robots.launch"), log=log) as session:
        session.wait_for_master()
        client = session.run(
            "/usr/bin/python3", str(HERE / "served_robots_client.py"), check=False, timeout=200
        )
        assert client.returncode == 0, f"{client}\n{session.tail(60)}"
        session.check()
        print(session.tail(60))
        return json.loads(client.stdout.strip().splitlines()[-1])


@pytest.fixture(params=["panda", "fr3"])
def seen(request, report):
    return {"version": VERSIONS[request.param], **report[request.param]}


def test_a_client_finds_its_robot(seen):
    assert seen["idle"] == "Idle, client of protocol 0, errors none"
    assert seen["connect"] == [0, seen["version"]]
    assert seen["protocol"] == seen["version"]


def test_the_robot_moves_in_simulated_time(seen):
    assert (seen["move"]["status"], seen["move"]["mode"]) == (0, IDLE)
    assert seen["move"]["moved"] == pytest.approx(0.1, abs=1e-3)
    assert seen["move"]["clock"] >= 1.0
    assert seen["ros"] < 1e-6  # read one after the other, while the arm still settles


def test_the_user_stop_ends_its_motion(seen):
    stop = seen["stop"]
    assert stop["pressed"] == OK and stop["released"] == OK
    assert stop["mode"] == USER_STOPPED and stop["shown"] == "User stopped"
    assert stop["status"] not in (0, LAYOUTS[seen["version"]].reflex), "That is no abort by the user stop."
    assert stop["again"] == 0


def test_twenty_lost_commands_end_the_motion(seen):
    few, many = seen["lose 10"], seen["lose 20"]
    assert (few["status"], few["mode"]) == (0, IDLE)
    assert few["rate"] == pytest.approx(1.0, abs=1e-6), "They are more than 100 cycles ago."
    assert many["mode"] == REFLEX and many["reasons"] == [COMMUNICATION]
    assert many["errors"] == ["communication_constraints_violation"]
    assert many["status"] == LAYOUTS[seen["version"]].reflex
    assert many["recovered"] == IDLE


def test_setters_work_at_rest_and_report_refusals(seen):
    outcome = seen["configured"]
    assert outcome["load"] == outcome["no_load"] == outcome["delay"] == OK
    assert "load was refused" in outcome["bad_load"][1]
    assert "The probability" in outcome["bad_loss"][1]
    assert "from 0 to 20" in outcome["bad_delay"][1]
    assert "load was refused" in outcome["load_in_motion"][1]
    assert not outcome["reset_in_motion"][0] and "over the FCI" in outcome["reset_in_motion"][1]
    assert outcome["ended"] == 0
    assert outcome["guiding"] == "Guiding" and outcome["brakes"] == "Other"
    assert outcome["after guiding"] == outcome["after brakes"] == "Idle"


def test_a_paused_world_pauses_its_motions(seen):
    outcome = seen["halted"]
    assert (outcome["status"], outcome["mode"]) == (0, IDLE), outcome
    assert outcome["repeated"] > 20 and outcome["longest"] < 0.9, "Clients would think the robot gone."


def test_a_reset_restores_the_start_position(seen):
    assert seen["reset"]
    assert seen["after_reset"] == pytest.approx(READY, abs=1e-3)


def test_a_robot_without_an_address_is_controlled_in_the_simulation(report):
    assert report["inside"] == 7


def test_each_address_belongs_to_one_robot(report):
    refusals = report["refusals"]
    assert not refusals["taken"][0] and "Another simulated robot runs there" in refusals["taken"][1]
    assert refusals["spawned"] == OK and refusals["connect"] == [0, 5]
    assert refusals["deleted"] and refusals["ended"]
