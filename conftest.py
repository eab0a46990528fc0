# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Options and fixtures of every pytest run of the project."""

import os
import signal
import sys
from contextlib import suppress
from pathlib import Path

import pytest

TOP = Path(__file__).parent
pytest_plugins = ["pyfranka.pytest_plugin"]  # which the wheel's entry point names

SHARED = ("tests", "tests/support", "catkin_ws/src/franka_sim_mujoco/src")
sys.path[:0] = [str(TOP / folder) for folder in SHARED]

# A shell's background jobs ignore Ctrl-C, and so would the programs that tests start and interrupt.
if signal.getsignal(signal.SIGINT) is signal.SIG_IGN:
    signal.signal(signal.SIGINT, signal.default_int_handler)


@pytest.hookimpl(tryfirst=True)
def pytest_runtest_setup():
    """A client that has moved a robot leaves its thread the priority of real time. Programs that later tests
    start would inherit it, and keep the processors from each other."""
    with suppress(PermissionError):
        os.sched_setscheduler(0, os.SCHED_OTHER, os.sched_param(0))


def pytest_addoption(parser):
    parser.addoption("--long", action="store_true", help="the long forms of soaks and sweeps")


@pytest.fixture(scope="session")
def long_run(request) -> bool:
    """Whether the long forms were asked for."""
    return request.config.getoption("--long") or os.environ.get("FRANKA_TEST_LONG") == "1"
