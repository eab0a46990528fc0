# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The control interface of a simulated robot: one command a line (docs/franka_sim.md)."""

import socket

PORT = 1340


def answer(address: str, line: str) -> str:
    """Sends one command; returns the answer, `ok ...` or `error: ...`."""
    # One connection per line: the robot closes silent ones.
    with socket.create_connection((address, PORT), timeout=60) as connection:
        stream = connection.makefile("rw", newline="\n")
        stream.write(line + "\n")
        stream.flush()
        return stream.readline().strip()


def ask(address: str, line: str) -> str:
    """The same; returns what follows `ok`. Raises RuntimeError for any other answer."""
    text = answer(address, line)
    if not text.startswith("ok"):
        raise RuntimeError(f"{line}: {text}")
    return text[3:]
