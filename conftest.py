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
pytest_plugins = ["pyfranka.pytest_plugin", "own_process"]  # the wheel's entry point names the first

SHARED = ("tests", "tests/support", "docs/site")
sys.path[:0] = [str(TOP / folder) for folder in SHARED]
# Behind the environment's package of that name, which also has its messages.
sys.path.append(str(TOP / "catkin_ws/src/franka_sim_mujoco/src"))

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


def pytest_configure(config):
    config.addinivalue_line("markers", "long_form(reason): run in the long form only")
    config.addinivalue_line("markers", "realtime(reason): its subject is the wall clock")


def is_long(config) -> bool:
    return config.getoption("--long") or os.environ.get("FRANKA_TEST_LONG") == "1"


@pytest.hookimpl(tryfirst=True)
def pytest_collection_modifyitems(config, items):
    long, realtime = is_long(config), os.environ.get("FRANKA_TEST_REALTIME") == "1"
    if realtime and not long:
        items[:] = [item for item in items if item.get_closest_marker("realtime")]
    for item in items:
        for name, form, wanted in (("long_form", "long", long), ("realtime", "realtime", long or realtime)):
            if (mark := item.get_closest_marker(name)) and not wanted:
                item.add_marker(pytest.mark.skip(reason=f"{mark.args[0]}: ./franka test --{form}"))


@pytest.fixture(scope="session")
def long_run(request) -> bool:
    """Whether the long forms are requested."""
    return is_long(request.config)
