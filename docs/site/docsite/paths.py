# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Folders of the repository and of the site, and the repository's files."""

import subprocess
from functools import lru_cache
from pathlib import Path

TOP = Path(__file__).resolve().parents[3]
DOCS = TOP / "docs"
SITE = DOCS / "site"
WORKSPACE = TOP / "catkin_ws" / "src"
DEVEL = TOP / "catkin_ws" / "devel"
OUT = TOP / "out" / "docs"
# Folders of docs/ without pages.
NO_PAGES = {"site"}


@lru_cache(maxsize=1)
def files_of_repository() -> tuple[Path, ...]:
    """Files that git tracks or would add; all files if this is not a clone, such as in an archive."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    try:
        result = subprocess.run(command, cwd=TOP, capture_output=True, check=True)
        names = [TOP / name for name in result.stdout.decode().split("\0") if name]
    except (FileNotFoundError, subprocess.CalledProcessError):
        names = list(TOP.rglob("*"))
    return tuple(sorted(path for path in names if path.is_file()))
