# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sweep: pick-and-place cases on two processes over one, the start of the processes included; then
once more on two, of which one is killed in the middle."""

import os
import signal
import sys
import threading
import time
from typing import Any

import cloudpickle
import pyfranka
from pyfranka import _sweep_run
from pyfranka.sweeps import Outcome
from report import TOP, figure

sys.path.append(str(TOP / "examples" / "python"))
import sweep_stiffness

cloudpickle.register_pickle_by_value(sweep_stiffness)  # workers of another's cluster do not find its folder
CASES = int(os.environ.get("FRANKA_BENCH_CASES", "200"))  # a few for a short form
ROUND_TRIP = 60.0  # [s] for a question to the workers


def cases() -> list[dict[str, object]]:
    return [{"robot": "panda", "stiffness": 800.0, "scene": scene + 1} for scene in range(CASES)]


def run(**where: Any) -> tuple[list[Outcome], float]:
    """The outcomes, and cases per second."""
    begin = time.perf_counter()
    done = pyfranka.sweep(sweep_stiffness.case, cases(), **where)
    took = time.perf_counter() - begin
    assert not done.failed, done.failed[0].error
    return list(done), len(done) / took


def hashes(done: list[Outcome]) -> list[str]:
    """Case by case, in order, each once."""
    assert [outcome.index for outcome in done] == list(range(CASES)), "lost or doubled"
    return [outcome.result["hash"] for outcome in done]


def run_with_a_killed_worker(seconds: float) -> tuple[list[Outcome], float, int]:
    """On two workers, one of which is killed from outside after so long. @returns also its process"""
    with _sweep_run.client_of(None, 2, CASES) as client:
        client.wait_for_workers(2, timeout=ROUND_TRIP)
        victim = sorted(client.run(os.getpid).values())[0]
        killer = threading.Timer(seconds, os.kill, (victim, signal.SIGKILL))
        killer.start()
        done, rate = run(cluster=client)
        killer.cancel()
        assert killer.finished.is_set() and not os.path.exists(f"/proc/{victim}"), "it was not killed"
        return done, rate, victim


def sweep() -> None:
    print(f"A sweep of {CASES} pick-and-place cases (pyfranka.sweep)")
    first, one = run(workers=1)
    figure("cases per second on one worker (reference)", one, "1/s")
    second, two = run(workers=2)
    figure("cases per second on two workers, over one", two / one, "", 1.8, at_least=True)
    third, killed, _ = run_with_a_killed_worker(0.5 * CASES / two)
    figure("the same with one worker killed in the middle", killed / one, "")
    figure("cases that were run again", sum(outcome.tries > 1 for outcome in third), "")
    equal = sum(hash == again for hash, again in zip(hashes(first), hashes(third), strict=True))
    figure("cases with the hash of the undisturbed run, of all", equal / CASES, "", 1.0, at_least=True)
    assert hashes(first) == hashes(second), "a case depends on the number of workers"
