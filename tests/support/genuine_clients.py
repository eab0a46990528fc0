# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Other people's client libraries, from PyPI, each in an environment of its own (decision 33), which has the
packages of a lock: locks/panda.txt and so on."""

import shutil
import subprocess
import sys
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]
LOCKS = TOP / "locks"


class NoWheel(Exception):
    """PyPI has no wheel of a client for this machine's Python; the message names it."""


def pip(python: Path, *words: str) -> subprocess.CompletedProcess:
    """Runs pip of an environment."""
    command = [python, "-m", "pip", "--quiet", "--disable-pip-version-check", *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=600)


def locked(name: str, folder: Path = LOCKS) -> list[str]:
    """Words of pip for the packages of a lock, which has those that they require, too."""
    return ["--no-deps", "--require-hashes", f"--requirement={folder / name}.txt"]


def find_client_python(name: str) -> Path:
    """The interpreter of that environment, which is created if missing. Raises NoWheel."""
    folder, lock = TOP / "out" / "genuine" / name, LOCKS / f"{name}.txt"
    python, stamp = folder / "bin" / "python", folder / "installed"
    if not (stamp.exists() and stamp.read_text() == lock.read_text()):
        subprocess.run(["/usr/bin/python3", "-m", "venv", "--clear", folder], check=True, timeout=120)
        result = pip(python, "install", "--only-binary=:all:", *locked(name))
        # Without a network pip first retries, and then prints the same.
        if "No matching distribution found" in result.stderr and "Retrying" not in result.stderr:
            version = subprocess.check_output([python, "--version"], text=True).strip()
            raise NoWheel(f"PyPI has no wheel of a package in locks/{name}.txt for {version}")
        assert result.returncode == 0, result.stderr
        stamp.write_text(lock.read_text())
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
    if not folder.exists():
        # pip reads the sources' metadata by scikit-build-core, which .venv has.
        words = ["--no-build-isolation", "--no-binary=:all:", f"--dest={folder}"]
        result = pip(Path(sys.executable), "download", *words, *locked("positronic_sources"))
        assert result.returncode == 0, result.stderr
        (archive,) = folder.glob("*.tar.gz")
        shutil.unpack_archive(archive, folder)
    (modules,) = folder.glob("positronic_franka-*/python/positronic_franka")
    return modules
