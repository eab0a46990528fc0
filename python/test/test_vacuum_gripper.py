# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.VacuumGripper with the simulated one."""

import threading
from datetime import timedelta

import pyfranka
import pytest
from pyfranka.sim import Panda
from waiting import wait_for

Status = pyfranka.VacuumGripperDeviceStatus


@pytest.fixture
def robot(franka_sim):
    return franka_sim(Panda(hand="vacuum"), pace="realtime").robot


def test_a_part_is_held_and_dropped(robot):
    gripper = pyfranka.VacuumGripper(robot.address)
    assert gripper.server_version == 1
    robot.remote.part(True)
    assert gripper.vacuum(50, timedelta(seconds=10), pyfranka.VacuumGripper.ProductionSetupProfile.P2)
    state = gripper.read_once()
    assert (state.in_control_range, state.part_detached, state.part_present) == (True, False, True)
    assert 500 <= state.vacuum <= 510, "[mbar], of 50 times 10"
    assert state.time > 0.0 and state.device_status == Status.Green
    assert gripper.drop_off(timedelta(seconds=10))
    wait_for(lambda: not gripper.read_once().part_present, "the drop")
    robot.remote.pump("orange")
    wait_for(lambda: gripper.read_once().device_status == Status.Orange, "the warning of the pump")


def test_failures_are_reported(robot):
    gripper = pyfranka.VacuumGripper(robot.address)
    begin = robot.remote.time
    assert not gripper.vacuum(50, timedelta(seconds=0.5)), "there is no part"
    assert 0.5 <= robot.remote.time - begin < 100.0, "in the robot's time"
    robot.remote.pump("red")
    with pytest.raises(pyfranka.CommandException, match="libfranka vacuum gripper: "):
        gripper.vacuum(50, timedelta(seconds=1))


def test_stop_from_another_thread(robot):
    """If a command held the interpreter's lock, the other thread would stand still."""
    gripper = pyfranka.VacuumGripper(robot.address)
    ended = threading.Event()

    def stop_until_it_ended():  # the first stop may come before the command
        while not ended.wait(0.005):
            gripper.stop()

    stopper = threading.Thread(target=stop_until_it_ended)
    stopper.start()
    try:
        with pytest.raises(pyfranka.CommandException, match="aborted"):
            gripper.vacuum(50, timedelta(hours=1))
    finally:
        ended.set()
        stopper.join(60)
