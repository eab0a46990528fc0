# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.Gripper against simulated hands."""

import threading
import time

import pyfranka
import pytest


def test_the_hand_and_threads_that_run_while_it_moves(robots, addresses, name):
    hand = pyfranka.Gripper(addresses[name])
    assert hand.server_version == 3
    assert hand.move(0.07, 0.1)
    state = hand.read_once()
    assert state.width == pytest.approx(0.07, abs=1e-3)
    assert state.max_width == pytest.approx(0.08)
    assert not state.is_grasped and state.temperature > 0 and state.time > 0

    times, moved = [], threading.Event()

    def run_beside():
        while not moved.is_set():
            times.append(time.monotonic())
            time.sleep(1e-3)

    thread = threading.Thread(target=run_beside)
    thread.start()
    try:
        begin = time.monotonic()
        assert hand.move(0.05, 0.001)  # 20 s of the robot's time, which lock-step makes short
        end = time.monotonic()
    finally:
        moved.set()
        thread.join()
    # If the motion held the interpreter's lock, the other thread would stand still.
    quarter = (end - begin) / 4
    assert [t for t in times if begin + quarter < t < end - quarter]
    assert not hand.grasp(0.02, 0.1, 20.0)  # nothing there
    with pytest.raises(pyfranka.CommandException):
        hand.move(0.5, 0.1)


def test_hand_states_arrive_at_30_hz(robots, addresses, name):
    hand = pyfranka.Gripper(addresses[name])
    hand.read_once()
    begin = time.monotonic()
    for _ in range(30):
        hand.read_once()
    # Not earlier; a busy machine may be late.
    assert 0.9 < time.monotonic() - begin < 3.0


def test_a_hand_is_stopped_from_another_thread(robots, addresses, name):
    hand = pyfranka.Gripper(addresses[name])
    hand.move(0.08, 0.1)
    ended = threading.Event()

    # In lock-step a homing may take less than 0.1 s, or start later than that.
    def stop_until_it_ended():
        while not ended.wait(0.005):
            hand.stop()

    stopper = threading.Thread(target=stop_until_it_ended)
    stopper.start()
    try:
        with pytest.raises(pyfranka.CommandException):
            hand.homing()
    finally:
        ended.set()
        stopper.join(20)
