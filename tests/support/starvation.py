# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A machine with more busy processes than processors."""

import os
import subprocess
import sys
from contextlib import contextmanager


@contextmanager
def busy():
    """Eight busy processes of normal priority for each processor."""
    spin = [sys.executable, "-c", "while True: pass"]
    spinners = [subprocess.Popen(spin) for _ in range(8 * os.cpu_count())]
    try:
        yield
    finally:
        for spinner in spinners:
            spinner.kill()
            spinner.wait()
