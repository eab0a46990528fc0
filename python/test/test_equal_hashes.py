# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Ten seconds with contact have the same bits by all ways: in C++, in Python, in a batch, over the network in
lock-step, and on a worker of Dask."""

import subprocess
from pathlib import Path

import cloudpickle
import contact_motion
import pyfranka
import pytest
from contact_motion import BASE, SCENE, TICKS, WORLD, down_and_back, follow, press
from fci_session import simulated
from pyfranka.sim import KINDS, Simulation, SimulationBatch

ROBOTS_TAKE_TURNS = True
cloudpickle.register_pickle_by_value(contact_motion)  # workers cannot import the tests
PROGRAM = (
    Path(__file__).resolve().parents[2]
    / "catkin_ws"
    / "devel"
    / "lib"
    / "franka_sim"
    / "franka_sim_contact_scenario_test"
)


@pytest.fixture(scope="module", params=["panda", "fr3"])
def name(request):
    return request.param


@pytest.fixture(scope="module")
def alone(name):
    """The hashes of robot and world in each tick, those of the robot while the motion ends, and the joint
    positions at its start."""
    with Simulation(WORLD, [KINDS[name](base=BASE)]) as sim:
        robot, pressed = sim[name], 0.0
        first = robot.state.q_d.copy()

        def step():
            nonlocal pressed
            sim.step()
            pressed = max(pressed, abs(robot.state.tau_ext_hat_filtered[1]))

        ticks, end = list(follow(sim, name, step)), []
        assert pressed > 10.0, "the hand touches the table"
        robot.command(joint_positions=down_and_back(first, TICKS))
        robot.finish()
        for _ in range(2000):
            sim.step()
            end.append(robot.state_hash())
        assert not robot.moving
        return ticks, end, first


def test_in_cpp(name, alone):
    run = subprocess.run([PROGRAM, name], capture_output=True, text=True, timeout=300, check=True)
    after_ticks, *end = run.stdout.splitlines()
    assert tuple(int(word, 16) for word in after_ticks.split()) == alone[0][-1]
    assert [int(word, 16) for word in end] == alone[1]


def test_in_a_batch(name, alone):
    robots = [KINDS[name](base=BASE)]
    with SimulationBatch(2, WORLD, robots, threads=2) as batch:
        first, second = follow(batch[0], name, lambda: None), follow(batch[1], name, batch.step)
        for k in range(TICKS):
            # The first world's motion is commanded, then the second's, then both are stepped.
            next(first)
            assert next(second) == alone[0][k], k
        assert (batch[0][name].state_hash(), batch[0].state_hash()) == alone[0][-1]


def test_over_the_network(name, alone):
    with simulated(name, "lockstep", **SCENE) as served:
        press(served.address, served.protocol, alone[2])
        expected = served.remote.state_hash()
    assert expected in alone[1], "a served world runs on until it rests"


def on_worker(kind, seed):
    with Simulation(WORLD, [KINDS[kind](base=BASE)]) as sim:
        *_, last = follow(sim, kind, sim.step)
        return last


def test_on_a_worker(name, alone):
    (done,) = pyfranka.sweep(on_worker, [name])
    assert done.result == alone[0][-1]
