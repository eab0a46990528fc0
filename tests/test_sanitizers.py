# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Sanitizers: ThreadSanitizer for data shared by services and loop, all sanitizers for the client."""

import os
import re
import subprocess
from pathlib import Path

import pytest
import ros_nodes

TOP = Path(__file__).resolve().parent.parent
DATA = TOP / "tests" / "data"
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
    assert result.returncode == 0, first_report(result.stdout)


@pytest.mark.long_form("builds libfranka and its tests again")
@pytest.mark.parametrize("sanitizer", ["address,undefined", "thread"])
def test_client_under_sanitizers(sanitizer):
    """libfranka needs no ROS, so all its tests run instrumented."""
    build = TOP / "out" / f"libfranka-{sanitizer.split(',')[0]}"
    source = TOP / "catkin_ws" / "src" / "libfranka"
    flags = f"-O1 -g -fsanitize={sanitizer} -fno-sanitize-recover=undefined"
    run(["cmake", "-S", source, "-B", build, "-DFRANKA_BUILD_TESTS=ON", f"-DCMAKE_CXX_FLAGS={flags}"], 120)
    run(["cmake", "--build", build, "-j2"], 3600)
    programs = sorted(path for path in (build / "test").glob("libfranka_*_test") if path.is_file())
    assert programs
    for program in programs:
        # Without address space randomization: on some kernels its range breaks the sanitizer.
        run(["setarch", "-R", program], 1800)


@pytest.mark.long_form("builds franka_hw and what is below it again")
def test_hardware_interface_under_thread_sanitizer(tmp_path):
    """Loop, setters, switches, lost and new connections."""
    build = TOP / "out" / "franka_hw-thread"
    # Inline functions of boost stay hidden: otherwise Debian's roscpp might lock with our instrumented copies
    # and unlock with its own, and every lock would be reported.
    options = {
        "CATKIN_DEVEL_PREFIX": build / "devel",
        "CATKIN_ENABLE_TESTING": "ON",
        "CATKIN_WHITELIST_PACKAGES": "libfranka;combined_robot_hw;controller_manager;franka_hw",
        "CMAKE_BUILD_TYPE": "None",
        "CMAKE_CXX_FLAGS": "-O1 -g -fsanitize=thread -fvisibility-inlines-hidden",
        "PYTHON_EXECUTABLE": "/usr/bin/python3",
    }
    definitions = [f"-D{name}={value}" for name, value in options.items()]
    run(["cmake", "-S", TOP / "catkin_ws" / "src", "-B", build, *definitions], 300)
    run(["make", "-C", build, "-j2", "franka_hw_robot_test"], 3600)
    with ros_nodes.master(tmp_path) as ros:
        suppressions = DATA / "franka_hw_tsan.supp"
        ros.environment.pop("FRANKA_TEST_LONG", None)  # it takes long enough with the sanitizer
        ros.environment["TSAN_OPTIONS"] = f"suppressions={suppressions} second_deadlock_stack=1"
        # First in the path, because the workspace's libraries are not instrumented.
        libraries = [str(build / "devel" / "lib"), os.environ.get("LD_LIBRARY_PATH", "")]
        ros.environment["LD_LIBRARY_PATH"] = ":".join(libraries)
        program = build / "devel" / "lib" / "franka_hw" / "franka_hw_robot_test"
        # Without tests that count allocations or milliseconds.
        tests = "-Cycle.*:Modes.ControllersRunOnceAMillisecond*"
        result = ros.run("setarch", "-R", str(program), f"--gtest_filter={tests}", timeout=1800)
    assert result.returncode == 0, first_report(result.stderr) + result.stdout[-3000:]
    assert "[  PASSED  ]" in result.stdout


def first_report(said):
    """The first report, from which the others often follow, and the end."""
    report = re.search(r"(WARNING|ERROR): \w+Sanitizer|runtime error:", said)
    return (said[report.start() :][:6000] + "\n...\n" if report else "") + said[-3000:]


def added(name, option):
    """The sanitizer's options of the environment, and this one."""
    return ":".join(filter(None, [os.environ.get(name), option]))


def run(command, seconds):
    environment = {
        **os.environ,
        "PATH": f"/usr/bin:{os.environ['PATH']}",  # ROS is written for Debian's Python
        # The library of decimal_comma.py is loaded before ASan's.
        "ASAN_OPTIONS": added("ASAN_OPTIONS", "verify_asan_link_order=0"),
        "LSAN_OPTIONS": added("LSAN_OPTIONS", f"suppressions={DATA / 'urdfdom_lsan.supp'}"),
    }
    result = subprocess.run(
        [str(word) for word in command],
        env=environment,
        text=True,
        timeout=seconds,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
    )
    assert result.returncode == 0, first_report(result.stdout)
