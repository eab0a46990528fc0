# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Environments that are closed, in use by another thread or forked: a sentence, and nothing half done."""

import multiprocessing

import numpy as np
import pyfranka.gym
import pytest
from gymnasium.error import ClosedEnvironmentError
from sentences import check_refused_while_another_thread_steps, unlike_ours

MAKE = {
    "Environment": lambda name: pyfranka.gym.Environment("Reach", robot=name, render_mode="rgb_array"),
    "VectorEnvironment": lambda name: pyfranka.gym.VectorEnvironment(
        2, task="Reach", robot=name, render_mode="rgb_array"
    ),
}
ROBOTS_TAKE_TURNS = True


@pytest.fixture(params=MAKE)
def env(request, name):
    env = MAKE[request.param](name)
    env.reset(seed=1)
    yield env
    env.close()


def calls(env):
    still = np.zeros(env.action_space.shape)
    return {"reset": env.reset, "step": lambda: env.step(still), "render": env.render}


def simulations(env):
    return [env.simulation] if hasattr(env, "simulation") else [episode.sim for episode in env.episodes]


def test_a_closed_environment_raises_at_each_call(env):
    env.close()
    for name, call in calls(env).items():
        with pytest.raises(ClosedEnvironmentError, match="make another one"):
            call()
            pytest.fail(name)
    env.close()


def test_while_another_thread_steps_the_world_each_call_is_refused(env):
    check_refused_while_another_thread_steps(simulations(env)[-1], calls(env).items())
    env.reset(seed=1)
    calls(env)["step"]()


def in_the_forked_process(env, sender):
    found = {}
    for name, call in calls(env).items():
        try:
            call()
        except RuntimeError as error:
            found[name] = str(error)
    sender.send(found)


def test_a_forked_process_goes_on_with_one_environment_and_makes_many_anew(env):
    fork = multiprocessing.get_context("fork")
    receiver, sender = fork.Pipe(duplex=False)
    hashes = [each.state_hash() for each in simulations(env)]
    child = fork.Process(target=in_the_forked_process, args=(env, sender))
    child.start()
    assert receiver.poll(60), "an answer"
    found = receiver.recv()
    child.join(60)
    assert child.exitcode == 0
    if len(hashes) == 1:
        assert set(found) <= {"render"}  # if another test has drawn
    else:
        assert "step" in found and "make one in the new process" in found["step"]
    assert not [text for text in found.values() if unlike_ours(text)]
    assert hashes == [each.state_hash() for each in simulations(env)]
    calls(env)["step"]()
