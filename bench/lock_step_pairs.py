# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs of a simulated robot in lock-step and a Python client beside each other, with zero torque.

The reference of pyfranka is genuine panda-python in the same run; runs of the two alternate.
"""

import os
import subprocess
import sys
import time
from contextlib import ExitStack
from dataclasses import dataclass
from pathlib import Path

from fci_session import simulated
from genuine_clients import folder_of
from lines import Lines
from report import figure

CLIENT = Path(__file__).resolve().parent / "pair_client.py"
LIBRARIES = {"pyfranka": sys.executable, "panda": folder_of("panda") / "bin" / "python"}
PAIRS = (1, 2, 4, 8)
TRIES = 5
WALL = 3.0  # [s] of one measurement


def start_client(library: str, address: str) -> subprocess.Popen[str]:
    command = [str(LIBRARIES[library]), str(CLIENT), library, address]
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)


def line_of(lines: Lines, library: str) -> str:
    line: str | None = lines.next(60.0)
    assert line is not None, f"A {library} client has ended, or has written nothing for 60 s."
    return line


def processor_times(pids: list[int]) -> tuple[float, float]:
    """What processes have taken together, in their own code and in the kernel [s]."""
    fields = [Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split() for pid in pids]
    ticks = os.sysconf("SC_CLK_TCK")
    return sum(int(each[11]) for each in fields) / ticks, sum(int(each[12]) for each in fields) / ticks


@dataclass
class Run:
    """Some pairs at once. factor: sum of their times real time. robot, client, kernel: processor time of an
    exchange [us], in the code of the one, of the other, and of the kernel for both."""

    factor: float
    robot: float
    client: float
    kernel: float


def run_pairs(library: str, pairs: int, wall: float = WALL) -> Run:
    """All pairs run over the same `wall` seconds."""
    with ExitStack() as stack:
        robots, clients = [], []
        for _ in range(pairs):
            sim = stack.enter_context(simulated("panda", "lockstep"))
            client = stack.enter_context(start_client(library, sim.address))
            stack.callback(client.kill)  # without effect on one that has ended
            robots.append(sim.server.process.pid)
            clients.append(client)
        outputs = [Lines(client.stdout) for client in clients]
        for output in outputs:
            assert line_of(output, library) == "ready"
        begin = time.monotonic() + 0.3  # [s] in which all of them run already
        for client in clients:
            assert client.stdin is not None
            client.stdin.write(f"{begin} {begin + wall}\n")
            client.stdin.flush()
        time.sleep(begin - time.monotonic())
        both = robots, [client.pid for client in clients]
        before = [processor_times(pids) for pids in both]
        time.sleep(0.9 * wall)  # until clients end
        after = [processor_times(pids) for pids in both]
        cycles = sum(int(line_of(output, library)) for output in outputs)
    used = [[1e6 * (after[i][k] - before[i][k]) / (0.9 * cycles) for k in range(2)] for i in range(2)]
    (robot, robot_kernel), (client_own, client_kernel) = used
    return Run(1e-3 * cycles / wall, robot, client_own, robot_kernel + client_kernel)


def pairs() -> None:
    print("Pairs of franka_sim in lock-step and a Python client, zero torque: sum of times real time")
    genuine = LIBRARIES["panda"].exists()
    if not genuine:
        print("  panda-python is not installed; ./franka test tests installs it")
    libraries = list(LIBRARIES) if genuine else ["pyfranka"]
    sums = {}
    for count in PAIRS:
        tries = [{library: run_pairs(library, count) for library in libraries} for _ in range(TRIES)]
        for library in libraries:
            runs = sorted((one[library] for one in tries), key=lambda run: run.factor)
            median = runs[TRIES // 2]
            sums[count, library] = median.factor
            figure(f"{count} at once, {library}", median.factor, "x")
            parts = f"robot {median.robot:.1f}, client {median.client:.1f}, kernel {median.kernel:.1f} us"
            print(f"    processor time of an exchange: {parts}")
    best = max(sums.values())
    for count in PAIRS:
        own = sums[count, "pyfranka"]
        if genuine:
            figure(
                f"{count} at once: pyfranka over panda-python",
                own / sums[count, "panda"],
                "",
                1.0,
                at_least=True,
            )
        if count >= 4:
            figure(f"{count} at once: pyfranka over the best sum", own / best, "", 0.95, at_least=True)
