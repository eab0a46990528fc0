# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sweep: pick-and-place cases on two processes over one. The start of the processes counts."""

import os
import sys
import time

import pyfranka
from report import TOP, figure

sys.path.append(str(TOP / "examples" / "python"))
import sweep_stiffness

CASES = int(os.environ.get("FRANKA_BENCH_CASES", "200"))  # a few for a short form


def rate(workers: int) -> float:
    """Cases per second."""
    cases = [{"robot": "panda", "stiffness": 800.0, "scene": scene + 1} for scene in range(CASES)]
    begin = time.perf_counter()
    done = pyfranka.sweep(sweep_stiffness.case, cases, workers=workers)
    took = time.perf_counter() - begin
    assert not done.failed, done.failed[0].error
    return len(done) / took


def sweep() -> None:
    print(f"A sweep of {CASES} pick-and-place cases (pyfranka.sweep)")
    one = rate(1)
    figure("cases per second on one worker (reference)", one, "1/s")
    figure("cases per second on two workers, over one", rate(2) / one, "", 1.8, at_least=True)
