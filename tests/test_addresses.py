# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Files of tests run at the same time: each has robot addresses of its own."""

import re
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
# No robot is at these: 127.0.0.x stands in texts, and nothing shall answer at the last one.
SHARED = re.compile(r"127\.0\.0\.\d+|127\.0\.32\.20")


def files_of_tests():
    folders = [TOP / "tests", TOP / "python/test", *(TOP / "catkin_ws/src").glob("**/test")]
    for folder in folders:
        if "pyfranka" not in folder.parts:  # a link to python
            yield from folder.rglob("test_*.py")


def test_no_two_files_have_a_robot_at_the_same_address():
    users: dict[str, set[str]] = {}
    for file in set(files_of_tests()):
        for address in re.findall(r"127\.\d+\.\d+\.\d+", file.read_text(encoding="utf-8")):
            if not SHARED.fullmatch(address):
                users.setdefault(address, set()).add(str(file.relative_to(TOP)))
    assert users
    assert {address: files for address, files in users.items() if len(files) > 1} == {}
