# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A machine with more busy processes than processors."""

import os
import subprocess
import sys
from contextlib import contextmanager

LONG = bool(os.environ.get("FRANKA_TEST_LONG"))
SPINNERS = (8 if LONG else 1) * os.cpu_count()


@contextmanager
def busy(count: int = SPINNERS):
    """Busy processes of normal priority: one for each processor, in the long form eight."""
    spinners = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(count)]
    try:
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.wait()
