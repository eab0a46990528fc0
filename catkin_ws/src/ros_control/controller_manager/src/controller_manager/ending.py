# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Orderly exit of programs that must restore something first."""

import signal
import threading
from collections.abc import Callable
from typing import Any

import rospy

POLL_PERIOD = 0.1  # [s]
# How long an external shutdown request (rosnode kill) waits for the program's clean-up.
MAX_END_TIME = 15.0  # [s]


class Ended(Exception):
    """The program must exit."""


class Ending:
    """Detects a request to exit, by signal or by the master (rosnode kill).

    The request only sets a flag, and the main thread cleans up: a signal handler could deadlock on a lock
    of the interrupted code. rospy's shutdown waits for finish(), so that services can be called until then.
    """

    def __init__(self) -> None:
        self._requested = threading.Event()
        self._done = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: self._requested.set())
        rospy.on_shutdown(self._wait_for_end)

    def _wait_for_end(self) -> None:
        self._requested.set()
        self._done.wait(MAX_END_TIME)

    def is_requested(self) -> bool:
        return self._requested.is_set()

    def sleep(self, duration: float) -> None:
        """Raises Ended if a request to exit interrupts the sleep."""
        if self._requested.wait(duration):
            raise Ended

    def finish(self) -> None:
        """The clean-up is done: the node may exit."""
        self._done.set()
        rospy.signal_shutdown("the program has ended")

    def call(
        self, service: Callable[[Any], Any], request: Any, waits: Callable[[], None] = lambda: None
    ) -> Any:
        """The answer of a service that may never come. Raises Ended on a request to exit.

        Args:
            service: called in a thread of its own.
            waits: called every POLL_PERIOD until the answer comes.
        """
        outcome: dict[str, Any] = {}

        def work() -> None:
            try:
                outcome["answer"] = service(request)
            except Exception as error:  # raised again in the main thread
                outcome["error"] = error

        worker = threading.Thread(target=work, daemon=True)
        worker.start()
        while worker.is_alive():
            worker.join(POLL_PERIOD)
            waits()
            if self.is_requested() and worker.is_alive():
                raise Ended
        if "error" in outcome:
            raise outcome["error"]
        return outcome["answer"]
