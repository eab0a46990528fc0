# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The program franka_sim, run by a Python program: robots on addresses of their own, ended with it.

    from pyfranka.franka_sim import FrankaSim

    with FrankaSim("panda") as sim:
        robot = sim.robot.connect()
        print(robot.read_once().q, sim.robot.remote.state().mode)

pyfranka.pytest_plugin has fixtures for it.
"""

from __future__ import annotations

import json
import os
import secrets
import select
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
import time
import typing
import weakref
from collections.abc import Sequence
from dataclasses import replace
from ipaddress import IPv4Address
from pathlib import Path

from pyfranka.remote import PORT, Remote
from pyfranka.sim.arguments import no_robot, path, whole
from pyfranka.sim.setups import FR3, Panda, described

if typing.TYPE_CHECKING:
    from numpy.typing import ArrayLike

    import pyfranka

__all__ = ["FrankaSim", "FrankaSimError", "ServedRobot"]

PROGRAM = "franka_sim"
TO_START, TO_END = 60.0, 20.0  # [s], on a busy machine (chosen here)
PAUSE = 0.1  # [s] between two looks whether it has ended (chosen here)
LAST_LINES = 100  # of a log in a message (chosen here)
# Chosen here, away from the addresses that users type. All of 127.0.0.0/8 belongs to the machine.
FIRST_ADDRESS, ADDRESSES = IPv4Address("127.64.0.0"), 1 << 22
ATTEMPTS = 50  # to find a free one (chosen here)


class FrankaSimError(RuntimeError):
    """franka_sim could not be started, ended by itself or did not end; the text is what it has written."""


class ServedRobot:
    """One robot of a running franka_sim.

    >>> served = server["panda"]
    >>> served.remote.state().mode
    'Idle'
    """

    def __init__(self, server: FrankaSim, robot: Panda | FR3, report: dict[str, typing.Any]):
        self.server, self.kind, self.address = server, robot.kind, robot.address
        self.name: str = report["arm_id"]
        self.desk: str = report.get("desk", "")  # the address of its Desk, such as https://127.0.0.1:8443
        self.protocol = robot.protocol or robot._protocols[-1]  # the newest version that it speaks
        self.remote = Remote(robot.address)  # its control interface
        if robot.load is not None:
            self.remote.set_load(*typing.cast("tuple[float, ArrayLike, ArrayLike]", robot.load))

    def __repr__(self) -> str:
        return f"<{self.kind} '{self.name}' at {self.address}>"

    def connect(self) -> pyfranka.Robot:
        """A connection to the robot that needs no real-time kernel. Raises pyfranka.Exception.

        >>> server["other"].connect().server_version
        5
        """
        import pyfranka

        return pyfranka.Robot(self.address, pyfranka.RealtimeConfig.Ignore)

    def gripper(self) -> pyfranka.Gripper:
        """A connection to its hand. Raises pyfranka.Exception.

        >>> server.robot.gripper().read_once().width >= 0.0
        True
        """
        import pyfranka

        return pyfranka.Gripper(self.address)


class FrankaSim:
    """A running franka_sim: robots in one world. A context manager that ends it.

    robots: pyfranka.sim.Panda and FR3, or the kind alone ("panda", "fr3"); without one, a panda. Their
    realism is "real" unless it is given, because their clients are programs for real robots. world: a scene,
    MJCF or SDF. pace: lockstep, realtime, patient or a factor. patience: how long it waits for a silent
    client [s], or "forever". wait: auto, spin or block. linger: how long it waits for clients at the end [s].
    viewer: opens a window. desk: serves Desk, whose address is ServedRobot.desk, and robots start locked;
    also the "ADDRESS:PORT" where. desk_user, desk_password: who may log in there. start: "ready" or
    "locked". docs/franka_sim.md describes these options. arguments: further words of its command line.
    program: its path; empty: the one of the workspace, of this Python environment or on PATH.

    Raises FrankaSimError with the program's own sentence if it does not start within a minute; ValueError or
    TypeError for robots and paths that cannot be used.

    The program ends with the object, with the interpreter and, if it was started by the main thread, also
    when this process is killed. Ctrl-C on a terminal does not reach it.

    >>> with FrankaSim("panda") as server:
    ...     server.robot.connect().read_once().robot_mode == pyfranka.RobotMode.Idle
    True
    """

    _all: typing.ClassVar[weakref.WeakSet[FrankaSim]] = weakref.WeakSet()

    def __init__(
        self,
        *robots: Panda | FR3 | str,
        world: str | os.PathLike[str] = "",
        pace: str | float = "lockstep",
        patience: str | float | None = None,
        wait: str | None = None,
        linger: float | None = None,
        viewer: bool = False,
        desk: bool | str = False,
        desk_user: str | None = None,
        desk_password: str | None = None,
        start: str | None = None,
        arguments: Sequence[str] = (),
        program: str | os.PathLike[str] = "",
    ):
        self._asked = [described(each) for each in robots or ("panda",)]
        values = {"pace": pace, "world": path(world, "world") or None, "patience": patience, "wait": wait}
        values |= {"linger": linger, "desk": desk or None, "desk-user": desk_user, "start": start}
        values["viewer"] = viewer or None
        self._options = [
            f"--{name}" if value is True else f"--{name}={value}"
            for name, value in values.items()
            if value is not None
        ]
        self._options += map(str, arguments)
        # Other users can read the command line.
        self._variables = {} if desk_password is None else {"FRANKA_DESK_PASSWORD": desk_password}
        self._program = find_program(program)
        self._locks: list[socket.socket] = []  # of the addresses
        self._stopped = False
        self._start()
        FrankaSim._all.add(self)

    def __repr__(self) -> str:
        return f"<franka_sim with {', '.join(map(repr, self.robots))}>"

    def __enter__(self) -> FrankaSim:
        return self

    def __exit__(self, *error: object) -> None:
        self.stop()

    def __getitem__(self, name: str) -> ServedRobot:
        for robot in self.robots:
            if robot.name == name:
                return robot
        raise KeyError(no_robot(name, (robot.name for robot in self.robots)))

    @property
    def robot(self) -> ServedRobot:
        """The first robot."""
        return self.robots[0]

    @property
    def stopped(self) -> bool:
        """Whether stop() or kill() was called."""
        return self._stopped

    @classmethod
    def known(cls) -> list[FrankaSim]:
        """Those that this process has started and still uses.

        >>> server in FrankaSim.known()
        True
        """
        return list(cls._all)

    def log(self, since: int = 0) -> str:
        """The program's output (standard output and standard error) from that byte on.

        >>> "panda" in server.log()
        True
        """
        since = whole(since, "since", 0, self.log_size())
        return os.pread(self._log.fileno(), self.log_size() - since, since).decode(errors="replace")

    def log_size(self) -> int:
        """Bytes of the log.

        >>> before = server.log_size()
        >>> server.log(since=before)
        ''
        """
        return os.fstat(self._log.fileno()).st_size

    def status(self) -> str:
        """A sentence if the program has ended, or nothing.

        >>> server.status()
        ''
        """
        code = self.process.poll()
        if code is None:
            return ""
        how = f"by signal {signal.Signals(-code).name}" if code < 0 else f"with status {code}"
        return f"franka_sim has ended {how}."

    def kill(self) -> None:
        """Ends the program as a crash does, for tests of what its clients do then.

        >>> short = FrankaSim("fr3")
        >>> short.kill()
        >>> short.status()
        'franka_sim has ended by signal SIGKILL.'
        """
        self._stopped = True
        self._finalizer()
        self._release()

    def stop(self) -> None:
        """Ends the program, if it runs. Raises FrankaSimError with its last lines if it has failed, or had to
        be killed because it did not end within 20 s.

        >>> short = FrankaSim("fr3")
        >>> short.stop()
        >>> short.stopped
        True
        """
        if self._stopped:
            return
        self._stopped = True
        by_itself = self.process.poll() is not None
        self._end()
        self._release()
        if self.process.returncode != 0:
            when = "by itself" if by_itself else "on request"
            raise FrankaSimError(
                f"{self.status()} It ended {when}; its last lines:\n{last_lines(self.log())}"
            )

    # ---- start and end -----------------------------------------------------------------------------------

    def _start(self) -> None:
        for _ in range(ATTEMPTS):
            robots = [replace(each, address=each.address or self._reserve()) for each in self._asked]
            self._log = tempfile.TemporaryFile(prefix="franka_sim.")
            weakref.finalize(self, self._log.close)
            words = [word for robot in robots for word in robot.options()]
            ready, ready_end = os.pipe()
            with os.fdopen(ready, "rb", buffering=0) as lines:
                with os.fdopen(ready_end, "wb"):
                    command = [self._program, f"--ready-fd={ready_end}", *words, *self._options]
                    self.process = _started(command, self._log, ready_end, self._variables)
                # Ends the program when this object or the interpreter ends.
                self._finalizer = weakref.finalize(self, _kill, self.process, os.getpid())
                report: dict[str, typing.Any] = {}
                try:
                    report = self._wait_until_ready(lines)
                finally:
                    if "robots" not in report:
                        self._end()
                        self._release()
            if "robots" in report:
                self.robots = [ServedRobot(self, *each) for each in zip(robots, report["robots"])]
                return
            # A robot that was not started here may be at an address that seemed free.
            if not report.get("address_in_use") or all(each.address for each in self._asked):
                break
        raise FrankaSimError(self.log().strip() or self.status())

    # The line of --ready-fd; empty if there is none, because the program has ended or takes too long.
    def _wait_until_ready(self, lines: typing.BinaryIO) -> dict[str, typing.Any]:
        poll = select.poll()
        poll.register(lines, select.POLLIN)
        deadline, text = time.monotonic() + TO_START, b""
        while time.monotonic() < deadline:
            ended = self.process.poll() is not None
            if poll.poll(1e3 * PAUSE):
                part = lines.read(1 << 16)
                text += part
                if text.endswith(b"\n"):
                    report: dict[str, typing.Any] = json.loads(text)
                    return report
                ended = not part
            if ended:
                return {}
        os.write(self._log.fileno(), f"franka_sim was not ready within {TO_START:g} s.\n".encode())
        return {}

    def _end(self) -> None:
        self._finalizer.detach()
        self.process.terminate()
        try:
            self.process.wait(TO_END)
        except subprocess.TimeoutExpired:
            _kill(self.process, os.getpid())

    # A free address. It is reserved by a socket, so that no other process takes it in the meantime: UDP,
    # which nothing of a robot has at this port.
    def _reserve(self) -> str:
        for _ in range(ATTEMPTS):
            address = str(FIRST_ADDRESS + 1 + secrets.randbelow(ADDRESSES - 2))
            lock = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
            try:
                lock.bind((address, PORT))
            except OSError:
                lock.close()
                continue
            self._locks.append(lock)
            return address
        raise FrankaSimError(f"No free address was found for a robot, UDP port {PORT} ({ATTEMPTS} attempts).")

    def _release(self) -> None:
        for lock in self._locks:
            lock.close()
        self._locks = []


def find_program(program: str | os.PathLike[str] = "") -> str:
    """The program franka_sim: that path; or the workspace's, this Python environment's, the one on PATH.
    Raises FrankaSimError if there is none."""
    program = path(program, "program")
    if program:
        found = shutil.which(program)
    else:
        prefixes = [prefix for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":") if prefix]
        folders = [*(str(Path(prefix) / "bin") for prefix in prefixes), str(Path(sys.executable).parent)]
        found = shutil.which(PROGRAM, path=":".join([*folders, os.environ.get("PATH", "")]))
    if found:
        return found
    raise FrankaSimError(
        f"There is no program '{program}'."
        if program
        else "There is no franka_sim in this workspace or Python environment, nor on PATH. Build it with "
        "./franka build, or install the wheel pyfranka."
    )


def last_lines(text: str) -> str:
    """The end of a log."""
    return "\n".join(text.splitlines()[-LAST_LINES:]) or "(it has written nothing)"


def _started(
    command: list[str], log: typing.IO[bytes], descriptor: int, variables: dict[str, str]
) -> subprocess.Popen[bytes]:
    # The system ends the program when the thread that started it ends: only the main one lasts.
    guard = shutil.which("setpriv")
    if guard and threading.current_thread() is threading.main_thread():
        command = [guard, "--pdeathsig", "TERM", "--", *command]
    return subprocess.Popen(
        command,
        stdin=subprocess.DEVNULL,
        stdout=log,
        stderr=subprocess.STDOUT,
        process_group=0,
        env={**os.environ, **variables},
        pass_fds=[descriptor],
    )


# A fork of the process that started it leaves the program alone.
def _kill(process: subprocess.Popen[bytes], owner: int) -> None:
    if os.getpid() == owner:
        process.kill()
        process.wait()
