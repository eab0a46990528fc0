# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Simulation.serve: a program owns the world while clients on the network drive its robots."""

import os
import signal
import threading
import time

import contact_motion
import numpy as np
import pyfranka
import pytest
from contact_motion import SCENE, press
from fci_session import simulated
from pyfranka.sim import FR3, KINDS, Panda, RequestRefused, Simulation, SimulationBatch
from waiting import wait_for

ADDRESSES = {"panda": "127.0.33.11", "fr3": "127.0.33.12"}
ROBOTS_TAKE_TURNS = True
PAUSE = 0.3  # [s] of a program that computes: clients are then sent the last state again
TORQUES = np.array([0.5, -1.0, 0.3, 0.8, 0.1, -0.2, 0.05])  # [Nm]


@pytest.fixture
def sim(name):
    with Simulation(robots=[KINDS[name]()]) as simulation:
        simulation.serve(ADDRESSES[name])
        yield simulation


class Stepping:
    """Steps a simulation in another thread, until the end of a block."""

    def __init__(self, sim):
        self._sim, self._end, self._error = sim, threading.Event(), None
        self._thread = threading.Thread(target=self._run)

    def _run(self):
        try:
            while not self._end.is_set():
                self._sim.step()
        except RuntimeError as error:
            self._error = error

    def __enter__(self):
        self._thread.start()
        return self

    def __exit__(self, *error):
        self._end.set()
        self._thread.join()
        assert self._error is None, self._error


def connect(name):
    return pyfranka.Robot(ADDRESSES[name], pyfranka.RealtimeConfig.Ignore)


def move_joint(robot, joint, way, seconds):
    """A client's motion."""
    first, passed = robot.read_once().q_d.copy(), 0.0

    def positions(state, period):
        nonlocal passed
        passed += period
        q = first.copy()
        q[joint] += 0.5 * way * (1 - np.cos(np.pi * min(passed / seconds, 1.0)))
        target = pyfranka.JointPositions(q)
        return pyfranka.motion_finished(target) if passed >= seconds else target

    robot.control_joint_positions(positions)


def begin_motion(sim, name, client, way, seconds):
    """Steps until the client moves joint 7 in a thread; returns that and the errors that will end it."""
    errors = []

    def move():
        try:
            move_joint(client, 6, way, seconds)
        except pyfranka.Exception as error:
            errors.append(error)

    thread = threading.Thread(target=move)
    thread.start()

    def moves():
        sim.step()
        return sim[name].state.robot_mode == pyfranka.RobotMode.Move

    wait_for(moves, lambda: f"The motion ({errors})", pause=0.0)
    return thread, errors


def test_a_client_drives_a_robot_of_the_program_with_the_bits_of_a_served_one(name):
    with simulated(name, "lockstep", **SCENE) as served:
        press(served.address, served.protocol)
        expected = served.remote.state_hash()
        protocol = served.protocol
    with Simulation(contact_motion.WORLD, [KINDS[name](base=contact_motion.BASE)]) as sim:
        robot = sim[name]
        sim.serve(ADDRESSES[name])
        client = threading.Thread(target=press, args=(ADDRESSES[name], protocol))
        client.start()
        wait_for(lambda: robot.state.robot_mode == pyfranka.RobotMode.Move)  # no tick before the motion
        pressed = 0.0
        while robot.state.robot_mode == pyfranka.RobotMode.Move:
            sim.step()
            pressed = max(pressed, abs(robot.state.tau_ext_hat_filtered[1]))
            if sim.ticks % 2000 == 0:
                time.sleep(PAUSE)  # the fault itself
        assert pressed > 10.0, "the hand touches the table"
        hashes = set()
        for _ in range(2000):  # a served world runs on until it rests
            hashes.add(robot.state_hash())
            sim.step()
        client.join()
        assert expected in hashes


def test_program_and_client_take_turns(sim, name):
    arm = sim[name]
    with Stepping(sim):
        client = connect(name)
        before = client.read_once().q.copy()
        move_joint(client, 6, 0.2, 1.0)
        assert client.read_once().q[6] == pytest.approx(before[6] + 0.2, abs=1e-3)
    arm.joint_impedance(arm.state.q + [0.1, 0, 0, 0, 0, 0, 0], duration=0.3)
    sim.step(600)
    with Stepping(sim), pytest.raises(pyfranka.Exception):
        move_joint(client, 6, 0.1, 1.0)
    assert arm.moving, "the program's motion goes on"
    arm.finish()
    sim.step(500)
    assert not arm.moving
    with Stepping(sim):
        move_joint(client, 6, -0.2, 1.0)
    assert arm.state.q[0] == pytest.approx(before[0] + 0.1, abs=2e-2)
    assert arm.state.q[6] == pytest.approx(before[6], abs=1e-3)


def test_the_program_is_refused_while_a_client_moves_the_robot(sim, name):
    arm = sim[name]
    client = connect(name)
    moving, errors = begin_motion(sim, name, client, way=0.2, seconds=1.0)
    sim.step(100)
    with pytest.raises(RequestRefused, match="in mode Move"):
        arm.command(torque=TORQUES)
    while moving.is_alive():
        sim.step()
    assert not errors and not arm.state.current_errors


