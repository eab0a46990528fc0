# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A simulation that is launched paused, for longer than the 30 s after which spawners give up by default."""

import os
import re

import pytest
from ros_client import Controllers, call, launched
from std_srvs.srv import Empty
from waiting import wait_for

START = 120.0  # [s] on a busy machine
CONTROLLERS = ("franka_state_controller", "cartesian_impedance_example_controller")
# For the spawners only, time passes so many times faster. Python imports a module of this name at its start.
FASTER = 30
FAST_CLOCK = f"""
import time
with open("/proc/self/cmdline", "rb") as file:
    words = file.read().split(b"\\0")
if any(word.endswith(b"/controller_manager/spawner") for word in words):
    real, begin = time.monotonic, time.monotonic()
    time.monotonic = lambda: begin + {FASTER} * (real() - begin)
"""


@pytest.fixture
def paused(tmp_path, monkeypatch):
    (tmp_path / "sitecustomize.py").write_text(FAST_CLOCK)
    monkeypatch.setenv("PYTHONPATH", f"{tmp_path}:{os.environ.get('PYTHONPATH', '')}")
    launch = ["franka_gazebo", "panda.launch", "paused:=true", f"controller:={CONTROLLERS[1]}"]
    options = ["interactive_marker:=false", "headless:=true"]
    with launched(*launch, *options, log=tmp_path / "launch.log", disable_rostime=True) as session:
        yield session


@pytest.mark.own_process
def test_a_launch_that_stays_paused_starts_its_controllers_when_it_runs(paused):
    def longest_wait() -> float:
        reported = re.findall(r"after (\d+) s, /initialized has only sent false", paused.log.read_text())
        return max(map(float, reported), default=0.0)

    wait_for(lambda: longest_wait() > 60.0, "A report after a minute of the spawner's time", START)
    call("/gazebo/unpause_physics", Empty)
    Controllers().wait_for(*CONTROLLERS)
    assert "couldn't find" not in paused.log.read_text()
