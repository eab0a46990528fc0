# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pairs of a simulated robot in lock-step and a Python client beside each other, with zero torque.

The reference of pyfranka is genuine panda-python in the same run; runs of the two alternate.
"""

import statistics
import subprocess
import sys
import time
from contextlib import ExitStack
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


def factors(library: str, pairs: int, wall: float = WALL) -> list[float]:
    """Times real time of each pair, over the same `wall` seconds."""
    with ExitStack() as stack:
        clients = []
        for _ in range(pairs):
            sim = stack.enter_context(simulated("panda", "lockstep"))
            client = stack.enter_context(start_client(library, sim.address))
            stack.callback(client.kill)  # without effect on one that has ended
            clients.append(client)
        outputs = [Lines(client.stdout) for client in clients]
        for output in outputs:
            assert line_of(output, library) == "ready"
        begin = time.monotonic() + 0.3  # [s] in which all of them run already
        for client in clients:
            assert client.stdin is not None
            client.stdin.write(f"{begin} {begin + wall}\n")
            client.stdin.flush()
        return [1e-3 * int(line_of(output, library)) / wall for output in outputs]


def pairs() -> None:
    print("Pairs of franka_sim in lock-step and a Python client, zero torque: sum of times real time")
    genuine = LIBRARIES["panda"].exists()
    if not genuine:
        print("  panda-python is not installed; ./franka test tests installs it")
    libraries = list(LIBRARIES) if genuine else ["pyfranka"]
    sums = {}
    for count in PAIRS:
        tries = [{library: sum(factors(library, count)) for library in libraries} for _ in range(TRIES)]
        for library in libraries:
            sums[count, library] = statistics.median(one[library] for one in tries)
            figure(f"{count} at once, {library}", sums[count, library], "x")
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
