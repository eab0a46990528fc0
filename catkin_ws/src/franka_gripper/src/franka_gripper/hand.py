# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One hand, used by several threads: its state stream, and one command at a time. Knows no ROS."""

import threading
import time


class Interrupted(Exception):
    """The command was ended by another one, or by its own caller."""


class Hand:
    """Follows the state of a gripper and carries out its commands.

    Waiting for the end of a command blocks only the thread that asked for it. A new command ends the
    one that runs, as `interrupt` does; the one that waited for it then gets Interrupted.

    `connect` makes the connection, an object like pyfranka.Gripper; it is called again, once a second,
    after the connection was lost.
    """

    POLL = 0.01  # [s] between looks at whether a command shall end
    RETRY = 1.0  # [s] between attempts to connect

    def __init__(self, connect, report=print):
        self._connect = connect
        self._report = report
        self._gripper = connect()
        self._state = self._gripper.read_once()
        self._fresh = time.monotonic()
        self._ended = threading.Event()
        self._lock = threading.Lock()  # for the two below
        self._busy = False
        self._tickets = 0
        self._idle = threading.Condition(self._lock)
        self._reader = threading.Thread(target=self._follow, daemon=True)
        self._reader.start()

    def close(self):
        """Ends the thread that follows the state. Takes as long as one state, a second at most."""
        self._ended.set()
        self._reader.join(2.0)

    @property
    def state(self):
        """The newest state."""
        return self._state

    @property
    def age(self):
        """Since the newest state arrived [s]."""
        return time.monotonic() - self._fresh

    def _follow(self):
        lost = False
        while not self._ended.is_set():
            try:
                self._state = self._gripper.read_once()
                self._fresh = time.monotonic()
                lost = False
            except Exception as error:
                if not lost:
                    self._report(f"The gripper's state does not arrive. {error} Connecting again.")
                lost = True
                self._ended.wait(self.RETRY)
                self._reconnect()

    def _reconnect(self):
        if self._ended.is_set():
            return
        try:
            self._gripper = self._connect()
        except Exception:
            return  # tried again after the next state that does not arrive

    def stop(self):
        """Ends the command that runs and the force of a grasp. Returns whether the hand did."""
        return self._gripper.stop()

    def interrupt(self):
        """Ends the command that runs, if one does."""
        with self._lock:
            self._tickets += 1
            busy = self._busy
        if busy:
            self._gripper.stop()

    def run(self, command, cancelled=lambda: False):
        """Carries out command(gripper) and returns what it returns.

        Another command that runs is ended first. Raises Interrupted when this one was ended before it
        was through, and what the command raises otherwise. `cancelled` is asked now and then whether to
        end it.
        """
        self.interrupt()
        with self._lock:
            ticket = self._tickets
            while self._busy:
                self._idle.wait(self.POLL)
                if self._tickets != ticket or cancelled():
                    raise Interrupted()
            self._busy = True
        try:
            return self._await(command, ticket, cancelled)
        finally:
            with self._lock:
                self._busy = False
                self._idle.notify_all()

    def _await(self, command, ticket, cancelled):
        outcome = {}
        done = threading.Event()

        def work():
            try:
                outcome["result"] = command(self._gripper)
            except Exception as error:
                outcome["error"] = error
            done.set()

        threading.Thread(target=work, daemon=True).start()
        stopped = False
        while not done.wait(self.POLL):
            if not stopped and cancelled():
                self._gripper.stop()
                stopped = True
        if stopped or (self._tickets != ticket and "error" in outcome):
            raise Interrupted()
        if "error" in outcome:
            raise outcome["error"]
        return outcome["result"]
