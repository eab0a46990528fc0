# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What the end of a Session ends: all processes of its master, and no others."""

import os
import signal
import subprocess
from pathlib import Path

import franka_sim_mujoco.session
import pytest
from waiting import wait_for

ANOTHER_MASTER = ["env", "ROS_MASTER_URI=http://localhost:1"]


@pytest.mark.parametrize(
    "prefix, network, ends",
    [([], "", True), (ANOTHER_MASTER, "", False), ([], "net:[1]", False)],
    ids=["of-the-master", "of-another-master", "of-another-network"],
)
def test_a_session_ends_the_processes_of_its_master(prefix, network, ends, tmp_path, monkeypatch):
    """Another network needs rights that a test may not have, so the system's answer is replaced."""
    readlink = os.readlink
    with franka_sim_mujoco.session.Session("--help", log=tmp_path / "launch.log") as session:
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
