# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Whether the machine itself keeps time. What runs by the clock says nothing where threads wake up late."""

import threading
import time

import pytest
from fci_session import go_first

PERIOD = 1e-3  # [s] of a robot's cycles
# A robot takes single lost commands; a client without a rate limiter is stopped after a few in a row.
WORST = 3e-3  # [s]
TRIES = 3


class Stalls:
    """Measures, with the priority of a robot's client, how late a thread wakes up.

    `worst` is the longest delay [s], `late` counts those of more than a period.
    """

    def __enter__(self):
        self.worst, self.late, self._ended = 0.0, 0, threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *_):
        self._ended.set()
        self._thread.join()

    def _watch(self):
        go_first()
        while not self._ended.is_set():
            begin = time.monotonic()
            time.sleep(PERIOD)
            delay = time.monotonic() - begin - PERIOD
            self.worst = max(self.worst, delay)
            self.late += delay > PERIOD


def in_time(attempt, is_good):
    """What `attempt` returns: the first that is good or met no stall of the machine.

    Where there is none the test is skipped. It is for what needs the wall's clock: what a robot does is to be
    tested in lock-step or with a patient one.
    """
    worst = []
    for _ in range(TRIES):
        with Stalls() as stalls:
            result = attempt()
        if is_good(result) or stalls.worst < WORST:
            return result
        worst.append(f"{1e3 * stalls.worst:.1f}")
    pytest.skip(f"The machine has stalled for {', '.join(worst)} ms: the clock says nothing of a robot here.")
