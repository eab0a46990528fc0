# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Franka's own client libraries, from PyPI, each in its own environment (decision 33)."""

import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]
PACKAGES = {
    "panda": ["panda-python==1.1.1", "requests", "websockets", "numpy"],
    "pylibfranka": ["pylibfranka==0.21.3", "numpy"],
}


class NoWheel(Exception):
    """PyPI has no wheel of a client for this machine's Python; the message names it."""


def find_client_python(name: str) -> Path:
    """The interpreter of that environment, which is created if missing. Raises NoWheel."""
    folder = TOP / "out" / "genuine" / name
    python, stamp = folder / "bin" / "python", folder / "installed"
    if not (stamp.exists() and stamp.read_text() == " ".join(PACKAGES[name])):
        subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", folder], check=True, timeout=120)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        result = subprocess.run(
            [*pip, "--only-binary=:all:", *PACKAGES[name]], capture_output=True, text=True, timeout=600
        )
        # Without a network pip first retries, and then prints the same.
        if "No matching distribution found" in result.stderr and "Retrying" not in result.stderr:
            version = subprocess.check_output([python, "--version"], text=True).strip()
            raise NoWheel(f"PyPI has no wheel of {PACKAGES[name][0]} for {version}")
        assert result.returncode == 0, result.stderr
        stamp.write_text(" ".join(PACKAGES[name]))
    return python


def client_python(name: str) -> Path:
    """The same for a test, which is skipped if there is no such client."""
    try:
        return find_client_python(name)
    except NoWheel as reason:
        pytest.skip(str(reason))
