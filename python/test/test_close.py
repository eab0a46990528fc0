# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The end of a simulation while another thread steps it, or a signal's handler runs within a step."""

import asyncio
import signal
import threading
from concurrent.futures import ThreadPoolExecutor

import pyfranka
import pytest
from pyfranka.sim import Simulation, SimulationBatch
from waiting import wait_for

ENDLESS = 10**12  # ticks
ADDRESS = "127.0.33.41"


def is_stepped(simulation):
    """Whether another thread steps it now."""
    try:
        simulation.ticks  # noqa: B018
    except RuntimeError as error:
        return "Another thread uses" in str(error)
    return False


def alone():
    simulation = Simulation()
    return simulation, simulation


def in_a_batch():
    batch = SimulationBatch(2)
    return batch, batch[1]


def in_real_time():
    simulation = Simulation()
    simulation.serve(ADDRESS, pace="realtime")
    return simulation, simulation


@pytest.mark.parametrize("make", [alone, in_a_batch, in_real_time])
def test_a_close_ends_the_step_of_another_thread(make):
    stepped, closed = make()
    with ThreadPoolExecutor() as threads, stepped:
        step = threads.submit(stepped.step, ENDLESS)
        wait_for(lambda: is_stepped(closed), "The step")
        closed.close()
        with pytest.raises(RuntimeError, match="closed while it stepped"):
            step.result(60)
    with pytest.raises(RuntimeError, match="is closed"):
        stepped.step()


def test_a_close_ends_the_wait_for_a_client():
    """In lock-step, for a client that has stopped to answer."""
    sim, holds, answers = Simulation(), threading.Event(), threading.Event()

    def hold(state, period):
        holds.set()
        answers.wait(60)
        return pyfranka.Torques([0.0] * 7)

    sim.serve(ADDRESS, patience="forever")
    with ThreadPoolExecutor() as threads:
        robot = pyfranka.Robot(ADDRESS, pyfranka.RealtimeConfig.Ignore)
        motion = threads.submit(robot.control_torques, hold)
        step = threads.submit(sim.step, ENDLESS)
        assert holds.wait(60)
        wait_for(lambda: is_stepped(sim), "The step")
        sim.close()
        with pytest.raises(RuntimeError, match="closed while it stepped"):
            step.result(60)
        answers.set()
        with pytest.raises(pyfranka.FrankaException):
            motion.result(60)


def test_the_end_of_a_block_ends_the_step_of_a_task_that_was_canceled():
    async def program():
        with Simulation() as sim:
            task = asyncio.create_task(asyncio.to_thread(sim.step, ENDLESS))
            await asyncio.to_thread(wait_for, lambda: is_stepped(sim), "The step")
            task.cancel()
            with pytest.raises(asyncio.CancelledError):
                await task

    asyncio.run(asyncio.wait_for(program(), 60))


def test_a_signals_handler_ends_the_step_that_it_interrupts():
    sim = Simulation()
    before = signal.signal(signal.SIGUSR1, lambda *_: sim.close())

    def interrupt():
        wait_for(lambda: is_stepped(sim), "The step")
        signal.raise_signal(signal.SIGUSR1)

    thread = threading.Thread(target=interrupt)
    try:
        thread.start()
        with pytest.raises(RuntimeError, match="closed while it stepped"):
            sim.step(ENDLESS)
    finally:
        thread.join()
        signal.signal(signal.SIGUSR1, before)
    with pytest.raises(RuntimeError, match="is closed"):
        sim.step()
