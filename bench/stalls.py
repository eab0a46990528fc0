# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The delays of a machine's threads: the reference for results in real time."""

import threading
import time
from typing import Self

from fci_session import go_first

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
        go_first()
        while not self._ended.is_set():
            begin = time.monotonic()
            time.sleep(PERIOD)
            delay = time.monotonic() - begin - PERIOD
            self.worst = max(self.worst, delay)
            self.late += delay > PERIOD
