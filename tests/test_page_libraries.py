# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The installer of the JavaScript libraries of Desk's page, without a network."""

import subprocess
import sys
from pathlib import Path

SCRIPT = Path(__file__).resolve().parent.parent / "python" / "scripts" / "install_page_libraries"


def install(folder, *options):
    command = [sys.executable, SCRIPT, "--folder", folder / "vendor", "--archives", folder, *options]
    return subprocess.run(command, text=True, capture_output=True, timeout=60)


def installed(folder):
    return [path for path in (folder / "vendor").rglob("*") if path.is_file()]


def test_a_damaged_package_is_refused(tmp_path):
    (tmp_path / "three-0.187.0.tgz").write_bytes(b"not what was published")
    result = install(tmp_path)
    assert (
        result.returncode == 0
        and "has sha512" in result.stderr
        and "nothing is taken from it" in result.stderr
    )
    assert installed(tmp_path) == []


def test_a_missing_package_is_an_error_only_if_it_is_required(tmp_path):
    assert install(tmp_path).returncode == 0
    result = install(tmp_path, "--required")
    assert result.returncode == 1 and "three-0.187.0.tgz is not in" in result.stderr
    assert installed(tmp_path) == []


def test_libraries_in_place_are_left_alone():
    result = subprocess.run([sys.executable, SCRIPT], text=True, capture_output=True, timeout=300)
    assert result.returncode == 0 and "are in place" in result.stdout, result
