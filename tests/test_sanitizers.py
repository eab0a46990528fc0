# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""ThreadSanitizer on the controller manager's hand-over between services and loop."""

import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
SCRIPT = TOP / "catkin_ws" / "src" / "ros_control" / "controller_manager" / "test" / "tsan.sh"


def test_controller_manager_under_thread_sanitizer(long_run):
    operations = "100000" if long_run else "10000"
    build = TOP / "out" / "tsan"
    result = subprocess.run(
        [str(SCRIPT), str(build), operations],
        text=True,
        timeout=850,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert result.returncode == 0, result.stdout[-6000:]
