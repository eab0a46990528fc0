# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How much of the machine other work takes, for tests that judge the duration of work by many processes."""

import os
import resource
import time
from collections.abc import Callable
from pathlib import Path

TICK = 1.0 / os.sysconf("SC_CLK_TCK")  # [s] of the kernel's counts


def busy_time() -> float:
    """Time that the processors have worked [s], of this machine or, if it is virtual, of others."""
    user, nice, system, _, _, interrupts, soft, steal, *_ = map(
        int, Path("/proc/stat").read_text().split("\n", 1)[0].split()[1:]
    )
    return TICK * (user + nice + system + interrupts + soft + steal)


def time_of(pid: int) -> float:
    """Processor time of a process and of its children that have ended [s]; 0 if it has ended itself."""
    try:
        fields = Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()
    except OSError:
        return 0.0
    return TICK * sum(map(int, fields[11:15]))


def own_time() -> float:
    """The same for this process."""
    used = [resource.getrusage(whom) for whom in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN)]
    return sum(usage.ru_utime + usage.ru_stime for usage in used)


class OtherWork:
    """Measures from its construction the share of all processors that is left beside other work."""

    def __init__(self, processes: Callable[[], list[int]]):
        """@param processes gives the processes that are not other work, all started after this."""
        self._processes = processes
        self._wall, self._busy, self._own = time.monotonic(), busy_time(), own_time()

    def share_left(self) -> float:
        """From 0 to 1."""
        ours = own_time() - self._own + sum(map(time_of, self._processes()))
        others = max(0.0, busy_time() - self._busy - ours)
        return max(0.0, 1.0 - others / ((time.monotonic() - self._wall) * (os.cpu_count() or 1)))
