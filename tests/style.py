#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The style checks: ruff for Python, and the rules of the house that a search can hold.

clang-format runs where it is installed. Exit status 1 when something is out of place; each finding is a
line `file:line: what`.
"""

import re
import shutil
import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent

HEADER = "Copyright (c) 2026 the franka_ros for Debian authors"
NEEDS_HEADER = {".cpp", ".h", ".py", ".sh", ".cmake", ".launch", ".xacro"}

# Who may include what: a path pattern, the headers that must not stand there, and why.
ROOMS = [
    (
        r"catkin_ws/src/(libfranka|franka_sim)/",
        r"<(ros|tf2?|tf2_ros|std_msgs|sensor_msgs|geometry_msgs)/",
        "this room knows no ROS",
    ),
    (r"(?!.*/physics/)", r"<mujoco/", "MuJoCo headers stand in physics/ only"),
    (
        r"(?!catkin_ws/src/libfranka/src/|.*/fci/|.*/test/|tests/)",
        r"<(sys/socket|netinet/in|arpa/inet)\.h>",
        "sockets stand in libfranka/src and fci/ only",
    ),
]
MARKERS = re.compile(r"\b(TO" r"DO|FIX" r"ME|XX" r"X|HA" r"CK)\b")
MACHINE_PATH = re.compile(r"(?<![\w.$}/-])/(work|home|root|Users)/\w+")


def tracked() -> list[Path]:
    listing = subprocess.run(["git", "ls-files", "-z"], cwd=TOP, capture_output=True, check=True).stdout
    return [TOP / name for name in listing.decode().split("\0") if name and (TOP / name).is_file()]


def room_findings(name: str, lines: list[str]) -> Iterator[str]:
    for pattern, header, reason in ROOMS:
        if not re.match(pattern, name):
            continue
        for number, line in enumerate(lines, 1):
            if re.match(r"\s*#\s*include\s*" + header, line):
                yield f"{name}:{number}: {reason}: {line.strip()}"


def text_findings(path: Path) -> Iterator[str]:
    name = str(path.relative_to(TOP))
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except UnicodeDecodeError:
        return
    if path.suffix in NEEDS_HEADER and lines and not any(HEADER in line for line in lines[:6]):
        yield f"{name}:1: the licence header is missing"
    if path.suffix in {".cpp", ".h"}:
        yield from room_findings(name, lines)
        if path.suffix == ".h" and "#pragma once" not in lines:
            yield f"{name}:1: #pragma once is missing"
    for number, line in enumerate(lines, 1):
        if path.suffix != ".md" and name != "tests/style.py" and MARKERS.search(line):
            yield f"{name}:{number}: a left-over marker: {line.strip()}"
        if name != "tests/style.py" and MACHINE_PATH.search(line):
            yield f"{name}:{number}: names a machine's path: {line.strip()}"
        if path.suffix in {".cpp", ".h", ".py"} and line != line.rstrip():
            yield f"{name}:{number}: blanks at the end of the line"


def clang_format(files: list[Path]) -> int:
    if not shutil.which("clang-format"):
        return 0
    sources = [str(path) for path in files if path.suffix in {".cpp", ".h"}]
    return subprocess.run(["clang-format", "--dry-run", "--Werror", *sources]).returncode


def main() -> int:
    files = tracked()
    findings = [finding for path in files for finding in text_findings(path)]
    print("\n".join(findings))
    ruff = subprocess.run([sys.executable, "-m", "ruff", "check", "--quiet", "."], cwd=TOP).returncode
    return 1 if findings or ruff or clang_format(files) else 0


if __name__ == "__main__":
    sys.exit(main())
