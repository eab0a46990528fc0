# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Franka's own client libraries, from PyPI, each in an environment of its own (decision 33)."""

import subprocess
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
PACKAGES = {
    "panda": ["panda-python==1.1.1", "requests", "websockets", "numpy"],
    "pylibfranka": ["pylibfranka==0.21.3", "numpy"],
}


def client_python(name: str) -> Path:
    """The interpreter of that environment, which is made when it is not there."""
    folder = TOP / "out" / "genuine" / name
    python, stamp = folder / "bin" / "python", folder / "installed"
    if not (stamp.exists() and stamp.read_text() == " ".join(PACKAGES[name])):
        subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", folder], check=True, timeout=120)
        subprocess.run(
            [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check", *PACKAGES[name]],
            check=True,
            timeout=600,
        )
        stamp.write_text(" ".join(PACKAGES[name]))
    return python
