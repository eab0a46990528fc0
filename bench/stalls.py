# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The delays of a machine's threads: the reference for results in real time."""

import os
import threading
import time
from contextlib import suppress
from typing import Self

PERIOD = 1e-3  # [s] of a robot's cycles


class Stalls:
    """Measures the wake-up delay of a thread with the priority of a robot's client.

    `worst` is the longest delay [s], `late` counts delays of more than a period.
    """

    def __enter__(self) -> Self:
        self.worst, self.late, self._ended = 0.0, 0, threading.Event()
        self._thread = threading.Thread(target=self._watch)
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._ended.set()
        self._thread.join()

    def _watch(self) -> None:
        with suppress(PermissionError):
            os.sched_setscheduler(0, os.SCHED_FIFO | os.SCHED_RESET_ON_FORK, os.sched_param(50))
        while not self._ended.is_set():
            begin = time.monotonic()
            time.sleep(PERIOD)
            delay = time.monotonic() - begin - PERIOD
            self.worst = max(self.worst, delay)
            self.late += delay > PERIOD
