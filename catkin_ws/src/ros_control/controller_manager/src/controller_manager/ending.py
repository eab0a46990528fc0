# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The end of programs that have something to put back first."""

import signal
import threading

import rospy

POLL_PERIOD = 0.1  # [s]
# How long a request to end from outside (rosnode kill) waits for the program to put things back.
LONGEST_END = 15.0  # [s]


class Ended(Exception):
    """The program was told to end."""


class Ending:
    """Knows when a program shall end, by signal or by the master (rosnode kill).

    Either only leaves a note, and the main thread does what is left to do: within a signal handler
    it would meet whatever lock the interrupted code holds. rospy's shutdown waits for finish(), so
    that services can be called until then.
    """

    def __init__(self):
        self._asked = threading.Event()
        self._done = threading.Event()
        for number in (signal.SIGINT, signal.SIGTERM):
            signal.signal(number, lambda *_: self._asked.set())
        rospy.on_shutdown(self._wait_for_end)

    def _wait_for_end(self):
        self._asked.set()
        self._done.wait(LONGEST_END)

    def is_asked(self):
        return self._asked.is_set()

    def sleep(self, duration):
        """Raises Ended when the time is cut short."""
        if self._asked.wait(duration):
            raise Ended

    def finish(self):
        """Everything is done: the node may go."""
        self._done.set()
        rospy.signal_shutdown("the program has ended")

    def call(self, service, request):
        """The answer of a service that may take for ever. Raises Ended if told to end meanwhile."""
        outcome = {}

        def work():
            try:
                outcome["answer"] = service(request)
            except Exception as error:  # re-raised where it can be handled
                outcome["error"] = error

        worker = threading.Thread(target=work, daemon=True)
        worker.start()
        while worker.is_alive():
            worker.join(POLL_PERIOD)
            if self.is_asked() and worker.is_alive():
                raise Ended
        if "error" in outcome:
            raise outcome["error"]
        return outcome["answer"]
