# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Names each source in compile_commands.json, as editors and clang-tidy need it.

CMake names only the files of build_settings.cmake, which include several sources each. Such an entry becomes
one for each of its sources.

    python3 compile_commands.py catkin_ws/build/compile_commands.json
"""

import json
import re
import sys
from pathlib import Path
from typing import Any

SEVERAL = re.compile(r"/Unity/unity_\w+_cxx\.cxx$")
INCLUDED = re.compile(r'^#include "(.+)"$', re.M)


def with_each_source(entries: list[dict[str, Any]]) -> list[dict[str, Any]]:
    """The entries, those of several sources replaced."""
    named = []
    for entry in entries:
        if not SEVERAL.search(entry["file"]):
            named.append(entry)
            continue
        for source in INCLUDED.findall(Path(entry["file"]).read_text(encoding="utf-8")):
            command = entry["command"].replace(entry["file"], source)
            named.append({**entry, "file": source, "command": command})
    return named


def main(path: Path) -> None:
    entries = json.loads(path.read_text(encoding="utf-8"))
    path.write_text(json.dumps(with_each_source(entries), indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main(Path(sys.argv[1]))
