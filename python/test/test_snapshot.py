# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Snapshots of a simulation: what they keep, and resets that must change nothing if they fail."""

import pyfranka.sim.simulation
import pytest
from pyfranka.sim import KINDS, Simulation

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True


@pytest.fixture
def sim(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE, realism="ideal")]) as simulation:
        yield simulation


def hashes(sim):
    return sim.state_hash(), [robot.state_hash() for robot in sim.values()]


def test_the_free_random_numbers_go_on(sim, name):
    sim.reset(q="random", seed=5)
    snapshot, first = sim.snapshot(), sim[name].state.q.copy()
    sim.reset(q="random")
    second = sim[name].state.q.copy()
    sim.restore(snapshot)
    assert (sim[name].state.q == first).all()
    sim.reset(q="random")
    assert (sim[name].state.q != second).any()


def test_a_seed_of_a_reset_is_that_of_random_poses_alone(name):
    """Noise begins again with each reset, from the seed of the simulation."""

    def noisy(sim):
        sim.step(50)
        return sim[name].state.tau_J.copy()

    with Simulation(robots=[KINDS[name](realism="recorded")], seed=3) as sim:
        first = noisy(sim)
        for seed in (None, 3, 4):
            sim.reset(seed=seed)
            assert (noisy(sim) == first).all()
    with Simulation(robots=[KINDS[name](realism="recorded")], seed=4) as other:
        assert (noisy(other) != first).any()


def test_a_reset_without_a_free_pose_changes_nothing(tmp_path, name, monkeypatch):
    """The arm stands in a narrow chimney that is closed above."""
    monkeypatch.setattr(pyfranka.sim.simulation, "TRIES", 20)
    wall = "<geom type='box' size='{} {} 1' pos='{} {} 1'/>"
    sides = (0.05, 0.5, 0.2, 0), (0.05, 0.5, -0.2, 0), (0.5, 0.05, 0, 0.2), (0.5, 0.05, 0, -0.2)
    walls = "".join(wall.format(*side) for side in sides)
    world = tmp_path / "chimney.xml"
    ceiling = "<geom type='box' size='0.5 0.5 0.05' pos='0 0 0.55'/>"
    ball = "<body name='ball' pos='1 1 1'><freejoint/><geom size='0.05'/></body>"
    world.write_text(f"<mujoco><worldbody>{walls}{ceiling}{ball}</worldbody></mujoco>")
    with pytest.warns(UserWarning, match="another base"):
        sim = Simulation(world, [KINDS[name](), KINDS[name](name="free", base=(3, 0, 0))], seed=2)
    with sim:
        free = sim["free"]
        free.joint_impedance(free.state.q + 0.1, 0.3)
        sim.step(100)
        before = hashes(sim)
        with pytest.raises(RuntimeError, match="No random pose of .* is free of contacts"):
            sim.reset(q={"free": "random", name: "random"}, objects={"ball": [1, 1, 2]}, seed=7)
        assert hashes(sim) == before and free.moving
        sim.reset(q={"free": "random"})
        again = free.state.q.copy()
        sim.reset(q={"free": "random"}, seed=2)
        assert (free.state.q == again).all(), "the random numbers did not advance"
