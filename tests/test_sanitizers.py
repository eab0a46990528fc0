# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sanitizers: threads on the controller manager's hand-over between services and loop, all on the client."""

import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parent.parent
SCRIPT = TOP / "catkin_ws" / "src" / "ros_control" / "controller_manager" / "test" / "tsan.sh"


def test_controller_manager_under_thread_sanitizer(long_run):
    operations = "100000" if long_run else "10000"
    build = TOP / "out" / "tsan"
    result = subprocess.run(
        [str(SCRIPT), str(build), operations],
        text=True,
        timeout=850,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert result.returncode == 0, result.stdout[-6000:]


@pytest.mark.parametrize("sanitizer", ["address,undefined", "thread"])
def test_client_under_sanitizers(long_run, sanitizer):
    """libfranka needs no ROS, so all of its tests run instrumented (a build of its own: long form only)."""
    if not long_run:
        pytest.skip("builds libfranka and its tests anew: ./franka test --long")
    build = TOP / "out" / f"libfranka-{sanitizer.split(',')[0]}"
    source = TOP / "catkin_ws" / "src" / "libfranka"
    flags = f"-O1 -g -fsanitize={sanitizer} -fno-sanitize-recover=undefined"
    run(["cmake", "-S", source, "-B", build, "-DFRANKA_BUILD_TESTS=ON", f"-DCMAKE_CXX_FLAGS={flags}"], 120)
    run(["cmake", "--build", build, "-j2"], 3600)
    programs = sorted(path for path in (build / "test").glob("libfranka_*_test") if path.is_file())
    assert programs
    for program in programs:
        # Without address space randomisation, which some kernels stretch beyond what the sanitizer knows.
        run(["setarch", "-R", program], 1800)


def run(command, seconds):
    result = subprocess.run(
        [str(word) for word in command],
        text=True,
        timeout=seconds,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert result.returncode == 0, result.stdout[-6000:]
