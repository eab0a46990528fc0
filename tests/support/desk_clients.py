# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Genuine clients of Desk, from PyPI, beside a robot with its Desk, and how each of them begins."""

from contextlib import contextmanager
from pathlib import Path

import pytest
from client_session import ClientError, client_session
from desk_session import PASSWORD, USER, robot_with_desk
from genuine_clients import client_python

LOGIN = f"{USER!r}, {PASSWORD!r}"
PANDA = f"""
    from panda_py import Desk, libfranka
    desk = Desk(HOST, {LOGIN})
"""


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


@contextmanager
def desk_and_client(folder: Path, name: str, profile: str, **settings):
    """A robot with its Desk, and one genuine client that knows `HOST` and trusts the certificate of Desk.
    settings: of robot_with_desk."""
    python = client_python(name)  # before the robot
    with robot_with_desk(folder, profile, **settings) as desk:
        with client_session(python, folder / "client", SSL_CERT_FILE=str(desk.certificate)) as client:
            client.run(f"HOST = {desk.host!r}")
            yield desk, client


def fails(client, statement: str, kind: str) -> str:
    """The text of the client's exception."""
    with pytest.raises(ClientError) as caught:
        client.run(statement)
    assert caught.value.kind == kind, caught.value
    return caught.value.text