def test_a_client_stays_connected_while_the_program_does_other_work(sim, name):
    client = connect(name)  # the simulation is not stepped
    client.set_load(0.1, [0, 0, 0], np.zeros(9))
    assert client.read_once().m_load == pytest.approx(0.1)
    assert sim[name].state.m_load == pytest.approx(0.1) and sim.ticks == 0
    moving, errors = begin_motion(sim, name, client, way=0.2, seconds=1.0)
    sim.step(50)
    time.sleep(2.5)  # longer than a client waits for a state: the fault itself
    while moving.is_alive():
        sim.step()
    assert not errors


def test_ctrl_c_ends_the_wait_for_a_client_that_may_think_for_ever(name):
    with Simulation(robots=[KINDS[name]()]) as sim:
        sim.serve(ADDRESSES[name], patience="forever")
        client, silent, go_on, errors = connect(name), threading.Event(), threading.Event(), []
        passed = longest = 0.0

        def hold(state, period):
            nonlocal passed, longest
            passed += period
            longest = max(longest, period)
            if 0.1 < passed < 0.2:
                silent.set()
                go_on.wait(600)
            torques = pyfranka.Torques([0.0] * 7)
            return pyfranka.motion_finished(torques) if passed > 0.3 else torques

        def move():
            try:
                client.control_torques(hold)
            except pyfranka.Exception as error:
                errors.append(error)

        def interrupt():
            silent.wait(60)
            time.sleep(0.3)  # until the program waits: the fault itself
            os.kill(os.getpid(), signal.SIGINT)

        threads = [threading.Thread(target=target) for target in (move, interrupt)]
        for thread in threads:
            thread.start()
        with pytest.raises(KeyboardInterrupt):
            sim.step(100000)
        go_on.set()
        while threads[0].is_alive():
            sim.step()
        threads[1].join()
        assert not errors and passed > 0.3, errors
        assert longest < 0.01, "all other ticks have waited for the client"


def test_reason_of_a_refused_client_is_reported(sim, name, caplog):
    client = connect(name)
    with pytest.raises(pyfranka.NetworkException):
        connect(name)
    place = f"{name} at {ADDRESSES[name]}: "
    wait_for(lambda: any(text.startswith(place) and "127.0.0.1" in text for text in caplog.messages))
    del client


def test_a_reset_answers_the_client_whose_motion_it_ends(sim, name):
    client = connect(name)
    moving, ended = begin_motion(sim, name, client, way=0.5, seconds=100.0)
    sim.step(200)
    sim.reset()
    with Stepping(sim):
        moving.join(60)
    assert ended and sim[name].state.robot_mode == pyfranka.RobotMode.Idle
    with Stepping(sim):
        move_joint(client, 6, 0.1, 1.0)


def test_two_robots_of_one_world_are_served_at_their_addresses():
    with Simulation(robots=[Panda(), FR3(base=(0, 1, 0)), Panda("left", base=(0, -1, 0))]) as sim:
        with pytest.raises(ValueError, match="Which robot"):
            sim.serve(ADDRESSES["panda"])
        for name, address in ADDRESSES.items():
            sim.serve(address, robot=name)
        sim["left"].joint_impedance(sim["left"].state.q + 0.1, duration=0.3)
        with Stepping(sim):
            for name in ADDRESSES:
                move_joint(connect(name), 6, 0.1, 1.0)
        sim.step(400)
        assert sim["left"].state.q == pytest.approx(
            sim["panda"].state.q + np.array([0.1] * 6 + [0.0]), abs=2e-2
        )


def test_the_hand_is_served_too(sim, name):
    with Stepping(sim):
        hand = pyfranka.Gripper(ADDRESSES[name])
        assert hand.move(0.06, 0.1)
        assert hand.read_once().width == pytest.approx(0.06, abs=1e-3)
    assert sim[name].gripper.width == pytest.approx(0.06, abs=1e-3)


def test_ticks_follow_the_clock_if_requested():
    with Simulation() as sim:
        sim.serve(ADDRESSES["panda"], pace="realtime")
        begin = time.monotonic()
        sim.step(500)
        assert 0.45 < time.monotonic() - begin


def test_an_address_in_use_is_refused_and_an_end_frees_it(sim, name):
    with pytest.raises(RuntimeError, match="served at"):
        sim.serve("127.0.33.19")
    with Simulation() as other:
        for address in (ADDRESSES[name], "300.1.1.1", ""):
            with pytest.raises(RuntimeError):
                other.serve(address)
        other.step(5)
        sim.close()
        with pytest.raises(RuntimeError, match="is closed"):
            sim.serve(ADDRESSES[name])
        other.serve(ADDRESSES[name])
        other.step(5)
    with SimulationBatch(2) as batch:
        batch[1].serve(ADDRESSES[name])
        with pytest.raises(RuntimeError, match="served on the network"):
            batch.step()


def test_forked_process_raises_because_clients_are_not_its_own(sim):
    sim.step(5)
    child = os.fork()
    if child == 0:
        try:
            sim.step()
            os._exit(1)
        except RuntimeError as error:
            os._exit(0 if "before the process was forked" in str(error) else 2)
    assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
    sim.step(5)
