# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of the FCI beside Desk: its actions end their motions, its clients do not disturb them."""

import subprocess
import sys
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

import pytest
from desk_sequences import (
    ACTIVATE,
    CLOSE,
    LOCK,
    OPEN,
    RELEASE,
    UNLOCK,
    WITH_TOKEN,
    Sequence,
    Step,
    by_requests,
    login,
    request_control,
)
from desk_session import PASSWORD, USER, Desk, beside, desk_of, is_ready, robot_with_desk
from desk_wire import Player
from fci_session import client_process, simulated
from genuine_clients import client_python
from lock_step import begin_motion, moved
from pyfranka.franka_sim import FrankaSim, SimRobot
from waiting import wait_for

LOAD = Path(__file__).resolve().parent / "support" / "desk_load.py"
LIMIT = 60.0  # [s] of each wait


def with_header(path: str) -> Step:
    return Step("POST", path, with_token=True)


@dataclass(frozen=True)
class Robot:
    """Paths of one type of robot."""

    unlock: Step
    lock: Step

    @property
    def start(self) -> list[Step]:
        return [login(), request_control(), self.unlock, ACTIVATE]


ROBOTS = {
    "panda": Robot(with_header(OPEN), Step("POST", CLOSE)),
    "fr3": Robot(with_header(UNLOCK), Step("POST", LOCK)),
}
# What ends a motion, and what makes the robot ready again.
ENDS = {
    "lock": (lambda robot: robot.lock, lambda robot: [robot.unlock, ACTIVATE]),
    "deactivate": (
        lambda robot: Step("DELETE", "/admin/api/control-token/fci", *WITH_TOKEN),
        lambda robot: [ACTIVATE],
    ),
    "release": (lambda robot: RELEASE, lambda robot: [request_control(), ACTIVATE]),
    "programming": (
        lambda robot: with_header("/desk/api/operating-mode/programming"),
        lambda robot: [with_header("/desk/api/operating-mode/execution"), ACTIVATE],
    ),
    "reboot": (lambda robot: Step("POST", "/admin/api/reboot"), lambda robot: robot.start),
}
CASES = [
    (library, profile, end)
    for library, profile in (("pylibfranka", "fr3-early"), ("panda", "fer-spoc"))
    for end in ENDS
    if profile != "fer-spoc" or end != "programming"  # which Pandas do not have
]


def operator_of(desk) -> Player:
    return Player(Sequence("operator", (), by_requests, [], []), desk)


class Scene:
    """A robot that is ready, its Desk with an operator, and a client."""

    def __init__(self, desk, client):
        self.desk, self.client, self.robot = desk, client, ROBOTS[desk.robot.kind]
        self.begin()

    def begin(self):
        self.operator = operator_of(self.desk)
        self.operator.play(self.robot.start)
        self.desk.wait(is_ready, LIMIT)

    def connect(self) -> str:
        return self.client.run_task("connect", address=self.desk.robot.address)["outcome"]


@pytest.fixture(scope="module")
def scene(request, tmp_path_factory):
    library, profile = request.param
    folder, python = tmp_path_factory.mktemp(profile), client_python(library)
    with (
        robot_with_desk(folder, profile, options=["boot-time=2"]) as desk,
        client_process(library, python) as client,
    ):
        yield Scene(desk, client)


@pytest.mark.parametrize("scene, end", [(case[:2], case[2]) for case in CASES], indirect=["scene"])
def test_desk_ends_a_motion(scene, end):
    ending, again = ENDS[end]
    assert scene.connect() == "ok"
    begin_motion(scene.client, seconds=600.0, amplitude=0.2)
    with beside(lambda: scene.operator.play([ending(scene.robot)])):
        outcome = scene.client.result()["outcome"]
    assert "Exception" in outcome or "Error" in outcome
    assert scene.connect() != "ok"
    if end == "reboot":
        # Desk's page is off before the brakes close.
        scene.desk.wait(lambda report: all(report["brakes"]), LIMIT)
        scene.desk.wait_for_page(LIMIT)
        scene.begin()
    else:
        scene.operator.play(again(scene.robot))
        scene.desk.wait(is_ready, LIMIT)
    assert scene.connect() == "ok"
    assert scene.client.run_task("move", seconds=0.3)["outcome"] == "ok"


# ---- load -------------------------------------------------------------------------------------------------


@contextmanager
def load_of(desk, rate: float = 200.0):
    """So many requests a second from two addresses, from before the block until its end."""
    words = [desk.address, str(desk.port), str(rate), "100000", "127.0.0.1,127.0.0.2"]
    process = subprocess.Popen([sys.executable, LOAD, *words], stdout=subprocess.PIPE, text=True)
    try:
        assert process.stdout.readline() == "begun\n"
        yield
        assert process.poll() is None, "The requests have ended."
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


@pytest.mark.parametrize("kind", ["panda", "fr3"])
def test_lock_step_repeats_bit_for_bit_beside_desk(kind, tmp_path):
    with simulated(kind, "lockstep") as robot, client_process("pyfranka") as client:
        assert client.run_task("connect", address=robot.address)["outcome"] == "ok"
        hashes = [moved(robot, client)]
        with desk_of(robot, tmp_path) as desk, load_of(desk):
            hashes += [moved(robot, client), moved(robot, client)]
        hashes.append(moved(robot, client))
    assert len(set(hashes)) == 1, hashes


# ---- franka_sim --desk ------------------------------------------------------------------------------------


def test_franka_sim_starts_and_ends_its_desk(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("FRANKA_DESK_PASSWORD", PASSWORD)
    robots = [SimRobot("fr3", base=[0, 0, 0]), SimRobot("panda", base=[1, 1, 0])]
    with FrankaSim(*robots, pace="patient", arguments=["--desk", f"--desk-user={USER}"]) as sim:
        wait_for(lambda: sim.log().count("https://") == len(sim.robots), "The page of each robot")
        for robot in sim.robots:
            robot.remote.send("timing brakes 0.7")
            desk = Desk(robot, f"{robot.address}:443", tmp_path)
            assert desk.report()["brakes"] == [True] * 7
            operator_of(desk).play(ROBOTS[robot.kind].start)
            desk.wait(is_ready, LIMIT)
    with pytest.raises(ConnectionRefusedError):
        operator_of(desk).play([login()])
