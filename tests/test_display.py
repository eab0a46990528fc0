# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The simulation's window on a virtual screen, and its absence without one."""

import math

import numpy as np
import pytest
from franka_sim_mujoco.session import Session
from PIL import Image
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import Panda
from ros_client import in_session, latest
from screen import colors, dragged, move_pointer, press, virtual_screen, window_of
from std_msgs.msg import Bool
from waiting import wait_for

LONG = pytest.mark.long_form("further windows, and one that must not open")
WIDTH, HEIGHT = 1200, 900  # of the window [px]
PATIENCE = 180.0  # [s] for what the window shows, on a busy machine
BORDER, LEAST = 10, 90  # of the panel with texts: within its edge, and a width of it that shows no sky [px]


@pytest.fixture
def screen():
    with virtual_screen():
        yield


def simulation(log, *arguments: str) -> Session:
    return Session("franka_gazebo", "panda.launch", "x:=-0.5", "world:=stone.xml", *arguments, log=log)


def test_window_shows_the_scene(screen, tmp_path):
    with simulation(tmp_path / "launch.log") as session:

        def is_drawn():
            session.check()
            return colors(tmp_path / "screen.png") >= 200

        wait_for(is_drawn, lambda: f"{session.tail()}\nA picture", PATIENCE, 0.5)


@LONG
@pytest.mark.own_process
def test_headless_opens_no_window(screen, tmp_path):
    with in_session(simulation(tmp_path / "launch.log", "headless:=true")):
        latest("/initialized", Bool, PATIENCE)
        assert colors(tmp_path / "screen.png") < 20


@pytest.mark.own_process
def test_without_a_display_the_simulation_warns_and_runs(monkeypatch, tmp_path):
    monkeypatch.delenv("DISPLAY", raising=False)
    with in_session(simulation(tmp_path / "launch.log")):
        latest("/initialized", Bool, PATIENCE)
    # A node flushes its output to a file at its exit at the latest.
    assert "There is no display" in (tmp_path / "launch.log").read_text()


# ---- franka_sim --viewer


class Viewer:
    """The window of franka_sim, and its camera at the start."""

    TARGET, DISTANCE, AZIMUTH, ELEVATION, VIEW = np.array([0, 0, 0.4]), 2.2, 140.0, -20.0, 45.0

    def __init__(self, picture):
        self._picture = picture
        wait_for(lambda: window_of("franka_sim") and colors(picture) > 200, "a picture", PATIENCE)
        move_pointer(WIDTH // 2, HEIGHT // 2)  # keys go to the window below the pointer

    def corner(self, left, top, right, bottom):
        """A part of the window, without what the world draws there: pixels of texts."""
        colors(self._picture)
        with Image.open(self._picture) as picture:
            part = np.asarray(picture.convert("L").crop((left, top, right, bottom)), int)
        return int((part > 200).sum())

    def lines(self):
        """The lines of text in the upper left corner: bright on a dark panel, at least LEAST wide."""
        colors(self._picture)
        with Image.open(self._picture) as picture:
            bright = np.asarray(picture.convert("L").crop((BORDER, BORDER, WIDTH // 2, 100)), int) > 200
        rows = np.flatnonzero(np.diff(np.concatenate([[0], bright[:, :LEAST].any(axis=1), [0]])))
        return [bright[begin:end] for begin, end in rows.reshape(-1, 2) if end - begin > 4]

    def black(self):
        """Black pixels: the caps of the robots' joints, which the simple shapes do not have."""
        colors(self._picture)
        with Image.open(self._picture) as picture:
            return int((np.asarray(picture.convert("L"), int) < 40).sum())

    def pixel(self, point):
        """Where a point of the world is drawn."""
        azimuth, elevation = math.radians(self.AZIMUTH), math.radians(self.ELEVATION)
        ahead = np.array(
            [math.cos(elevation) * math.cos(azimuth), math.cos(elevation) * math.sin(azimuth), 0]
        )
        ahead[2] = math.sin(elevation)
        right = np.cross(ahead, [0, 0, 1])
        right /= np.linalg.norm(right)
        way = np.asarray(point) - (self.TARGET - self.DISTANCE * ahead)
        scale = HEIGHT / (2 * math.tan(math.radians(self.VIEW) / 2) * (way @ ahead))
        return round(WIDTH / 2 + scale * (way @ right)), round(
            HEIGHT / 2 - scale * (way @ np.cross(right, ahead))
        )


def test_the_viewer_shows_texts_and_pushes_by_mouse(screen, franka_sim, tmp_path):
    sim = franka_sim("panda", base=(-0.5, 0, 0), world="stone.xml", pace="realtime", arguments=["--viewer"])
    viewer, remote = Viewer(tmp_path / "window.png"), sim.robot.remote
    help_corner = (0, HEIGHT - 320, 460, HEIGHT)
    texts, without_help = viewer.corner(0, 0, 500, 80), viewer.corner(*help_corner)
    assert texts > 100  # time, mode
    assert viewer.black() > 500  # about 930; 220 without meshes
    press("h")
    wait_for(lambda: viewer.corner(*help_corner) > without_help + 1000, "the help", PATIENCE)
    press("h")
    wait_for(lambda: viewer.corner(*help_corner) < without_help + 300, "no help", PATIENCE)
    remote.set_user_stop(True)
    wait_for(lambda: viewer.corner(0, 0, 500, 80) > texts + 50, "a longer text about the mode", PATIENCE)
    stone = np.array(remote.body_position("stone")[:3])
    x, y = viewer.pixel(stone)
    assert viewer.corner(WIDTH - 300, 0, WIDTH, 40) < 50
    with dragged(x, y, x + 250, y - 300, hold="Control_L"):
        wait_for(lambda: np.linalg.norm(remote.body_position("stone")[:3] - stone) > 0.05, "a push", PATIENCE)
        wait_for(lambda: viewer.corner(WIDTH - 300, 0, WIDTH, 40) > 50, "the force", PATIENCE)
    wait_for(lambda: viewer.corner(WIDTH - 300, 0, WIDTH, 40) < 50, "no force", PATIENCE)
    assert not sim.stopped


NAME = 70  # pixels of a text that are compared: about ten letters


def stands_in(name: np.ndarray, line: np.ndarray) -> bool:
    """Whether the letters of a line begin with those of a name somewhere."""
    height = min(len(name), len(line))
    for top in (0, len(line) - height):
        for left in range(line.shape[1] - name.shape[1]):
            if np.array_equal(line[top : top + height, left : left + name.shape[1]], name[:height]):
                return True
    return False


@LONG
def test_the_viewer_names_the_errors(screen, tmp_path):
    """The name of a second robot is that of the error, so that the letters to look for are on the screen."""
    other = Panda(name="joint_reflex", base=(0, 2.0, 0))
    robots = (Panda(base=(-0.5, 0, 0)), other)
    with FrankaSim(*robots, pace="realtime", viewer=True) as sim:
        viewer, remote = Viewer(tmp_path / "window.png"), sim.robots[0].remote
        wait_for(lambda: len(viewer.lines()) >= 3, "the lines of both robots", PATIENCE)
        text = viewer.lines()[2]
        first = np.flatnonzero(text.any(axis=0))[0]
        name = text[:, first : first + NAME]
        assert not stands_in(name, viewer.lines()[1])
        remote.push("panda_link4", (0, 400, 0), ticks=50)
        assert "joint_reflex" in remote.wait(lambda now: now.mode == "Reflex").errors
        wait_for(lambda: stands_in(name, viewer.lines()[1]), "the error's name", PATIENCE)
