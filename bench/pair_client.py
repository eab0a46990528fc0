# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pair_client.py LIBRARY ADDRESS: commands zero torque, and counts its cycles.

LIBRARY is pyfranka or panda (panda-python). It prints `ready` when its motion runs, reads the monotonic times
at which to begin and to end, and prints the number of cycles between them. Runs in the environment of its
library, so it imports nothing of this project but pyfranka.
"""

import sys
import threading
import time
from collections.abc import Callable
from typing import Any


class Count:
    """Cycles from `begin` to `end`, of the monotonic clock."""

    def __init__(self) -> None:
        self.cycles, self.begin, self.end = 0, float("inf"), float("inf")

    def next(self) -> bool:
        """Counts one cycle. Returns whether it is the last."""
        now = time.monotonic()
        self.cycles += self.begin <= now < self.end
        return now >= self.end

    def read(self) -> None:
        print("ready", flush=True)
        begin, end = sys.stdin.readline().split()
        self.begin, self.end = float(begin), float(end)


def run(torques: Any, control: Callable[[Callable[[Any, Any], Any]], object], count: Count) -> None:
    reader = threading.Thread(target=count.read)

    def callback(_state: Any, _period: Any) -> Any:
        if reader.ident is None:
            reader.start()
        command = torques([0.0] * 7)
        command.motion_finished = count.next()
        return command

    control(callback)
    reader.join()


def main() -> None:
    library, address = sys.argv[1:]
    count = Count()
    if library == "panda":
        from panda_py import libfranka

        robot = libfranka.Robot(address)
        run(libfranka.Torques, lambda callback: robot.control(callback, False), count)
    else:
        import pyfranka

        robot = pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)
        run(pyfranka.Torques, lambda callback: robot.control_torques(callback, limit_rate=False), count)
    print(count.cycles, flush=True)


main()
