# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A connection to the control interface of a robot."""

from __future__ import annotations

import socket
import time

# [bytes] (chosen here) The longest answers describe large worlds.
MAX_ANSWER = 1 << 24
MAX_FOREIGN_TEXT = 1 << 16  # of something else that listens there


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
                "still take effect."
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


def _is_answer(beginning: bytes) -> bool:
    return any(word.startswith(beginning[: len(word)]) for word in (b"ok", b"error:"))
