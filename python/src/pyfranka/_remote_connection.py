# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A connection to the control interface of a robot, which several threads share."""

from __future__ import annotations

import os
import re
import socket
import threading
import time
from collections.abc import Iterator
from contextlib import contextmanager

# [bytes] (chosen here) The longest answers describe large worlds.
MAX_ANSWER = 1 << 24
MAX_FOREIGN_TEXT = 1 << 16  # of something else that listens there
PAUSE = 0.01  # [s] between two looks (chosen here)
MIN_TIME_OF_RETRY = 0.5  # [s] that are left when a refused line is tried again (chosen here)
FULL = re.compile(r"error: \d+ clients use this control interface")


def left(deadline: float) -> float:
    """Seconds until the deadline; never zero, which would mean a socket that does not wait."""
    return max(1e-3, deadline - time.monotonic())


class Connection:
    """One TCP connection, in which lines are answered one after the other."""

    def __init__(self, address: str, port: int, deadline: float, limit: float):
        self._place = f"{address}, port {port}"
        try:
            self._socket = socket.create_connection((address, port), timeout=left(deadline))
        except TimeoutError:
            raise TimeoutError(f"Nothing has answered at {self._place} within {limit:g} s.") from None
        except OSError as error:
            raise ConnectionError(
                f"There is no control interface at {self._place} ({error.strerror or error}). Start "
                "franka_sim there, without --control-port 0."
            ) from None
        except ValueError as error:  # of an address that cannot be one
            raise ConnectionError(
                f"There is no control interface at {self._place!r}, which is not an address ({error})."
            ) from None

    def close(self) -> None:
        self._socket.close()

    def exchange(self, line: str, deadline: float, limit: float) -> str:
        try:
            self._socket.settimeout(left(deadline))
            self._socket.sendall(line.encode() + b"\n")
            return self._answer(deadline).decode(errors="replace")
        except TimeoutError:
            raise TimeoutError(
                f"The robot at {self._place} has not answered '{line}' within {limit:g} s. The line may "
                "still take effect. If a control callback has called this, it blocks itself: in lock-step "
                "time waits for the callback. Call it from another thread."
            ) from None
        except EOFError:
            raise ConnectionError(
                f"The robot at {self._place} went away before it answered '{line}'."
            ) from None
        except OSError as error:
            raise ConnectionError(
                f"The connection to the robot at {self._place} broke at '{line}': {error.strerror or error}."
            ) from None

    def _answer(self, deadline: float) -> bytes:
        data = b""
        while b"\n" not in data and len(data) < (MAX_ANSWER if _is_answer(data) else MAX_FOREIGN_TEXT):
            if time.monotonic() > deadline:
                raise TimeoutError
            self._socket.settimeout(left(deadline))
            part = self._socket.recv(65536)
            if not part:
                raise EOFError
            data += part
        return data.partition(b"\n")[0].rstrip(b"\r")


class SharedConnection:
    """Exchanges lines with one robot: with a connection for each line, or with one that is kept. Threads wait
    for each other; a forked process begins without a connection. `limit` is that of a call [s]."""

    def __init__(self, address: str, port: int):
        self.address, self.port = address, port
        self.place = f"{address}, port {port}"
        self._connection: Connection | None = None
        self._keeps = False
        self._lock, self._process = threading.RLock(), os.getpid()

    @contextmanager
    def keep(self, limit: float) -> Iterator[None]:
        """Keeps the connection of the exchanges within and after it, unless it raises."""
        with self._locked(limit):
            self._keeps = True
            try:
                yield
            except BaseException:
                self.close()
                raise

    def close(self) -> None:
        self._keeps = False
        self._leave()

    def exchange(self, line: str, limit: float) -> str:
        """The answer to a line. While the robot has too many clients, it refuses the line without executing
        it: then it is sent again."""
        with self._locked(limit):
            deadline = time.monotonic() + limit
            while True:
                connection = self._connection or Connection(self.address, self.port, deadline, limit)
                self._connection = None
                keep = False
                try:
                    answer = connection.exchange(line, deadline, limit)
                    refused = FULL.match(answer) is not None
                    keep = self._keeps and not refused
                finally:
                    if keep:
                        self._connection = connection
                    else:
                        connection.close()
                # A try that ends at the time limit could not report why there was no answer.
                if not refused or time.monotonic() + PAUSE + MIN_TIME_OF_RETRY > deadline:
                    return answer
                time.sleep(PAUSE)

    def robot_listens(self, deadline: float) -> bool:
        try:
            socket.create_connection((self.address, self.port), timeout=left(deadline)).close()
            return True
        except OSError:
            return False

    @contextmanager
    def _locked(self, limit: float) -> Iterator[None]:
        if self._process != os.getpid():
            # The connection belongs to the other process, in which a thread may hold the lock.
            self._lock, self._process = threading.RLock(), os.getpid()
            self._leave()  # closes this process's copy; the other one's stays open
        if not self._lock.acquire(timeout=limit):
            raise TimeoutError(f"Another thread has used this Remote for more than {limit:g} s.")
        try:
            yield
        finally:
            self._lock.release()

    def _leave(self) -> None:
        connection, self._connection = self._connection, None
        if connection:
            connection.close()


def _is_answer(beginning: bytes) -> bool:
    return any(word.startswith(beginning[: len(word)]) for word in (b"ok", b"error:"))
