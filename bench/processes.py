# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Queries of a running launch: whether a controller runs, memory of a process."""

import time
from pathlib import Path

from franka_sim_mujoco.session import Session


def wait_running(session: Session, controller: str, timeout: float = 90.0, namespace: str = "") -> None:
    """Waits until the controller runs, according to `controller_manager/list_controllers`."""
    deadline = time.monotonic() + timeout
    service = f"{namespace}/controller_manager/list_controllers"
    while time.monotonic() < deadline:
        session.check()
        answer = session.run("rosservice", "call", service, check=False).stdout
        blocks = [block for block in answer.split("name: ") if block.strip('" \n').startswith(controller)]
        if any("running" in block for block in blocks):
            return
    raise RuntimeError(f"{controller} did not run within {timeout} s:\n{session.tail()}")


def resident(session: Session, name: bytes) -> float:
    """Resident memory of this session's process of that name [MB]."""
    port = f"ROS_MASTER_URI=http://localhost:{session.port}".encode()
    for status in Path("/proc").glob("[0-9]*/status"):
        try:
            command = (status.parent / "cmdline").read_bytes()
            if name in command and port in (status.parent / "environ").read_bytes():
                line = next(line for line in status.read_text().splitlines() if line.startswith("VmRSS"))
                return float(line.split()[1]) / 1024
        except (OSError, StopIteration):
            continue
    raise RuntimeError(f"the process {name.decode()} was not found")
