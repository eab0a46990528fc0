#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Writes the tables of docs/limits.md from franka_core/limits.h."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent))

from docsite.robot_limits import PAGE, expected_page  # noqa: E402

if __name__ == "__main__":
    PAGE.write_text(expected_page())
