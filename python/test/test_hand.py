# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.Gripper against simulated hands."""

import threading
import time

import pyfranka
import pytest


def test_a_hand_moves_and_reports_its_state(robots, addresses, name):
    hand = pyfranka.Gripper(addresses[name])
    assert hand.server_version == 3
    assert hand.move(0.07, 0.1)
    state = hand.read_once()
    assert state.width == pytest.approx(0.07, abs=1e-3)
    assert state.max_width == pytest.approx(0.08)
    assert repr(state).startswith("<GripperState: width 0.07")
    assert repr(hand) == "<Gripper: a connection, protocol version 3>"
    assert not state.is_grasped and state.temperature > 0 and state.time > 0
    assert not hand.grasp(0.02, 0.1, 20.0)  # nothing there
    with pytest.raises(pyfranka.CommandException):
        hand.move(0.5, 0.1)


@pytest.mark.realtime("the rate of a hand's states")
def test_hand_states_arrive_at_30_hz(robots, addresses, name):
    hand = pyfranka.Gripper(addresses[name])
    hand.read_once()
    begin = time.monotonic()
    for _ in range(30):
        hand.read_once()
    assert 0.9 < time.monotonic() - begin < 3.0


def test_a_hand_is_stopped_from_another_thread(robots, addresses, name):
    """If a motion held the interpreter's lock, the other thread would stand still."""
    hand = pyfranka.Gripper(addresses[name])
    hand.move(0.08, 0.1)
    ended = threading.Event()

    def stop_until_it_ended():  # the first stop may come before the motion
        while not ended.wait(0.005):
            hand.stop()

    stopper = threading.Thread(target=stop_until_it_ended)
    stopper.start()
    try:
        with pytest.raises(pyfranka.CommandException):
            hand.move(0.0, 1e-4)  # 800 s of the robot's time
    finally:
        ended.set()
        stopper.join(60)
