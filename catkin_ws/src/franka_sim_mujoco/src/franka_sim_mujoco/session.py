# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Starts a launch file on its own master and ends all its processes."""

import http.client
import os
import random
import signal
import socket
import subprocess
import time
import xmlrpc.client
from collections.abc import Callable
from contextlib import suppress
from pathlib import Path
from typing import Any

ANSWER = 2.0  # s that a master may take


class SessionError(RuntimeError):
    """The launch failed to start or ended by itself; the message holds the end of its log."""


def free_port() -> int:
    """An unused TCP port on loopback.

    Below the system's ephemeral ports (Linux: from 32768 on), or a connection might take it before the
    master does.
    """
    for port in random.sample(range(20000, 32768), 100):
        with socket.socket() as probe, suppress(OSError):
            probe.bind(("127.0.0.1", port))
            return port
    raise SessionError("No port for a ROS master is free: a hundred between 20000 and 32767 are taken.")


class _Transport(xmlrpc.client.Transport):
    """Asks a master that must answer soon: one that accepts and stays mute would hold its caller for ever."""

    def make_connection(self, host: Any) -> http.client.HTTPConnection:
        connection = super().make_connection(host)
        connection.timeout = ANSWER
        return connection


class Session:
    """A roslaunch process group with its own master, as a context manager.

    `environment` holds the variables for commands on this master (ROS_MASTER_URI, ROS_HOSTNAME). Output goes
    to `log`. Leaving the context ends every process that the launch started.
    """

    def __init__(self, *launch: str, log: Path, port: int | None = None):
        self.port = port or free_port()
        self.log = Path(log)
        self.environment = dict(os.environ, ROS_MASTER_URI=f"http://localhost:{self.port}")
        self.environment.setdefault("ROS_HOSTNAME", "localhost")
        # Debian 13's rospy does not flush: what a Python node prints would come when the node ends.
        self.environment.setdefault("PYTHONUNBUFFERED", "1")
        self._command = ["roslaunch", "-p", str(self.port), *launch]
        self._process: subprocess.Popen[bytes] | None = None

    def __enter__(self) -> "Session":
        self.log.parent.mkdir(parents=True, exist_ok=True)
        with open(self.log, "w", encoding="utf-8") as out:
            self._process = subprocess.Popen(
                self._command,
                stdout=out,
                stderr=subprocess.STDOUT,
                env=self.environment,
                stdin=subprocess.DEVNULL,
                start_new_session=True,
            )
        return self

    def __exit__(self, *_: object) -> None:
        self.stop()

    def running(self) -> bool:
        return self._process is not None and self._process.poll() is None

    def returncode(self) -> int | None:
        return self._process.poll() if self._process else None

    def check(self) -> None:
        """Raises SessionError if the launch has ended by itself."""
        if not self.running():
            raise SessionError(
                f"{' '.join(self._command)} ended with status {self.returncode()}:\n{self.tail()}"
            )

    def tail(self, lines: int = 20) -> str:
        """The last lines of the log."""
        return "\n".join(self.log.read_text(errors="replace").splitlines()[-lines:])

    def run(
        self, *command: str, timeout: float = 30.0, check: bool = True
    ) -> subprocess.CompletedProcess[str]:
        """Runs a command on this master and returns it with its output as text."""
        return subprocess.run(
            command,
            env=self.environment,
            timeout=timeout,
            check=check,
            text=True,
            stdin=subprocess.DEVNULL,
            capture_output=True,
        )

    def wait_for_master(self, timeout: float = 60.0) -> None:
        """Waits until the master accepts connections; SessionError if the launch ends before or none does."""
        self._wait(self._accepts, timeout, f"The ROS master did not come up on port {self.port}")

    def wait_for_node(self, timeout: float = 60.0) -> None:
        """Waits for the first node of the launch, before which roslaunch has set all parameters.

        A program that becomes a node earlier does not see use_sim_time, and has the wall clock for good.
        SessionError if the launch ends before or no node comes.
        """
        self._wait(self._has_node, timeout, "The launch started no node")

    def _wait(self, reached: Callable[[], bool], timeout: float, failure: str) -> None:
        deadline = time.monotonic() + timeout
        while time.monotonic() < deadline:
            self.check()
            if reached():
                return
            time.sleep(0.05)
        raise SessionError(f"{failure} within {timeout} s:\n{self.tail()}")

    def _accepts(self) -> bool:
        with socket.socket() as probe:
            return probe.connect_ex(("127.0.0.1", self.port)) == 0

    def _has_node(self) -> bool:
        # A master that is not there yet, ends (its launch then ends, with the reason) or does not answer.
        with suppress(OSError, http.client.HTTPException):
            with xmlrpc.client.ServerProxy(self.environment["ROS_MASTER_URI"], _Transport()) as master:
                kinds: Any = master.getSystemState("/session")
                return bool({node for kind in kinds[2] for _, nodes in kind for node in nodes} - {"/rosout"})
        return False

    def stop(self, timeout: float = 20.0) -> None:
        """Interrupts the launch as Ctrl-C does, then ends the rest of its process group."""
        if self._process is None:
            return
        if self._process.poll() is None:
            self._process.send_signal(signal.SIGINT)
            try:
                self._process.wait(timeout)
            except subprocess.TimeoutExpired:
                pass
        for pid in self.processes():
            try:
                os.kill(pid, signal.SIGKILL)
            except ProcessLookupError:
                pass
        self._process.wait()

    def processes(self) -> list[int]:
        """Processes that belong to this master (nodes have their own process groups)."""
        mark = f"ROS_MASTER_URI=http://localhost:{self.port}".encode()
        network = os.readlink("/proc/self/ns/net")  # another one, of a container, may use the same port
        found = []
        for entry in Path("/proc").iterdir():
            if not entry.name.isdigit() or int(entry.name) == os.getpid():
                continue
            with suppress(OSError):
                # roslaunch gives its nodes the address with a final slash.
                lines = (entry / "environ").read_bytes().split(b"\0")
                if any(line.rstrip(b"/") == mark for line in lines):
                    if os.readlink(entry / "ns" / "net") == network:
                        found.append(int(entry.name))
        return found
