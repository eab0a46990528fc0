# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tasks of pyfranka.gym, as its tests make and play them."""

import gymnasium
from pyfranka.gym import scripted_policy

TASKS = ("Reach", "Push", "PickAndPlace", "HandOver")
RANDOMIZE = {
    "realism": ["real", "recorded"],
    "mass": (0.5, 2.0),
    "friction": (0.8, 1.2),
    "base_height": (-0.01, 0.01),
    "load": (0.0, 0.2),
}


def make(task, **options):
    return gymnasium.make(f"pyfranka/{task}-v0", **options)


def make_vec(task, count, **options):
    return gymnasium.make_vec(f"pyfranka/{task}-v0", num_envs=count, **options)


def same(one, other):
    return all((one[name] == other[name]).all() for name in one) and one.keys() == other.keys()


def play(env, seed):
    """An episode by its script: the last info, its steps, and the largest and the last reward."""
    observation, info = env.reset(seed=seed)
    policy, rewards, done = scripted_policy(env), [], False
    while not done:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        rewards.append(reward)
        done = terminated or truncated
    return info, rewards
