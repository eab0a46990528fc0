# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sim.SimulationBatch: many worlds at once, each as if it were alone."""

import os
import threading
import time

import contact_motion
import numpy as np
import pytest
from contact_motion import TICKS, down_and_back
from pyfranka.sim import FR3, KINDS, Panda, Simulation, SimulationBatch

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
LOOSE = [100.0] * 7, [100.0] * 7, [300.0] * 6, [300.0] * 6


def move(sim, name, way):
    """Begins a motion that differs from world to world."""
    robot = sim[name]
    robot.joint_impedance(robot.state.q + way * np.array([0.05, 0, 0, 0, 0.1, 0.1, 0]), duration=0.3)
    robot.gripper.move(0.05)
    sim.push("stone", [1.0 + way, 0.5, 0.0], ticks=100)


def test_each_world_equals_the_same_world_alone_on_any_number_of_threads(name):
    robots = [KINDS[name](base=BASE, realism="recorded")]

    def batch_hashes(threads):
        with SimulationBatch(4, "stone.xml", robots, seed=3, threads=threads) as batch:
            for way, sim in enumerate(batch):
                move(sim, name, way)
            for _ in range(10):
                batch.step(50)
            return [(sim.hash(), sim[name].hash()) for sim in batch], batch.seeds

    hashes, seeds = batch_hashes(1)
    assert batch_hashes(2) == (hashes, seeds) and batch_hashes(9) == (hashes, seeds)
    assert len(set(hashes)) == len(set(seeds)) == 4
    for way, seed in enumerate(seeds):
        with Simulation("stone.xml", robots, seed=seed) as sim:
            move(sim, name, way)
            sim.step(500)
            assert (sim.hash(), sim[name].hash()) == hashes[way]


def test_ten_seconds_with_contact_have_the_same_hash_in_a_batch(name):
    robots = [KINDS[name](base=contact_motion.BASE)]

    def follow(sim, step):
        robot = sim[name]
        robot.set_collision_behavior(*LOOSE)
        first = robot.state.q_d.copy()
        for k in range(TICKS):
            robot.command(joint_positions=down_and_back(first, k))
            step()
            yield robot.hash(), sim.hash()

    with Simulation(contact_motion.WORLD, robots) as sim:
        alone = list(follow(sim, sim.step))
    with SimulationBatch(2, contact_motion.WORLD, robots, threads=2) as batch:
        first, second = follow(batch[0], lambda: None), follow(batch[1], batch.step)
        for k in range(TICKS):
            # The first world's motion is commanded, then the second's, then both are stepped.
            next(first)
            assert next(second) == alone[k], k
        assert (batch[0][name].hash(), batch[0].hash()) == alone[-1]


def test_observations_are_one_array_of_what_was_asked_for(name):
    names = [f"{name}.O_T_EE", "stone.pose", "time", f"{name}.width", f"{name}.tau_J"]
    with SimulationBatch(3, "stone.xml", [KINDS[name](base=BASE)], observe=names) as batch:
        seen, layout = batch.observations, batch.layout
        assert list(layout) == names and seen.shape == (3, 16 + 7 + 1 + 1 + 7)
        assert seen.flags.c_contiguous and seen.dtype == np.float64
        for way, sim in enumerate(batch):
            move(sim, name, 3 * way)
        batch.step(120)
        for row, sim in zip(seen, batch, strict=True):
            state = sim[name].state
            assert (row[layout[f"{name}.O_T_EE"]].reshape(4, 4, order="F") == state.O_T_EE).all()
            assert (row[layout["stone.pose"]] == np.concatenate(sim.body_pose("stone"))).all()
            assert row[layout["time"]] == sim.time == pytest.approx(0.12)
            assert row[layout[f"{name}.width"]] == sim[name].gripper.width
            assert (row[layout[f"{name}.tau_J"]] == state.tau_J).all()
        assert len({tuple(row) for row in seen}) == 3
        with pytest.raises(ValueError, match="read-only"):
            seen[0, 0] = 1.0
        batch[1].reset()
        assert seen[1, layout["time"]] == pytest.approx(0.12) and batch.observe()[1, layout["time"]] == 0.0
        batch.reset(q="random", worlds=[2])
        q = batch[2][name].state.q.copy()
        assert (batch[2].ticks, batch[0].ticks) == (0, 120)
        batch.reset()
        assert (batch[2][name].state.q != q).any() and not seen[:, layout["time"]].any()
    assert np.isfinite(seen).all(), "a view keeps the batch"


