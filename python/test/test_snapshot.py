# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Snapshots of a simulation: what they keep, and resets that must change nothing if they fail."""

import numpy as np
import pyfranka.sim.simulation
import pytest
from pyfranka.sim import FR3, KINDS, GripperOutcome, Panda, Simulation

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True


@pytest.fixture
def sim(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE, realism="ideal")]) as simulation:
        yield simulation


def hashes(sim):
    return sim.state_hash(), [robot.state_hash() for robot in sim.values()]


def test_a_motion_goes_on_bit_for_bit(sim, name):
    robot = sim[name]
    robot.joint_impedance(robot.state.q + 0.2, duration=0.6)
    robot.set_user_stop(False)
    sim.step(300)
    snapshot, then, q = sim.snapshot(), hashes(sim), robot.state.q.copy()
    sim.step(300)
    end = hashes(sim)
    sim.push("stone", [3, 0, 0], ticks=100)
    robot.finish()
    sim.step(600)
    for _ in range(2):
        sim.restore(snapshot)
        assert hashes(sim) == then and sim.ticks == 300 and robot.moving
        assert (robot.state.q == q).all()
        sim.step(300)
        assert hashes(sim) == end


def hold_the_stone(sim, name):
    """Opens the hand; the stone comes between its fingers, which close."""
    robot = sim[name]
    robot.gripper.move(0.06)
    sim.step(1500)
    sim.place_body("stone", robot.state.O_T_EE[:3, 3] + BASE)
    return robot.gripper.grasp(0.032, 0.1, 40.0, 0.02, 0.02)


def test_a_hand_goes_on_closing_and_holding(sim, name):
    robot = sim[name]
    first = hold_the_stone(sim, name)
    sim.step(20)
    assert first.outcome == GripperOutcome.Running
    closing = sim.snapshot()
    sim.step(1000)
    width = robot.gripper.width
    held = sim.snapshot() if robot.gripper.is_grasped else None
    second = robot.gripper.move(0.08)
    sim.step(1500)
    assert second.succeeded

    sim.restore(closing)
    third = robot.gripper
    assert second.outcome == GripperOutcome.Succeeded, "what has ended has ended"
    sim.step(1000)
    assert third.width == width
    late = robot.gripper.move(0.07)
    sim.restore(closing)
    assert late.outcome == GripperOutcome.Interrupted, "it was given after the snapshot"
    if held:
        sim.restore(held)
        assert robot.gripper.is_grasped
        sim.step(2000)
        assert robot.gripper.is_grasped and robot.gripper.width == pytest.approx(width, abs=1e-4)


def test_settings_are_those_of_the_snapshot(sim, name):
    robot = sim[name]
    before = sim.snapshot()
    robot.set_load(0.4, [0, 0, 0.05], np.zeros(9))
    after = sim.snapshot()
    sim.restore(before)
    assert robot.state.m_load == 0.0
    sim.restore(after)
    assert robot.state.m_load == 0.4
    sim.reset()
    assert robot.state.m_load == 0.4, "a reset keeps them"


def test_a_snapshot_outlives_its_simulation(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)], seed=3) as first:
        first[name].joint_impedance(first[name].state.q + 0.1, 0.3)
        first.step(100)
        snapshot, then = first.snapshot(), hashes(first)
    del first
    with Simulation("stone.xml", [KINDS[name](base=BASE)], seed=4) as second:
        second.restore(snapshot)
        assert hashes(second) == then and second[name].moving
        second.step(100)
        assert second[name].state.dq.any()


@pytest.mark.parametrize(
    "others",
    [
        {"world": "stone.xml", "robots": [Panda(base=(-0.4, 0, 0))]},
        {"world": "stone.xml", "robots": [Panda(base=BASE, hand=False)]},
        {"world": "stone.xml", "robots": [Panda(base=BASE, realism="real")]},
        {"world": "stone.xml", "robots": [FR3(name="panda", base=BASE)]},
        {"world": "stone.xml", "robots": [Panda(base=BASE), Panda(base=(0.5, 0, 0, 3.14))]},
        {"world": "", "robots": [Panda(base=BASE)]},
    ],
    ids=["base", "hand", "realism", "kind", "number", "world"],
)
def test_a_snapshot_of_another_simulation_is_refused(others):
    with Simulation("stone.xml", [Panda(base=BASE)]) as sim, Simulation(**others) as other:
        sim["panda"].joint_impedance(sim["panda"].state.q)
        sim.step(20)
        before = hashes(sim)
        with pytest.raises(RuntimeError, match=r"The snapshot cannot be restored: it is of .* Take another"):
            sim.restore(other.snapshot())
        assert hashes(sim) == before and sim["panda"].moving
        sim.step(5)
        other.step(5)


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
