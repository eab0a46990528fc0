# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Single nodes on a ROS master, without launch files: their parameters, their output, their exit."""

import os
import signal
import subprocess
import xmlrpc.client
from contextlib import contextmanager, suppress
from pathlib import Path

import yaml
from franka_sim_mujoco.session import free_port
from waiting import PATIENCE, holds, wait_for

CONTROL_CONFIG = Path(__file__).resolve().parents[2] / "catkin_ws/src/franka_control/config"


def executable(package: str, name: str) -> str:
    for prefix in os.environ.get("CMAKE_PREFIX_PATH", "").split(":"):
        found = Path(prefix) / "lib" / package / name
        if found.exists():
            return str(found)
    raise FileNotFoundError(f"There is no {package}/{name} in the workspace; build it with ./franka build.")


def robot_description(robot: str, **arguments: str) -> str:
    """The URDF of an arm."""
    file = subprocess.run(
        ["catkin_find", "--first-only", "franka_description", f"robots/{robot}/{robot}.urdf.xacro"],
        text=True,
        capture_output=True,
        check=True,
    ).stdout.strip()
    return xacro(file, **arguments)


def xacro(file: str | Path, **arguments: str) -> str:
    """What a file becomes."""
    command = [executable("xacro", "xacro"), file, *(f"{name}:={value}" for name, value in arguments.items())]
    return subprocess.run(command, text=True, capture_output=True, check=True).stdout


def parameters(file: str, **arguments: str):
    """Those of franka_control's nodes and controllers, as their launch file loads them."""
    text = (CONTROL_CONFIG / file).read_text()
    for name, value in arguments.items():
        text = text.replace(f"$(arg {name})", value)
    return yaml.safe_load(text)


class Node:
    """A running node."""

    def __init__(self, process: subprocess.Popen, log: Path):
        self.process, self.log = process, log

    @property
    def output(self) -> str:
        return self.log.read_text(errors="replace")

    def must_print(self, *texts: str) -> None:
        """Waits for this output, at most until the node exits."""
        for text in texts:
            holds(lambda text=text: self.process.poll() is not None or text in self.output)
            assert text in self.output, self.output

    def ends(self) -> int:
        """Waits for its exit; returns its status."""
        return self.process.wait(PATIENCE)

    def interrupt(self) -> int:
        """Interrupts it as Ctrl-C does; returns its status."""
        self.process.send_signal(signal.SIGINT)
        return self.ends()


class Master:
    """A separate master and its nodes."""

    def __init__(self, folder: Path):
        self.folder = folder
        self.uri = f"http://localhost:{free_port()}"
        self.environment = dict(os.environ, ROS_MASTER_URI=self.uri, ROS_LOG_DIR=str(folder))
        self.environment.setdefault("ROS_HOSTNAME", "localhost")
        self.environment["ROSCONSOLE_STDOUT_LINE_BUFFERED"] = "1"  # also into a file
        self.server = xmlrpc.client.ServerProxy(self.uri)
        self.process = None
        self._nodes = 0

    def start(self) -> None:
        port = self.uri.rsplit(":", 1)[1]
        command = ["/usr/bin/python3", "/usr/bin/rosmaster", "--core", "-p", port]
        self.process = subprocess.Popen(
            command, env=self.environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
        )

        def answers():
            with suppress(OSError):
                return self.server.getPid("/test")

        wait_for(answers, "The ROS master")

    def stop(self) -> None:
        self.process.kill()
        self.process.wait()

    def set(self, name: str, value) -> None:
        """Sets one parameter, or a tree of them."""
        self.server.setParam("/test", name, value)

    def delete(self, name: str) -> None:
        if self.server.hasParam("/test", name)[2]:
            self.server.deleteParam("/test", name)

    @contextmanager
    def node(self, package: str, kind: str, name: str, through: tuple[str, ...] = ()):
        """Starts a node, optionally through a command; ends it at the end of the test."""
        self._nodes += 1
        log = self.folder / f"{name}_{self._nodes}.txt"
        with open(log, "w", encoding="utf-8") as out:
            process = subprocess.Popen(
                [*through, executable(package, kind), f"__name:={name}"],
                env=self.environment,
                stdin=subprocess.DEVNULL,
                stdout=out,
                stderr=subprocess.STDOUT,
            )
        try:
            yield Node(process, log)
        finally:
            process.kill()
            process.wait()

    def run(self, *command: str, timeout: float = 60.0) -> subprocess.CompletedProcess:
        return subprocess.run(
            command,
            env=self.environment,
            timeout=timeout,
            text=True,
            stdin=subprocess.DEVNULL,
            capture_output=True,
        )


@contextmanager
def master(folder: Path):
    started = Master(folder)
    try:
        started.start()
        yield started
    finally:
        started.stop()
