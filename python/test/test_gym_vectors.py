# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Vectors of environments of pyfranka.gym."""

import warnings

import gymnasium
import numpy as np
import pyfranka.gym
import pytest
from gym_tasks import RANDOMIZE, make, make_vec, same
from gymnasium.error import ResetNeeded
from pyfranka.gym.randomization import RANGES


@pytest.mark.parametrize("randomize", [None, RANDOMIZE], ids=["same", "randomized"])
def test_worlds_of_a_vector_equal_single_environments(randomize):
    vector = make_vec("PickAndPlace", 3, threads=2, randomize=randomize)
    assert isinstance(vector.unwrapped, pyfranka.gym.VectorEnvironment)
    vector.action_space.seed(1)
    actions = [vector.action_space.sample() for _ in range(6)]
    rows = [vector.reset(seed=10)[0]]
    rows += [vector.step(action)[0] for action in actions]
    rows += [vector.reset()[0], vector.step(actions[0])[0]]  # each goes on with its random numbers
    for i in range(3):
        env = make("PickAndPlace", randomize=randomize)
        single = [env.reset(seed=10 + i)[0]]
        single += [env.step(action[i])[0] for action in actions]
        single += [env.reset()[0], env.step(actions[0][i])[0]]
        for row, observation in zip(rows, single, strict=True):
            assert same({name: values[i] for name, values in row.items()}, observation)
        env.close()
    assert same(vector.reset(seed=10)[0], rows[0]), "the same seed, the same episodes"
    loads = {float(each.robots[0].state.m_load) for each in vector.unwrapped.episodes}
    assert len(loads) == (3 if randomize else 1)
    vector.close()


@pytest.mark.parametrize("realism", ["ideal", "recorded"])
def test_each_world_of_a_vector_begins_with_open_hands(realism):
    """Equal worlds take over the state of the first one, whose hands have opened."""
    vector = make_vec("PickAndPlace", 3, realism=realism)
    ticks = [episode.sim.ticks for episode in vector.unwrapped.episodes]
    observations, _ = vector.reset(seed=1)
    width = observations["observation"][:, vector.unwrapped.layout["panda.width"]]
    assert width == pytest.approx(0.08, abs=1e-3)
    single = make("PickAndPlace", realism=realism)
    opened = single.unwrapped.simulation.ticks
    assert ticks == [opened] * 3 or (realism == "recorded" and min(ticks) >= opened)
    single.close()
    vector.close()


def test_only_reset_worlds_are_recreated():
    vector = make_vec("Reach", 2, randomize={"load": (0.0, 1.0)}, autoreset_mode="Disabled")
    vector.reset(seed=1)
    first, second = vector.unwrapped.episodes
    vector.reset(options={"reset_mask": np.array([False, True])})
    assert vector.unwrapped.episodes[0] is first and vector.unwrapped.episodes[1] is not second
    with pytest.raises(RuntimeError, match="is closed"):
        second.sim.step()
    vector.step(vector.action_space.sample())
    vector.close()
    with pytest.raises(RuntimeError, match="is closed"):
        first.sim.step()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep"])
def test_a_world_that_diverges_is_truncated_alone(mode, monkeypatch):
    monkeypatch.setitem(RANGES, "mass", (0.0, 1.0))
    feather = {"mass": (1e-9, 1e-9)}  # light enough that a permitted force makes it diverge
    vector = make_vec("Push", 3, randomize=feather, autoreset_mode=mode)
    vector.reset(seed=1)
    actions = np.zeros(vector.action_space.shape, dtype=np.float32)
    vector.unwrapped.episodes[1].sim.push("cube", (1000.0, 0.0, 0.0), ticks=20)
    with pytest.warns(RuntimeWarning, match="World 1: .*diverged"):
        observations, _, _, truncated, infos = vector.step(actions)
    assert truncated.tolist() == [False, True, False]
    last = infos["final_info"] if mode == "SameStep" else infos
    assert last["diverged"].tolist() == [False, True, False]
    assert vector.observation_space.contains(observations)
    for _ in range(2):
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            _, _, _, truncated, infos = vector.step(actions)
        assert not truncated.any() and not infos["diverged"].any()
    vector.close()


def test_each_world_is_drawn_once_a_step(monkeypatch):
    drawn = []
    picture = pyfranka.gym.environment.Options.picture
    monkeypatch.setattr(
        pyfranka.gym.environment.Options, "picture", lambda self, sim: drawn.append(sim) or picture(self, sim)
    )
    vector = make_vec("Reach", 2, time_limit=0.1, observation="state+pictures", size=(32, 24))
    vector.reset(seed=1)
    for _ in range(4):  # a reset in the third
        drawn.clear()
        vector.step(vector.action_space.sample())
        assert len(drawn) == 2
    vector.close()


def test_the_seed_is_that_of_np_random_too():
    vector = make_vec("Reach", 2)
    drawn = []
    for seed in (3, 3, 4):
        vector.reset(seed=seed)
        drawn.append(vector.np_random.uniform())
    assert drawn[0] == drawn[1] != drawn[2]
    vector.close()


@pytest.mark.parametrize("mode", ["NextStep", "SameStep", "Disabled"])
def test_worlds_of_a_vector_are_reset_as_gymnasium_does(mode):
    """The reference is Gymnasium's own SyncVectorEnv."""
    kind = gymnasium.vector.AutoresetMode(mode)
    ours = make_vec("Reach", 2, max_episode_steps=4, autoreset_mode=mode)
    reference = gymnasium.make_vec(
        "pyfranka/Reach-v0",
        num_envs=2,
        vectorization_mode="sync",
        vector_kwargs={"autoreset_mode": kind},
        max_episode_steps=4,
    )
    assert ours.metadata["autoreset_mode"] == kind
    ours.action_space.seed(2)
    first, second = ours.reset(seed=3), reference.reset(seed=3)
    assert same(first[0], second[0]) and first[1].keys() == second[1].keys()
    for k in range(10):
        action = ours.action_space.sample()
        one, two = ours.step(action), reference.step(action)
        assert same(one[0], two[0]), k
        for mine, theirs in zip(one[1:4], two[1:4]):
            assert (mine == theirs).all(), k
        assert one[4].keys() == two[4].keys(), k
        if "final_obs" in two[4]:
            assert same(one[4]["final_obs"][0], two[4]["final_obs"][0])
        if mode == "Disabled" and one[3].any():
            with pytest.raises(ResetNeeded, match="0, 1 have ended"):
                ours.step(action)
            for env in (ours, reference):
                env.reset(options={"reset_mask": np.array([True, True])})
    ours.close()
    reference.close()
