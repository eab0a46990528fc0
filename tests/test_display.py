# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The simulation's window on a virtual screen, and its absence without one."""

import os
import subprocess
import time

import pytest
from franka_sim_mujoco.session import Session
from PIL import Image


@pytest.fixture
def screen(monkeypatch):
    """A virtual screen with software OpenGL; its number is X's own choice."""
    read, write = os.pipe()
    server = subprocess.Popen(
        ["Xvfb", "-displayfd", str(write), "-screen", "0", "1280x960x24"],
        pass_fds=[write],
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
    )
    os.close(write)
    with os.fdopen(read) as answer:
        monkeypatch.setenv("DISPLAY", f":{answer.readline().strip()}")
    monkeypatch.setenv("LIBGL_ALWAYS_SOFTWARE", "1")
    yield
    server.terminate()
    server.wait(10)


def simulation(log, *arguments: str) -> Session:
    return Session("franka_gazebo", "panda.launch", "x:=-0.5", "world:=stone.xml", *arguments, log=log)


def colours_on_screen(path) -> int:
    subprocess.run(["import", "-window", "root", str(path)], check=True, timeout=30)
    with Image.open(path) as picture:
        return len(picture.convert("RGB").getcolors(maxcolors=1 << 20))


def test_window_shows_the_scene(screen, tmp_path):
    with simulation(tmp_path / "launch.log") as session:
        deadline = time.monotonic() + 60
        while colours_on_screen(tmp_path / "screen.png") < 200:
            session.check()
            assert time.monotonic() < deadline, f"the window stayed empty:\n{session.tail()}"
            time.sleep(0.5)


def test_headless_opens_no_window(screen, tmp_path):
    with simulation(tmp_path / "launch.log", "headless:=true") as session:
        session.wait_for_master()
        session.run("rostopic", "echo", "-n1", "/initialized", timeout=60)
        assert colours_on_screen(tmp_path / "screen.png") < 20


def test_without_a_display_the_simulation_says_so_and_runs(monkeypatch, tmp_path):
    monkeypatch.delenv("DISPLAY", raising=False)
    with simulation(tmp_path / "launch.log") as session:
        session.wait_for_master()
        session.run("rostopic", "echo", "-n1", "/initialized", timeout=60)
    # A node writes what it has to say to a file at its end at the latest.
    assert "There is no display" in (tmp_path / "launch.log").read_text()
