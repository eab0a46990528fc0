# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of Desk, from PyPI, a robot with its Desk for them, and how each of them begins."""

import json
import socket
import ssl
from contextlib import contextmanager, suppress
from pathlib import Path

import pytest
from client_session import ClientError, client_session
from desk_server import PASSWORD, USER, DeskServer
from fci_session import simulated
from genuine_clients import client_python
from pyfranka.desk.robot import PORT
from waiting import wait_for

LOGIN = f"{USER!r}, {PASSWORD!r}"


def franky(kind: str) -> str:
    return f"""
    import franky
    desk = franky.{kind}(HOST, {LOGIN})
    desk.open()
"""


FRANKA_DESK = f"""
    import franka_desk
    desk = franka_desk.FrankaDeskClient("https://" + HOST, {LOGIN})
"""
DESKAPI = f"""
    import json
    from deskapi import FrankDeskApi
    desk = FrankDeskApi(HOST, {LOGIN})
    desk.open()
"""


def rcs(name: str) -> str:
    environment = "DefaultFR3HardwareEnv" if name == "rcs_fr3" else "DefaultPandaHardwareEnv"
    return f"""
    from bare_package import bare_package
    bare_package({name!r}, configs={{{environment!r}: None}})
    from {name} import desk as rcs
    desk = rcs.Desk(HOST, {LOGIN})
"""


AIOFRANKA = f"""
    import aiofranka, numpy
    names = dict(username={USER!r}, password={PASSWORD!r})
"""


class RobotWithDesk:
    """`host` is the name that clients use, `robot` the ServedRobot."""

    def __init__(self, robot, server: DeskServer, folder: Path):
        self.robot, self._server = robot, server
        self.host = robot.address if server.site.port == 443 else f"{robot.address}:{server.site.port}"
        self.certificate = folder / "desk.pem"
        self.certificate.write_text(ssl.get_server_certificate((robot.address, server.site.port)))

    def report(self) -> dict:
        """Of the robot."""
        return json.loads(self.robot.remote.send("report"))

    def wait(self, condition) -> None:
        """Waits for a report that fulfills the condition, and until Desk has seen it too."""
        wait_for(lambda: condition(self.report()), lambda: f"The state after {self.report()}")
        self._server.refresh()

    @contextmanager
    def held(self, name: str):
        """An input or a button of the Pilot that is pressed until the end of the block."""
        self.robot.remote.send(f"{name} on")
        try:
            yield
        finally:
            self.robot.remote.send(f"{name} off")


def is_ready(report: dict) -> bool:
    return report["fci"] and not any(report["brakes"])


def is_locked(report: dict) -> bool:
    return not report["fci"] and all(report["brakes"])


@contextmanager
def desk_and_client(folder: Path, name: str, profile: str, port: int = 443):
    """A locked robot of the profile's type with its Desk, and one genuine client that knows `HOST` and trusts
    the certificate of Desk."""
    python = client_python(name)  # before the robot
    kind = "fr3" if profile.startswith("fr3") else "panda"
    with simulated(kind, "patient", start="locked") as robot:
        try:
            socket.create_server((robot.address, port)).close()
        except PermissionError:
            pytest.skip(f"port {port} is for root only, and the tests have no network of their own")
        robot.remote.send("timing brakes 0.4")
        with DeskServer(robot.address, PORT, folder, profile, address=robot.address, port=port) as server:
            desk = RobotWithDesk(robot, server, folder)
            with client_session(python, folder / "client", SSL_CERT_FILE=str(desk.certificate)) as client:
                client.run(f"HOST = {desk.host!r}")
                yield desk, client


def move(robot, seconds: float = 0.3, amplitude: float = 0.01, back: bool = True) -> None:
    """A motion of this project's own client there, and back. Raises pyfranka's exceptions."""
    import pyfranka

    connection = robot.connect()
    with suppress(pyfranka.CommandException):  # nothing to recover from
        connection.automatic_error_recovery()
    passed, first = 0.0, None

    def callback(state, period):
        nonlocal passed, first
        passed += period
        first = first or list(state.q_d)
        x = min(passed / seconds, 1.0) * (1.0 if back else 0.5)
        q = list(first)
        q[3] += amplitude * (16.0 * x * x * (1.0 - x) * (1.0 - x)) ** 2
        command = pyfranka.JointPositions(q)
        command.motion_finished = passed >= seconds
        return command

    connection.control_joint_positions(callback)


def fails(client, statement: str, kind: str) -> str:
    """The text of the client's exception."""
    with pytest.raises(ClientError) as caught:
        client.run(statement)
    assert caught.value.kind == kind, caught.value
    return caught.value.text
