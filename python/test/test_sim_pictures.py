# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of simulations in this process: cameras, threads, forked processes."""

import gc
import math
import os
import select
import signal
import subprocess
import sys
import threading
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest
from pyfranka.sim import KINDS, Simulation

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True


def test_a_named_camera_sees_distances(name, tmp_path):
    """It looks down on a table from 1 m."""
    world = tmp_path / "camera.xml"
    world.write_text(
        "<mujoco><worldbody><light pos='0 0 3'/><geom type='plane' size='2 2 1' rgba='1 0 0 1'/>"
        "<geom type='box' size='0.1 0.1 0.1' pos='0.2 0 0.1' rgba='0 0 1 1'/>"
        "<camera name='above' pos='0 0 1' fovy='60' user='320 240 10'/></worldbody></mujoco>"
    )
    with Simulation(world, [KINDS[name](base=(0, 5, 0))]) as sim:
        assert sim.cameras() == ["above"]
        picture = sim.render("above", 160, 120)
        assert picture.rgb.shape == (120, 160, 3) and picture.depth.shape == (120, 160)
        assert picture.rgb.dtype == np.uint8 and picture.depth.dtype == np.float32
        assert picture.depth[60, 40] == pytest.approx(1.0, abs=2e-3), "the ground"
        # x = 0.2 m at a distance of 0.8 m: to the right, of 60 pixels for tan(30 deg).
        column = 80 + round(0.2 / 0.8 * 60 / math.tan(math.radians(30)))
        assert picture.depth[60, column] == pytest.approx(0.8, abs=2e-3), "the top of the box"
        red, _, blue = picture.rgb[60, 40].astype(int), None, picture.rgb[60, column].astype(int)
        assert red[0] > red[2] + 30 and blue[2] > blue[0] + 30
        assert sim.render("above", 64, 48).depth.shape == (48, 64), "another size"
        assert sim.render(width=64, height=48).depth is None, "of no camera"


def test_each_thread_may_draw(name):
    """One after the other, of one simulation."""
    with Simulation("stone.xml", [KINDS[name](base=BASE)]) as sim:
        pictures = [sim.render(width=64, height=48).rgb]
        for _ in range(2):
            worker = threading.Thread(target=lambda: pictures.append(sim.render(width=64, height=48).rgb))
            worker.start()
            worker.join()
        pictures.append(sim.render(width=64, height=48).rgb)
    assert len(pictures) == 4 and all((one == pictures[0]).all() for one in pictures)


def test_several_threads_may_draw_several_simulations_at_once(name):
    robots = [KINDS[name](base=BASE)]
    with Simulation("stone.xml", robots) as one, Simulation("stone.xml", robots) as other:
        other.reset(objects={"stone": [0, 0.3, 0.5]})
        alone = [sim.render(width=64, height=48).rgb for sim in (one, other)]
        together = threading.Barrier(2)

        def draw(sim):
            together.wait()
            return [sim.render(width=64, height=48).rgb for _ in range(10)]

        with ThreadPoolExecutor(2) as threads:
            for first, pictures in zip(alone, threads.map(draw, (one, other))):
                assert all((picture == first).all() for picture in pictures)
        assert (alone[0] != alone[1]).any()


def in_a_forked_process(work):
    """Runs it there, as multiprocessing on Linux does; its text, or None if it does not end."""
    read, write = os.pipe()
    child = os.fork()
    if child == 0:
        try:
            os.write(write, work().encode())
        finally:
            os._exit(0)
    os.close(write)
    try:
        ready, _, _ = select.select([read], [], [], 60.0)
        text = os.read(read, 65536).decode() if ready else None
    finally:
        os.close(read)
        if not ready:
            os.kill(child, signal.SIGKILL)
        os.waitpid(child, 0)
    return text


def drawn(sim):
    try:
        return f"drawn: {sim.render(width=64, height=48).rgb.shape}"
    except RuntimeError as error:
        return f"refused: {error}"


def test_a_forked_process_does_not_draw_with_the_driver_of_the_first(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)]) as sim:
        assert drawn(sim) == "drawn: (48, 64, 3)"

        def work():
            with Simulation() as own:
                results = [drawn(sim), drawn(own)]
                own.step(5)
            sim.step(5)
            sim.close()
            gc.collect()
            return "\n".join(results)

        lines = in_a_forked_process(work).splitlines()
        assert len(lines) == 2, "it neither hangs nor crashes"
        assert all("refused: Pictures were drawn before this process was forked" in line for line in lines)
        assert drawn(sim) == "drawn: (48, 64, 3)", "it continues here"


def test_a_process_that_was_forked_after_a_picture_ends_by_itself():
    code = (
        "import os, sys, pyfranka.sim\n"
        "sim = pyfranka.sim.Simulation()\n"
        "sim.render(width=64, height=48)\n"
        "child = os.fork()\n"
        "if child == 0:\n"
        "    sim.step(5)\n"
        "    sys.exit(3)\n"
        "sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n"
    )
    command = [sys.executable, "-W", "ignore::DeprecationWarning", "-c", code]  # Python's own, from 3.12 on
    ended = subprocess.run(command, capture_output=True, text=True, timeout=120)
    assert (ended.returncode, ended.stderr) == (3, "")
