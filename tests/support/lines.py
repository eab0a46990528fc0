# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Lines of a program's output, each within a time limit."""

import queue
import threading


class Lines:
    """Reads a pipe in its own thread.

    select() on the pipe is not enough: it does not see lines that readline() has already buffered, so a
    program that writes two lines at once seems to have written one.
    """

    def __init__(self, stream):
        self._lines = queue.Queue()
        threading.Thread(target=self._read, args=(stream,), daemon=True).start()

    def _read(self, stream) -> None:
        with stream:
            for line in stream:
                self._lines.put(line.strip())
        self._lines.put(None)

    def next(self, timeout: float) -> str | None:
        """The next line without its end; None if the output has ended or after that time [s]."""
        try:
            return self._lines.get(timeout=timeout)
        except queue.Empty:
            return None
