# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Fixtures of all end-to-end tests."""

import os
import shutil
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
WORKSPACE = TOP / "catkin_ws"


@pytest.fixture(scope="session")
def installed(tmp_path_factory) -> Path:
    """The workspace's packages, installed in a separate prefix."""
    prefix = tmp_path_factory.mktemp("install")
    environment = dict(os.environ, PATH=f"/usr/bin:{os.environ['PATH']}")
    subprocess.run(
        ["cmake", f"-DCMAKE_INSTALL_PREFIX={prefix}", "."],
        cwd=WORKSPACE / "build",
        env=environment,
        check=True,
        capture_output=True,
        timeout=300,
    )
    try:
        result = subprocess.run(
            ["make", "install"],
            cwd=WORKSPACE / "build",
            env=environment,
            text=True,
            capture_output=True,
            timeout=800,
        )
        assert result.returncode == 0, (result.stdout + result.stderr)[-4000:]
    finally:
        subprocess.run(
            ["cmake", f"-DCMAKE_INSTALL_PREFIX={WORKSPACE / 'install'}", "."],
            cwd=WORKSPACE / "build",
            env=environment,
            check=True,
            capture_output=True,
            timeout=300,
        )
    yield prefix
    shutil.rmtree(prefix, ignore_errors=True)
