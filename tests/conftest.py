# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of all end-to-end tests."""

import fcntl
import os
import re
import secrets
import subprocess
import sys
import time
from contextlib import suppress
from functools import partial
from pathlib import Path

import pytest
from page_output import Example, examples

TOP = Path(__file__).resolve().parent.parent
WORKSPACE = TOP / "catkin_ws"


@pytest.fixture
def desk_client(tmp_path):
    """Starts a robot with its Desk and one genuine client: see desk_and_client()."""
    from desk_clients import desk_and_client

    return partial(desk_and_client, tmp_path)


@pytest.fixture(scope="session")
def installed() -> Path:
    """The workspace's install space. The build keeps its configuration, which other tests read meanwhile."""
    prefix = WORKSPACE / "install"
    install = f"rm -rf {prefix} && cmake --build {WORKSPACE / 'build'} --target install"
    make_once("installed", ["bash", "-c", install], 900)
    return prefix


def last_change() -> float:
    """When a file was last changed that git has, or would have if it were added [s]."""
    listing = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    files = subprocess.run(listing, cwd=TOP, text=True, capture_output=True, check=True)
    paths = (TOP / name for name in files.stdout.split("\0") if name)
    return max(path.stat().st_mtime for path in paths if path.exists())


def make_once(name: str, command: list[str | Path], timeout: float) -> None:
    """Runs a command unless that was done after the last change of a file. Each file of tests has its own
    process; the first one runs the command, the others wait for it and find its results."""
    made = TOP / "out" / f"{name}.made"
    made.parent.mkdir(exist_ok=True)
    with open(made.with_suffix(".lock"), "w", encoding="utf-8") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        if made.exists() and made.stat().st_mtime > last_change():
            return
        begin = time.time()
        environment = {**os.environ, "PATH": f"/usr/bin:{os.environ['PATH']}"}
        options = {"text": True, "capture_output": True, "timeout": timeout, "env": environment}
        result = subprocess.run(command, **options)
        assert result.returncode == 0, (result.stdout + result.stderr)[-6000:]
        made.touch()
        os.utime(made, (begin, begin))


@pytest.fixture(scope="session")
def wheel() -> Path:
    """The wheel of pyfranka."""
    result = subprocess.run([TOP / "franka", "wheel"], text=True, capture_output=True, timeout=3000)
    assert result.returncode == 0, result.stdout[-3000:] + result.stderr[-3000:]
    return Path(re.search(r"The wheel: (\S+)", result.stdout).group(1))


@pytest.fixture(scope="session")
def quick_start() -> Example:
    """The first program of the page about Python."""
    return examples("python.md")[0]


@pytest.fixture(scope="session")
def repository(long_run) -> Path:
    """The Debian packages of this release, built and checked by lintian. Tests that use it are long forms."""
    assert long_run, "Only a test with the mark `long_form` may use the Debian packages."
    make_once("deb", [TOP / "franka", "deb"], 7200)
    return TOP / "dist" / "deb"


@pytest.fixture(scope="session")
def site() -> Path:
    """The documentation site's pages, built without a warning."""
    make_once("docs", [sys.executable, TOP / "docs" / "site" / "build_site.py"], 900)
    return TOP / "out" / "docs" / "html"


@pytest.fixture
def leaves_no_process(monkeypatch):
    """No process that the test has started remains: all inherit a variable."""
    mark = f"MARK={secrets.token_hex(8)}"
    monkeypatch.setenv(*mark.split("="))
    yield
    left = []
    for folder in Path("/proc").glob("[0-9]*"):
        with suppress(OSError):
            if os.fsencode(mark) in (folder / "environ").read_bytes().split(b"\0"):
                left.append((folder / "comm").read_text())
    assert left == []
