# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Franka's own client libraries, from PyPI, each in its own environment (decision 33)."""

import shutil
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]
REQUESTS = ["requests", "urllib3", "idna", "certifi", "charset-normalizer"]
PACKAGES = {
    "panda": ["panda-python==1.1.1", "requests", "websockets", "numpy"],
    "pylibfranka": ["pylibfranka==0.21.3", "numpy"],
    # Clients of Desk; some move robots too.
    "franky": ["franky-control==2.0.0"],
    "franka_desk": ["franka-desk==0.1.0"],
    "franka_deskapi": ["franka-deskapi==1.0.1"],
    "aiofranka": ["aiofranka==0.9.0"],
    # Only their clients of Desk: what they need beside those is larger than this project.
    "rcs": ["rcs-fr3==0.7.3", "rcs-panda==0.7.3", *REQUESTS, "websockets", "python-dotenv", "--no-deps"],
    "positronic": REQUESTS,
}
POSITRONIC = "positronic-franka==0.12.0"  # PyPI has its sources only, which also bring bindings of libfranka


class NoWheel(Exception):
    """PyPI has no wheel of a client for this machine's Python; the message names it."""


def pip(python: Path, *words: str) -> subprocess.CompletedProcess:
    """Runs pip of an environment."""
    command = [python, "-m", "pip", "--quiet", "--disable-pip-version-check", *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def find_client_python(name: str) -> Path:
    """The interpreter of that environment, which is created if missing. Raises NoWheel."""
    folder = TOP / "out" / "genuine" / name
    python, stamp = folder / "bin" / "python", folder / "installed"
    if not (stamp.exists() and stamp.read_text() == " ".join(PACKAGES[name])):
        subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", folder], check=True, timeout=120)
        result = pip(python, "install", "--only-binary=:all:", *PACKAGES[name])
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


def positronic_sources() -> Path:
    """The folder of positronic_franka's modules, of which `desk` needs no binary."""
    folder = client_python("positronic").parents[1] / "sources"
    modules = folder / POSITRONIC.replace("-", "_").replace("==", "-") / "python" / "positronic_franka"
    if not modules.exists():
        python = client_python("positronic")
        name = POSITRONIC.partition("=")[0]  # its build requirements come as wheels
        words = ["download", "--no-deps", f"--no-binary={name}", f"--dest={folder}", POSITRONIC]
        result = pip(python, *words)
        assert result.returncode == 0, result.stderr
        (archive,) = folder.glob("*.tar.gz")
        shutil.unpack_archive(archive, folder)
    return modules
