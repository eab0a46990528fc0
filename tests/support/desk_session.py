# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A simulated robot with its Desk, for tests with clients of both."""

import json
import os
import shutil
import ssl
import subprocess
import sys
import urllib.error
import urllib.request
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, suppress
from pathlib import Path

from fci_session import simulated
from lines import Lines
from waiting import wait_for

USER, PASSWORD = "operator", "a long random word"
PORT = 443
TO_START = 60.0  # [s] on a busy machine
LIMIT = 60.0  # [s] to wait for a state of the robot
PAUSE = 0.02  # [s] between two looks


def is_ready(report: dict) -> bool:
    return report["fci"] and not any(report["brakes"])


def is_locked(report: dict) -> bool:
    return not report["fci"] and all(report["brakes"])


@contextmanager
def beside(act):
    """Runs a function beside the block, and waits for its end. Raises what the function has raised."""
    with ThreadPoolExecutor(1) as executor:
        result = executor.submit(act)
        yield
    result.result()


class Desk:
    """One robot's Desk: `robot` is the ServedRobot, `host` the name that clients use."""

    def __init__(self, robot, place: str, folder: Path):
        self.robot, self.place = robot, place
        address, _, port = place.rpartition(":")
        self.address, self.port = address, int(port)
        self.host = address if self.port == PORT else place
        self.user, self.password = USER, PASSWORD
        self.certificate = folder / "desk.pem"
        self.certificate.write_text(ssl.get_server_certificate((address, self.port)))

    def report(self) -> dict:
        """What the robot says of itself now."""
        return json.loads(self.robot.remote.send("report"))

    def wait(self, condition, limit: float = LIMIT) -> dict:
        """The first report that fulfils the condition, after Desk has seen it too."""
        report = wait_for(
            lambda: condition(report := self.report()) and report,
            lambda: f"The state after {self.report()}",
            limit,
            PAUSE,
        )
        self._wait_for_desk(limit)
        return report

    def get(self, path: str):
        """A page of Desk that needs no login, as JSON."""
        context = ssl._create_unverified_context()  # noqa: S323 - the certificate has its own test
        place = f"https://{self.address}:{self.port}{path}"
        with urllib.request.urlopen(place, timeout=LIMIT, context=context) as answer:
            return json.loads(answer.read())

    def wait_for_page(self, limit: float = LIMIT) -> None:
        """Waits until Desk answers again."""

        def has_started() -> bool:
            with suppress(urllib.error.URLError, ConnectionError):
                return self.get("/admin/api/startup-phase") == {"tag": "Started"}
            return False

        wait_for(has_started, "Desk's answer", limit, PAUSE)

    def _wait_for_desk(self, limit: float) -> None:
        if not self.robot.kind == "fr3":
            return  # no page without a login says how old Desk's report is
        with suppress(urllib.error.URLError, ConnectionError):  # the robot is off
            first = self._number()
            wait_for(lambda: self._number() >= first + 2, "Desk's next report", limit, PAUSE)

    def _number(self) -> int:
        """Of Desk's newest report."""
        return self.get("/admin/api/safety/status")["sequenceNumber"]

    def send(self, line: str) -> str:
        """Sends a line to the robot's control interface."""
        return self.robot.remote.send(line)

    @contextmanager
    def held(self, name: str):
        """An input or a button of the Pilot that is pressed until the end of the block."""
        self.send(f"{name} on")
        try:
            yield
        finally:
            self.send(f"{name} off")


@contextmanager
def program(name: str, words: list[str], environment: dict[str, str]):
    """A program with its lines; its output is shown if the block fails."""
    process = subprocess.Popen(
        [shutil.which(name) or sys.exit(f"{name} is not on PATH"), *words],
        env={**os.environ, **environment},
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
    )
    written: list[str] = []
    lines = Lines(process.stdout)

    def next_line(timeout: float) -> str | None:
        line = lines.next(timeout)
        if line is not None:
            written.append(line)
        return line

    try:
        yield next_line
    except BaseException:
        while next_line(0.1) is not None:  # what it has written already
            pass
        print(f"{name} has written:", *written, sep="\n")
        raise
    finally:
        process.terminate()
        try:
            process.wait(LIMIT)
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()


@contextmanager
def desk_of(robot, folder: Path, profile: str = "", options=(), port: int = PORT):
    """The Desk of a robot that runs, at its address."""
    words = [f"--robot={robot.address}", f"--listen={robot.address}:{port}", f"--user={USER}"]
    words += [f"--profile={profile}"] if profile else []
    words += [f"--option={option}" for option in options]
    environment = {"FRANKA_DESK_PASSWORD": PASSWORD, "XDG_CACHE_HOME": str(folder)}
    with program("franka_desk", words, environment) as next_line:
        yield Desk(robot, wait_for_place(next_line), folder)


def wait_for_place(next_line) -> str:
    """ADDRESS:PORT of the first Desk that the program reports."""
    while (line := next_line(TO_START)) is not None:
        if "https://" in line:
            return line.rpartition("https://")[2].strip("/")
    raise AssertionError("franka_desk has not printed its address.")


@contextmanager
def robot_with_desk(folder: Path, profile: str, *, options=(), port: int = PORT):
    """A locked robot of the profile's type, and its Desk."""
    kind = "fr3" if profile.startswith("fr3") else "panda"
    with simulated(kind, "patient", "--start", "locked") as robot:
        robot.remote.send("timing brakes 0.4")
        with desk_of(robot, folder, profile, options, port) as desk:
            yield desk


def move(robot, seconds: float = 0.3, amplitude: float = 0.01) -> None:
    """A motion of this project's own client there and back. Raises pyfranka's exceptions."""
    import pyfranka

    connection = robot.connect()
    with suppress(pyfranka.CommandException):  # nothing to recover from
        connection.automatic_error_recovery()
    passed, first = 0.0, None

    def callback(state, period):
        nonlocal passed, first
        passed += period
        first = first or list(state.q_d)
        x = min(passed / seconds, 1.0)
        q = list(first)
        q[3] += amplitude * (16.0 * x * x * (1.0 - x) * (1.0 - x)) ** 2
        command = pyfranka.JointPositions(q)
        command.motion_finished = passed >= seconds
        return command

    connection.control_joint_positions(callback)
