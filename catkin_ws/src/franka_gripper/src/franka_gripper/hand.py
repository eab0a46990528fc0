# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""One hand, used by several threads: its state stream, and one command at a time. No ROS."""

from __future__ import annotations

import threading
import time
import typing
from collections.abc import Callable

if typing.TYPE_CHECKING:
    import pyfranka

    Command = Callable[[pyfranka.Gripper], bool]


class Outcome(typing.TypedDict, total=False):
    """How a command ended."""

    result: bool
    error: Exception


class Interrupted(Exception):
    """The command was ended by another one, or by its own caller."""


class Stopped(Exception):
    """The command was ended by `Hand.stop`."""


class Hand:
    """Reads the state of a gripper and executes its commands.

    Waiting for the end of a command blocks only the calling thread. A new command ends the running one;
    the thread that waits for it then gets Interrupted, or Stopped after `stop`.

    `connect` returns the connection, an object like pyfranka.Gripper; after a loss of the connection it is
    called once a second.
    """

    POLL = 0.01  # [s] between checks whether a command must end
    WORD = 0.5  # [s] longest wait for a new state, of which the hand sends thirty a second
    RETRY = 1.0  # [s] between attempts to connect

    def __init__(self, connect: Callable[[], pyfranka.Gripper], report: Callable[[str], object] = print):
        self._connect = connect
        self._report = report
        self._gripper = connect()
        self._state = self._gripper.read_once()
        self._fresh = time.monotonic()
        self._arrived = threading.Condition()  # notified of every state
        self._ended = threading.Event()
        self._idle = threading.Condition()  # guards the following members
        self._busy = False  # the hand has a command
        self._asked = 0  # counts commands and stops; a command ends when it is no longer the newest
        self._stopped = 0  # value of `_asked` at the last stop
        self._reader = threading.Thread(target=self._follow, daemon=True)
        self._reader.start()

    def close(self) -> None:
        """Ends the thread that reads states. Takes as long as one state, at most a second."""
        self._ended.set()
        self._reader.join(2.0)

    @property
    def state(self) -> pyfranka.GripperState:
        """The newest state."""
        return self._state

    @property
    def age(self) -> float:
        """Time since the newest state arrived [s]."""
        return time.monotonic() - self._fresh

    @property
    def busy(self) -> bool:
        """Whether a command runs."""
        return self._busy

    def next_state(self) -> pyfranka.GripperState:
        """A state that arrived after this call; the newest one if the hand is silent."""
        asked = time.monotonic()
        with self._arrived:
            self._arrived.wait_for(lambda: self._fresh > asked, self.WORD)
            return self._state

    def _follow(self) -> None:
        lost = False
        while not self._ended.is_set():
            try:
                state = self._gripper.read_once()
                with self._arrived:
                    self._state, self._fresh = state, time.monotonic()
                    self._arrived.notify_all()
                lost = False
            except Exception as error:
                if not lost:
                    self._report(f"The gripper's state does not arrive. {error} Connecting again.")
                lost = True
                self._ended.wait(self.RETRY)
                self._reconnect()

    def _reconnect(self) -> None:
        if self._ended.is_set():
            return
        try:
            self._gripper = self._connect()
        except Exception:
            return  # tried again after the next state that does not arrive

    def stop(self) -> bool:
        """Ends the running command and the force of a grasp. Returns whether the hand did."""
        with self._idle:
            self._asked += 1
            self._stopped = self._asked
        return self._gripper.stop()

    def run(self, command: Command, canceled: Callable[[], bool] = lambda: False) -> bool:
        """Executes command(gripper) and returns its result.

        Ends another running command first. Raises Interrupted or Stopped if this one was ended before it
        was complete, otherwise the command's exceptions. Polls `canceled` and ends the command if it is
        true.
        """
        with self._idle:
            self._asked += 1
            ticket = self._asked

            def end() -> bool:
                return self._asked != ticket or canceled()

            while self._busy and not end():
                self._idle.wait(self.POLL)
            if end():
                raise self._reason(ticket)
            self._busy = True
        outcome: Outcome = {}
        done = threading.Event()
        threading.Thread(target=self._work, args=(command, outcome, done), daemon=True).start()
        stopped = self._await(done, end)
        if stopped and outcome.get("result") is None:
            raise self._reason(ticket)
        if "error" in outcome:
            raise outcome["error"]
        return outcome["result"]

    def _reason(self, ticket: int) -> Exception:
        """The reason why the command with this ticket must end."""
        return Stopped() if self._stopped > ticket else Interrupted()

    def _work(self, command: Command, outcome: Outcome, done: threading.Event) -> None:
        try:
            outcome["result"] = command(self._gripper)
        except Exception as error:
            outcome["error"] = error
        with self._idle:
            self._busy = False
            self._idle.notify_all()
        done.set()

    def _await(self, done: threading.Event, end: Callable[[], bool]) -> bool:
        """Waits for the end of a command; returns whether it was requested.

        A stop may reach the hand before the command, or be lost with the connection: it is repeated.
        """
        stopped = False
        while not done.wait(self.POLL):
            if end():
                stopped = True
                try:
                    self._gripper.stop()
                except Exception:
                    done.wait(self.POLL)  # the command's exception holds the reason
        return stopped or end()
