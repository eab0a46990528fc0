# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A Session waits for its launch, and its end ends all processes of its master, and no others."""

import os
import signal
import socket
import subprocess
import threading
from contextlib import suppress
from pathlib import Path
from xmlrpc.server import SimpleXMLRPCServer

import pytest
from franka_sim_mujoco.session import Session, SessionError
from waiting import wait_for

ROSOUT = [["/rosout", ["/rosout"]]]
ANOTHER_MASTER = ["env", "ROS_MASTER_URI=http://localhost:1"]


@pytest.mark.parametrize(
    "prefix, network, ends",
    [([], "", True), (ANOTHER_MASTER, "", False), ([], "net:[1]", False)],
    ids=["of-the-master", "of-another-master", "of-another-network"],
)
def test_a_session_ends_the_processes_of_its_master(prefix, network, ends, tmp_path, monkeypatch):
    """Another network needs rights that a test may not have, so the system's answer is replaced."""
    readlink = os.readlink
    with Session("--help", log=tmp_path / "launch.log") as session:
        other = subprocess.Popen([*prefix, "sleep", "300"], env=session.environment)
        its_network = Path(f"/proc/{other.pid}/ns/net")
        monkeypatch.setattr(os, "readlink", lambda path: network * (path == its_network) or readlink(path))
        wait_for(lambda: other.poll() is not None or sleeps(other), "The process")
        assert other.poll() is None
    # Only a process that the session has left alone dies of this signal.
    other.send_signal(signal.SIGVTALRM)
    assert other.wait(60.0) == -(signal.SIGKILL if ends else signal.SIGVTALRM)


def sleeps(process):
    """Whether the command has become `sleep`, after it has changed its environment."""
    return Path(f"/proc/{process.pid}/comm").read_text().strip() == "sleep"


def test_a_node_that_is_not_rosouts_is_awaited_as_parameters_are_set_before(tmp_path, monkeypatch):
    asked = []

    def state(_caller: str):
        asked.append(len(asked))
        nodes = ROSOUT if len(asked) < 4 else [*ROSOUT, ["/clock", ["/gazebo"]]]
        return [1, "", [nodes if len(asked) > 1 else [], [], []]]

    with SimpleXMLRPCServer(("127.0.0.1", 0), logRequests=False) as master:
        master.register_function(state, "getSystemState")
        threading.Thread(target=master.serve_forever, daemon=True).start()
        session = Session("panda.launch", log=tmp_path / "log", port=master.server_address[1])
        monkeypatch.setattr(session, "running", lambda: True)
        session.wait_for_node(timeout=60)
        master.shutdown()
    assert len(asked) == 4


def test_a_launch_that_ends_before_its_first_node_is_told_with_its_log(tmp_path, monkeypatch):
    """Its master accepts connections and closes them, as one does that ends between two calls."""
    log = tmp_path / "log"
    log.write_text("panda.launch: nothing was spawned")
    alive = [True, True, True]
    with socket.create_server(("127.0.0.1", 0)) as master:
        threading.Thread(target=refuse, args=[master], daemon=True).start()
        session = Session("panda.launch", log=log, port=master.getsockname()[1])
        monkeypatch.setattr(session, "running", lambda: bool(alive and alive.pop()))
        with pytest.raises(SessionError, match="nothing was spawned"):
            session.wait_for_node(timeout=60)


def test_a_master_that_accepts_and_never_answers_does_not_hold_the_session(tmp_path, monkeypatch):
    log = tmp_path / "log"
    log.write_text("something else listens there")
    monkeypatch.setattr("franka_sim_mujoco.session.ANSWER", 0.1)
    with socket.create_server(("127.0.0.1", 0)) as mute:
        session = Session("panda.launch", log=log, port=mute.getsockname()[1])
        monkeypatch.setattr(session, "running", lambda: True)
        with pytest.raises(SessionError, match=r"no node within 0.5 s:\nsomething else listens there"):
            session.wait_for_node(timeout=0.5)


def refuse(server):
    with suppress(OSError):
        while True:
            server.accept()[0].close()
