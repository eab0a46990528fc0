# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The simulation's window on a virtual screen, and its absence without one."""

import time

import pytest
from franka_sim_mujoco.session import Session
from screen import colours, virtual_screen


@pytest.fixture
def screen():
    with virtual_screen():
        yield


def simulation(log, *arguments: str) -> Session:
    return Session("franka_gazebo", "panda.launch", "x:=-0.5", "world:=stone.xml", *arguments, log=log)


def test_window_shows_the_scene(screen, tmp_path):
    with simulation(tmp_path / "launch.log") as session:
        deadline = time.monotonic() + 180
        while colours(tmp_path / "screen.png") < 200:
            session.check()
            assert time.monotonic() < deadline, f"the window stayed empty:\n{session.tail()}"
            time.sleep(0.5)


def test_headless_opens_no_window(screen, tmp_path):
    with simulation(tmp_path / "launch.log", "headless:=true") as session:
        session.wait_for_master()
        session.run("rostopic", "echo", "-n1", "/initialized", timeout=60)
        assert colours(tmp_path / "screen.png") < 20


def test_without_a_display_the_simulation_warns_and_runs(monkeypatch, tmp_path):
    monkeypatch.delenv("DISPLAY", raising=False)
    with simulation(tmp_path / "launch.log") as session:
        session.wait_for_master()
        session.run("rostopic", "echo", "-n1", "/initialized", timeout=60)
    # A node flushes its output to a file at its exit at the latest.
    assert "There is no display" in (tmp_path / "launch.log").read_text()
