#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Fails if the last build has printed a compiler warning about a file of this repository.

The build itself continues after a warning: a user with another compiler must get programs. Warnings about
system headers do not count, because the optimizer's warnings about them depend on the release. ccache repeats
the warnings of cached objects, with the paths of the clone that compiled them, so a clean clone shows all of
them.
"""

import re
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parent.parent
LOG = TOP / "out" / "build.log"
WARNING = re.compile(r"^([^\s:]+):\d+(?::\d+)?: warning: .*", re.MULTILINE)


def warnings(log: str, files: set[Path]) -> list[str]:
    """The distinct warning lines of a log about one of `files`, in this clone or another one."""
    found = {}
    for match in WARNING.finditer(log):
        # Compilers run in folders of different depth.
        parts = re.sub(r"^(\.\./)+(?=src/)", "catkin_ws/", match[1]).split("/")
        if any((TOP / "/".join(parts[first:])).resolve() in files for first in range(len(parts) - 1)):
            found[match[0]] = None
    return list(found)


def main() -> int:
    if not LOG.exists():
        print("There is no out/build.log: run ./franka build first.")
        return 1
    listing = subprocess.run(["git", "ls-files", "-z"], cwd=TOP, capture_output=True, check=True).stdout
    files = {(TOP / name).resolve() for name in listing.decode().split("\0") if name}
    found = warnings(LOG.read_text(errors="replace"), files)
    print("\n".join(found) or "The compiler had no warnings.")
    return 1 if found else 0


if __name__ == "__main__":
    sys.exit(main())