def test_what_is_usual_is_observed_without_being_asked_for():
    with SimulationBatch(
        1, "stone.xml", [Panda(base=BASE), FR3(base=(0.5, 0, 0, 3.14), hand=False)]
    ) as batch:
        robots = [f"panda.{v}" for v in ("q", "dq", "O_T_EE", "robot_mode", "width")]
        robots += [f"fr3.{v}" for v in ("q", "dq", "O_T_EE", "robot_mode")]
        assert list(batch.layout) == ["time", *robots, "stone.pose"]
        batch.step(5)
        assert batch.observations[0, batch.layout["panda.robot_mode"]] == 1.0, "Idle"


def test_bad_input_is_refused_with_a_sentence():
    for sentence, arguments in {
        "at least one world, not 0": {"number": 0},
        "no world 'moon.xml'": {"number": 2, "world": "moon.xml"},
        "1 to 1024 threads, not on 0": {"number": 2, "threads": 0},
        "There is no value 'panda.colour'": {"number": 2, "observe": ["panda.colour"]},
        "observe is a list": {"number": 2, "observe": "time"},
        "robots are Panda": {"number": 2, "robots": ["panda"]},
        "integer": {"number": 2.5},
    }.items():
        with pytest.raises((ValueError, RuntimeError, TypeError), match=sentence):
            SimulationBatch(**arguments)
    with SimulationBatch(2) as batch:
        with pytest.raises(ValueError, match="Time goes forwards"):
            batch.step(-1)
        with pytest.raises(IndexError):
            batch.reset(worlds=[5])
        with pytest.raises(ValueError, match="or 'random'"):
            batch.reset(q="anywhere")
        batch[0].close()
        with pytest.raises(RuntimeError, match="is closed"):
            batch.step(3)
        assert batch[1].ticks == 0, "none was stepped"
    batch.close()


def test_a_world_in_use_by_another_thread_stops_the_batch_before_it_begins():
    with SimulationBatch(2, threads=2) as batch:
        stepping = threading.Thread(target=batch[1].step, args=(20000,))
        stepping.start()
        deadline = time.monotonic() + 60
        refused = ""
        while not refused and stepping.is_alive() and time.monotonic() < deadline:
            try:
                batch.step()
            except RuntimeError as error:
                refused = str(error)
                ticks = batch[0].ticks
        assert "Another thread uses this simulation" in refused
        stepping.join()
        batch.step(2)
        assert batch[0].ticks == ticks + 2


def test_a_forked_process_may_use_a_simulation_but_makes_a_batch_of_its_own():
    """`os.fork` as multiprocessing on Linux does it."""
    with Simulation(robots=[Panda()]) as sim, SimulationBatch(2, threads=2) as batch:
        batch.step(5)
        sim.step(100)
        child = os.fork()
        if child == 0:
            result = 1
            try:
                batch.step()
            except RuntimeError as error:
                sim.step(50)
                with SimulationBatch(2, threads=2) as own:
                    own.step(5)
                result = 0 if "before the process was forked" in str(error) and own.seeds else 2
            finally:
                os._exit(result)
        assert os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]) == 0
        batch.step(5)
        assert batch[1].ticks == 10


def test_a_world_more_costs_less_than_eight_megabytes(name):
    def resident():
        with open("/proc/self/statm") as statm:
            return int(statm.read().split()[1]) * os.sysconf("SC_PAGESIZE") / 1e6

    def use(sims):
        for sim in sims:
            move(sim, name, 1)
            sim.step(200)

    robots = [KINDS[name](base=BASE)]
    with SimulationBatch(1, "stone.xml", robots) as warm_up:
        use(warm_up)
        first = resident()
        with SimulationBatch(12, "stone.xml", robots) as batch:
            use(batch)
            assert (resident() - first) / 12 < 8.0
