# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sim.SimulationBatch: many worlds at once, each as if it were alone."""

import os
import signal
import threading
import warnings
from contextlib import suppress

import numpy as np
import pytest
from pyfranka.sim import FR3, KINDS, Panda, Simulation, SimulationBatch
from waiting import wait_for

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
ROBOTS_TAKE_TURNS = True


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
            return [(sim.state_hash(), sim[name].state_hash()) for sim in batch], batch.seeds

    hashes, seeds = batch_hashes(1)
    assert batch_hashes(2) == (hashes, seeds) and batch_hashes(9) == (hashes, seeds)
    assert len(set(hashes)) == len(set(seeds)) == 4
    for way, seed in enumerate(seeds):
        with Simulation("stone.xml", robots, seed=seed) as sim:
            move(sim, name, way)
            sim.step(500)
            assert (sim.state_hash(), sim[name].state_hash()) == hashes[way]


def test_observations_are_one_array_of_requested_values(name):
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


def test_worlds_are_made_by_several_threads(monkeypatch):
    makers, make, together = set(), Simulation._make, threading.Barrier(3)

    def noted(*arguments):
        makers.add(threading.current_thread())
        if threading.current_thread() is not caller:
            together.wait(timeout=60)
        make(*arguments)

    caller = threading.current_thread()
    monkeypatch.setattr(Simulation, "_make", noted)
    for threads, expected in ((1, 1), (3, 4)):  # the first world is made by the caller
        makers.clear()
        SimulationBatch(7, threads=threads).close()
        assert len(makers) == expected and caller in makers


@pytest.mark.parametrize("threads", [1, 2])
def test_what_is_wrong_with_all_worlds_is_said_once(threads):
    near = [Panda(), FR3(base=(0.1, 0, 0))]
    with pytest.warns(UserWarning, match="Give it another base") as caught, Simulation(robots=near):
        alone = [str(one.message) for one in caught]
    with pytest.warns(UserWarning) as caught, SimulationBatch(4, robots=near, threads=threads):
        assert [str(one.message) for one in caught] == alone
        assert {one.filename for one in caught} == {__file__}
    with pytest.raises(FileNotFoundError) as expected:
        Simulation("nowhere.xml")
    with pytest.raises(FileNotFoundError) as refused:
        SimulationBatch(4, "nowhere.xml", threads=threads)
    assert str(refused.value) == str(expected.value)


def test_robots_may_be_any_iterable():
    with SimulationBatch(3, robots=iter([Panda()]), threads=2) as batch:
        assert [list(sim) for sim in batch] == [["panda"]] * 3


def test_no_world_is_stepped_if_one_is_closed():
    with SimulationBatch(2) as batch:
        batch[0].close()
        with pytest.raises(RuntimeError, match="is closed"):
            batch.step(3)
        assert batch[1].ticks == 0
    batch.close()


def test_no_world_is_reset_if_one_cannot_be():
    """The second has no stone."""
    with SimulationBatch(2, "stone.xml", [Panda(base=BASE)], observe=["time"]) as batch:
        batch.replace(1, Simulation(robots=[Panda()]))
        batch.step(10)
        before = [sim.state_hash() for sim in batch]
        with pytest.raises(RuntimeError, match="no body 'stone'"):
            batch.reset(objects={"stone": [0, 0, 1]})
        assert [sim.state_hash() for sim in batch] == before


def test_ctrl_c_ends_a_long_step_with_all_worlds_at_the_same_tick():
    with SimulationBatch(3, threads=2) as batch:
        timer = threading.Timer(0.3, signal.raise_signal, (signal.SIGINT,))
        with pytest.raises(KeyboardInterrupt):
            timer.start()
            batch.step(10**8)
        timer.join()
        (ticks,) = {sim.ticks for sim in batch}
        assert ticks < 10**8
        with SimulationBatch(3, threads=1) as other:
            other.step(ticks)
            assert [sim.state_hash() for sim in other] == [sim.state_hash() for sim in batch]
        batch.step(5)
        assert batch[0].ticks == ticks + 5


def test_too_many_contacts_are_a_warning_once(narrow_world):
    with SimulationBatch(2, narrow_world, []) as batch:
        batch[1].place_body("second", (0, 0, 5))  # there is capacity for the other one
        with pytest.warns(RuntimeWarning, match="World 0: There are more contacts.*Raise nconmax") as caught:
            batch.step(10)
        assert len(caught) == 1 and caught[0].filename == __file__
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            batch.step(10)
    with (
        SimulationBatch(2, narrow_world, []) as batch,
        pytest.warns(RuntimeWarning, match="Worlds 0, 1: There are more contacts"),
    ):
        batch.step(10)


def test_a_world_continues_from_a_snapshot_of_another_one(name):
    """As learning programs do, to try several actions from one state."""
    with SimulationBatch(3, "stone.xml", [KINDS[name](base=BASE)], threads=2) as batch:
        first = batch[0]
        first[name].gripper.move(0.05)
        move(first, name, 1)
        first.step(150)
        snapshot = first.snapshot()
        for other in batch[1:]:
            other.restore(snapshot)
            assert (other.state_hash(), other[name].state_hash()) == (
                first.state_hash(),
                first[name].state_hash(),
            )
            assert other[name].moving
        batch.step(200)
        assert len({(sim.state_hash(), sim[name].state_hash()) for sim in batch}) == 1
        first.close()
        batch[1].restore(snapshot)
        batch[1].step(200)
        assert (batch[1].state_hash(), batch[1][name].state_hash()) == (
            batch[2].state_hash(),
            batch[2][name].state_hash(),
        )
    with SimulationBatch(2, "stone.xml", [KINDS[name](base=BASE, realism="recorded")]) as batch:
        with pytest.raises(RuntimeError, match="cannot be restored"):
            batch[1].restore(batch[0].snapshot())  # other robots of the same kind


def test_another_simulation_replaces_a_world():
    with SimulationBatch(2, "stone.xml", [Panda(base=BASE)], observe=["time", "panda.q"]) as batch:
        batch.step(10)
        gone = batch[1]
        with Simulation(robots=[Panda(), FR3(base=(1, 0, 0))], seed=7) as alone:
            alone.step(30)
            expected = alone.state_hash()
        other = Simulation(robots=[Panda(), FR3(base=(1, 0, 0))], seed=7)
        batch.replace(-1, other)
        batch.step(30)
        assert batch[1] is other and other.state_hash() == expected
        assert batch.observations[:, 0] == pytest.approx([0.04, 0.03])
        with pytest.raises(RuntimeError, match="is closed"):
            gone.step()
        batch[0].close()
        batch.replace(0, Simulation(robots=[Panda()]))  # a closed one, too
        batch.step(1)
    with pytest.raises(RuntimeError, match="is closed"):
        other.step()


def test_a_world_in_use_by_another_thread_stops_the_batch_before_it_begins():
    with SimulationBatch(2, threads=2) as batch:
        ended = threading.Event()

        def step_one():
            while not ended.is_set():
                with suppress(RuntimeError):  # the batch was first
                    batch[1].step(1000)

        def refusal():
            try:
                batch.step()
            except RuntimeError as error:
                return str(error), batch[0].ticks

        stepping = threading.Thread(target=step_one)
        stepping.start()
        try:
            text, ticks = wait_for(refusal, "A refusal")
        finally:
            ended.set()
            stepping.join()
        assert "Another thread uses this simulation" in text
        batch.step(2)
        assert batch[0].ticks == ticks + 2


def test_each_further_world_takes_less_than_eight_megabytes(name):
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
