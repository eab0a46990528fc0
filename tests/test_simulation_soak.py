# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A minute, in the long form an hour, of simulated work of an arm under ros_control, as fast as possible."""

import json
from pathlib import Path

import pytest
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent
ROUNDS, ROUNDS_IN_SHORT = 1000, 20  # of 3.6 s
SETTLING = 10  # rounds: all connections are open once the first reflex has been recovered from

pytestmark = pytest.mark.timeout(1800)  # the long form takes 5 to 15 minutes


@pytest.fixture(scope="module")
def report(tmp_path_factory, long_run):
    log = tmp_path_factory.mktemp("soak") / "launch.log"
    with Session(str(HERE / "data" / "simulation_soak.launch"), log=log) as session:
        session.wait_for_master()
        rounds = str(ROUNDS if long_run else ROUNDS_IN_SHORT)
        client = ["/usr/bin/python3", str(HERE / "simulation_soak_client.py"), rounds]
        result = session.run(*client, check=False, timeout=1700 if long_run else 300)
        print(result.stdout, result.stderr, session.tail(60), sep="\n")
        assert result.returncode == 0, f"{result.stderr}\n{session.tail(60)}"
        session.check()
    return {"rounds": int(rounds), **json.loads(result.stdout.strip().splitlines()[-1])}


def test_all_rounds_were_completed(report):
    rounds = report["rounds"]
    assert report["goals"] == rounds and report["switches"] >= rounds
    assert report["resets"] == rounds / 5 * 2 and report["reflexes"] == rounds / 10
    assert report["simulated"] >= 3.6 * rounds


def test_nothing_drifts(report):
    assert report["hashes"] == 1, "Worlds that were reset differ."
    assert report["offset"] == 0, "[ms] between the clock and the ticks."


def test_memory_and_descriptors_stay_constant(report):
    memory, files = zip(*report["footprints"][SETTLING:])
    assert memory[-1] - memory[0] < 0.5, f"{memory[0]:.1f} MB have grown to {memory[-1]:.1f} MB."
    assert max(files) == min(files)


def test_only_reflexes_are_logged_as_errors(report):
    assert all("reflex" in line for line in report["log"]), report["log"]
