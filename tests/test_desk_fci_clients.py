# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of the FCI beside Desk: its actions end their motions, its clients do not disturb them."""

import json
import subprocess
import sys
import threading
import time
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
from desk_session import PASSWORD, USER, Desk, desk_of, robot_with_desk
from desk_wire import Player
from fci_session import client_process, go_first, simulated
from genuine_clients import client_python
from lock_step import begin_motion, moved
from pyfranka.franka_sim import FrankaSim, SimRobot
from stalls import TRIES

PROMPT = 0.5  # [s] in which a client gets its exception
LOAD = Path(__file__).resolve().parent / "support" / "desk_load.py"
RATE = 1000.0  # requests a second


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


def is_ready(report: dict) -> bool:
    return report["fci"] and not any(report["brakes"])


def wait_until(condition, limit: float = 30.0) -> None:
    deadline = time.monotonic() + limit
    while not condition():
        assert time.monotonic() < deadline, f"Not within {limit:g} s."
        time.sleep(0.02)


@contextmanager
def beside(act):
    """Runs it beside the block."""
    thread = threading.Thread(target=act)
    thread.start()
    try:
        yield
    finally:
        thread.join()


@pytest.mark.parametrize("library, profile, end", CASES)
def test_desk_ends_a_motion_at_once(library, profile, end, tmp_path):
    python = client_python(library)
    with (
        robot_with_desk(tmp_path, profile, options=["boot-time=2"]) as desk,
        client_process(library, python) as client,
    ):
        robot, (ending, again) = ROBOTS[desk.robot.kind], ENDS[end]
        operator = operator_of(desk)
        operator.play(robot.start)
        desk.wait(is_ready)
        assert client.run_task("connect", address=desk.robot.address)["outcome"] == "ok"
        begin_motion(client, seconds=60.0, amplitude=0.2)
        began = time.monotonic()
        with beside(lambda: operator.play([ending(robot)])):
            outcome = client.result(timeout=20.0)["outcome"]
            passed = time.monotonic() - began
        print(f"{library}, {end}: after {passed:.3f} s: {outcome}")
        assert "Exception" in outcome or "Error" in outcome
        assert passed < PROMPT
        refused = client.run_task("connect", address=desk.robot.address)["outcome"]
        assert refused != "ok"
        if end == "reboot":
            desk.wait(lambda report: not report["power"])
            desk.wait_for_page()
            operator = operator_of(desk)
        operator.play(again(robot))
        desk.wait(is_ready)
        assert client.run_task("connect", address=desk.robot.address)["outcome"] == "ok"
        assert client.run_task("move", seconds=0.3)["outcome"] == "ok"


# ---- load -------------------------------------------------------------------------------------------------


@contextmanager
def load_of(desk, seconds: float, rate: float = RATE):
    """Requests from two addresses, in a process of their own; yields a function that returns the figures."""
    sources = "127.0.0.1,127.0.0.2"
    words = [desk.address, str(desk.port), str(rate), str(seconds), sources]
    process = subprocess.Popen([sys.executable, LOAD, *words], stdout=subprocess.PIPE, text=True)
    try:
        yield lambda: json.loads(process.communicate(timeout=seconds + 60.0)[0])
    finally:
        process.kill()
        process.wait()
        process.stdout.close()


def smallest_success_rate(robot, seconds: float) -> dict:
    """A motion with zero torque; the smallest control_command_success_rate of its states, and its cycles."""
    import pyfranka

    connection = robot.connect()
    passed, cycles, rates = 0.0, 0, []

    def callback(state, period):
        nonlocal passed, cycles
        passed += period
        cycles += 1
        if cycles > 100:  # the rate is one of the last hundred commands
            rates.append(state.control_command_success_rate)
        command = pyfranka.Torques([0.0] * 7)
        command.motion_finished = passed >= seconds
        return command

    go_first()
    try:
        connection.control_torques(callback)
    except pyfranka.ControlException as error:
        return {"lost": str(error), "rate": 0.0, "cycles": cycles, "seconds": passed}
    return {"lost": "", "rate": min(rates), "cycles": cycles, "seconds": passed}


def motion_under_load(desk, seconds: float) -> dict:
    """Figures of the motion and of the load."""
    seen: dict = {}
    with load_of(desk, seconds + 1.0) as figures:
        with beside(lambda: seen.update(smallest_success_rate(desk.robot, seconds))):
            pass
        return {**seen, **figures()}


@pytest.mark.parametrize("kind, profile", [("panda", "fer-spoc"), ("fr3", "fr3-v1")])
def test_requests_to_desk_lose_no_command(kind, profile, tmp_path, long_run):
    seconds = 10.0 if long_run else 3.0
    with robot_with_desk(tmp_path, profile, pace="realtime") as desk:
        go_first(desk.robot.server.process.pid)
        operator_of(desk).play(ROBOTS[kind].start)
        desk.wait(is_ready)

        # Beside other tests the machine loses commands without Desk too; requests would do so in each try.
        for _ in range(TRIES):
            seen = motion_under_load(desk, seconds)
            print(seen)
            if seen["rate"] == 1.0:
                break
        assert seen["lost"] == "" and seen["rate"] == 1.0, seen
        assert set(seen["answers"]) <= {"200", "429"}, seen
        assert seen["sent a second"] == pytest.approx(RATE, rel=0.01) and seen["took"] < seconds + 2.0, seen


@pytest.mark.parametrize("kind", ["panda", "fr3"])
def test_lock_step_repeats_bit_for_bit_beside_desk(kind, tmp_path):
    with simulated(kind, "lockstep") as robot, client_process("pyfranka") as client:
        assert client.run_task("connect", address=robot.address)["outcome"] == "ok"
        hashes = [moved(robot, client)]
        with desk_of(robot, tmp_path) as desk, load_of(desk, 60.0, rate=200.0):
            hashes += [moved(robot, client), moved(robot, client)]
        hashes.append(moved(robot, client))
    assert len(set(hashes)) == 1, hashes


# ---- franka_sim --desk ------------------------------------------------------------------------------------


def test_franka_sim_starts_and_ends_its_desk(tmp_path, monkeypatch):
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    monkeypatch.setenv("FRANKA_DESK_PASSWORD", PASSWORD)
    robots = [SimRobot("fr3", base=[0, 0, 0]), SimRobot("panda", base=[1, 1, 0])]
    with FrankaSim(*robots, pace="patient", arguments=["--desk", f"--desk-user={USER}"]) as sim:
        wait_until(lambda: sim.log().count("https://") == len(sim.robots))
        for robot in sim.robots:
            robot.remote.send("timing brakes 0.7")
            desk = Desk(robot, f"{robot.address}:443", tmp_path)
            assert desk.report()["brakes"] == [True] * 7
            operator_of(desk).play(ROBOTS[robot.kind].start)
            desk.wait(is_ready)
    with pytest.raises(ConnectionRefusedError):
        operator_of(desk).play([login()])
