# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Processes whose C library reads and writes numbers with a decimal comma, whatever the program is."""

import subprocess
from pathlib import Path

LOCALE = "de_DE.UTF-8"
TOP = Path(__file__).resolve().parents[2]


def environment(folder: Path = TOP / "out" / "decimal_comma") -> dict[str, str]:
    """The variables of such processes. Messages remain English.

    folder: for the locale, which is not installed, and the library that the programs load.
    """
    folder.mkdir(parents=True, exist_ok=True)
    library, locale = folder / "decimal_comma.so", folder / LOCALE
    if not locale.exists():
        subprocess.run(["localedef", "-i", "de_DE", "-f", "UTF-8", locale], check=True)
    source = Path(__file__).with_suffix(".cpp")
    subprocess.run(["cc", "-shared", "-fPIC", "-o", library, source], check=True)
    categories = {"LC_ALL": "", "LANG": LOCALE, "LC_NUMERIC": LOCALE, "LC_MESSAGES": "C"}
    return {**categories, "LOCPATH": str(folder), "LD_PRELOAD": str(library)}
