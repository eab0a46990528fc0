#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Makes the pictures of Desk's page in docs/pictures.

./franka shell .venv/bin/python3 tests/support/desk_pictures.py
"""

import math
import sys
import threading
from pathlib import Path

import pyfranka
from page_browser import PASSWORD, Browser, browser, wait_for
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import FR3, Panda

PICTURES = Path(__file__).resolve().parents[2] / "docs" / "pictures"
PHONE, DESKTOP = (390, 844), (1440, 900)
DESK = {"desk": "127.0.0.1:0", "desk_password": PASSWORD}
COLORS = 256  # of a picture, for a small file


def save(page: Browser, name: str) -> None:
    picture = page.picture().quantize(COLORS)
    picture.save(PICTURES / name, optimize=True)
    print(PICTURES / name)


def all_meshes(page: Browser) -> None:
    """Waits until the robots have their meshes."""
    script = (
        "performance.getEntriesByType('resource').filter((each) => each.name.includes('robot-mesh')).length"
    )
    count = wait_for(lambda: page.run(script), "the first mesh")
    while True:
        page.run("new Promise((done) => setTimeout(done, 4000))")
        if page.run(script) == count:
            return
        count = page.run(script)


def enter(page: Browser, sim: FrankaSim) -> None:
    page.open(sim.robot.desk)
    page.log_in()
    page.wait_for_view()
    all_meshes(page)


def prepare(page: Browser, robot: int = 0) -> None:
    """Takes control, unlocks and activates the FCI."""
    page.click("Take control", robot)
    page.click("Unlock", robot)
    wait_for(lambda: not any(page.report(robot)["brakes"]), "the joints are unlocked")
    page.click("FCI active", robot)
    page.click("Activate")
    wait_for(lambda: page.report(robot)["fci"], "the FCI is active")
    page.run("document.querySelectorAll('.message').forEach((each) => each.remove())")


class Swing(threading.Thread):
    """A client that swings three joints until a request to end."""

    def __init__(self, robot: pyfranka.Robot):
        super().__init__(daemon=True)
        self.robot, self.ending, self.elapsed = robot, False, 0.0
        self.start()

    def run(self) -> None:
        start: list[float] = []

        def step(state, period):
            self.elapsed += period.to_sec()
            start[:] = start or list(state.q_d)
            swing = 0.25 * (1 - math.cos(2 * math.pi * self.elapsed / 6.0))
            moved = [0.6, 0.5, 0, 0.6, 0, 0, 0]
            target = pyfranka.JointPositions([q + share * swing for q, share in zip(start, moved)])
            target.motion_finished = self.ending and swing < 1e-6
            return target

        self.robot.control_joint_positions(step)


def one_robot() -> None:
    panda = Panda(base=(-0.5, 0, 0))
    with FrankaSim(panda, world="stone.xml", pace="patient", **DESK) as sim:
        with browser(width=DESKTOP[0], height=DESKTOP[1]) as page:
            page.prefer("light")
            enter(page, sim)
            prepare(page)
            swing = Swing(sim.robot.connect())
            wait_for(lambda: swing.elapsed > 12.0, "the plots have something to show", limit=100.0)
            page.run("scrollTo(0, 0)")
            save(page, "desk.png")
            swing.ending = True
            page.prefer("dark")
            page.resize(*PHONE)
            page.run("new Promise((done) => setTimeout(done, 3000))")
            page.run("desk.panels.get(0).view.resetCamera()")
            page.run("new Promise((done) => setTimeout(done, 3000))")
            save(page, "desk_phone.png")


def two_robots() -> None:
    robots = (Panda(), FR3(base=(0, 1.0, 0)))
    with FrankaSim(*robots, pace="patient", **DESK) as sim:
        with browser(width=DESKTOP[0], height=DESKTOP[1]) as page:
            page.prefer("dark")
            enter(page, sim)
            prepare(page, 0)
            page.run("scrollTo(0, 0)")
            place = page.place("panda_link7")
            page.drag(place, (40, -10), lambda: save(page, "desk_two_robots.png"))


if __name__ == "__main__":
    sys.dont_write_bytecode = True
    one_robot()
    two_robots()
