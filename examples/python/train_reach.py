# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Trains a policy that reaches goals, by the cross-entropy method in twenty lines.

    python3 train_reach.py [--robot fr3] [--episodes 640] [--output FOLDER]

Many environments run at once, each with another candidate. Those with the best rewards are the next mean and
spread. Prints how many new goals the last mean reaches, and writes train_reach.png.
"""

# %%
import numpy
from common import options, progress
from matplotlib import pyplot

arguments, _ = options(__doc__, needs=["gymnasium"], episodes=640)

import gymnasium  # noqa: E402
import pyfranka.gym  # noqa: E402, F401

CANDIDATES, BEST = 20, 5  # of a round
GOALS = 2  # each candidate has an episode for each
STEPS = 50  # of an episode
SHAPE = (6, 4)  # a policy: from the way to the goal and a constant to an action
SPREAD = 0.05  # least one, so that the search does not end early


# %% [markdown]
# A candidate is a matrix. What it gets is the sum of the dense rewards of an episode, which ends at its goal.


# %%
def episodes(env, policies, seeds):
    """An episode of each policy: sums of rewards, and which reached its goal."""
    observation, _ = env.reset(seed=seeds)
    position = env.unwrapped.layout[f"{arguments.robot}.position"]
    total, alive = numpy.zeros(len(policies)), numpy.ones(len(policies), dtype=bool)
    for _ in range(STEPS):
        way = observation["desired_goal"] - observation["observation"][:, position]
        features = numpy.hstack([10.0 * way, numpy.ones((len(way), 1))])
        action = numpy.einsum("nij,nj->ni", policies, features)
        observation, reward, terminated, _, _ = env.step(numpy.clip(action, -1.0, 1.0))
        total += numpy.where(alive, reward, 0.0)  # an environment whose episode has ended begins another one
        alive &= ~terminated
    return total, ~alive


# %%
random = numpy.random.default_rng(1)
mean, spread = numpy.zeros(SHAPE), numpy.ones(SHAPE)
task = {"robot": arguments.robot, "reward": "dense", "max_episode_steps": STEPS}
env = gymnasium.make_vec("pyfranka/Reach-v0", num_envs=CANDIDATES, **task)
rewards, reached = [], []
rounds = max(1, arguments.episodes // (CANDIDATES * GOALS))
for number in range(rounds):
    policies = mean + spread * random.standard_normal((CANDIDATES, *SHAPE))
    # All candidates have the same goals, so that none is better by luck.
    runs = [episodes(env, policies, [GOALS * number + goal] * CANDIDATES) for goal in range(GOALS)]
    total = sum(run[0] for run in runs) / GOALS
    best = policies[numpy.argsort(total)[-BEST:]]
    mean, spread = best.mean(axis=0), numpy.maximum(best.std(axis=0), SPREAD)
    rewards.append(total)
    reached.append(numpy.mean([run[1] for run in runs]))
    progress(number + 1, rounds, "rounds")

_, new = episodes(env, numpy.tile(mean, (CANDIDATES, 1, 1)), list(range(1000, 1000 + CANDIDATES)))
env.close()
print(f"{new.sum()} of {len(new)} new goals reached after {rounds * CANDIDATES * GOALS} episodes")

# %%
figure, axes = pyplot.subplots(2, 1, figsize=(7, 5), sharex=True)
turns = numpy.arange(1, rounds + 1)
axes[0].plot(turns, rewards, ".", color="C0", alpha=0.4)
axes[0].plot(turns, numpy.mean(rewards, axis=1), color="C0", label="mean; points: candidates")
axes[0].set_ylabel("sum of rewards")
axes[0].legend(loc="lower right")
axes[1].plot(turns, 100.0 * numpy.array(reached), color="C1")
axes[1].set_ylabel("goals reached [%]")
axes[1].set_xlabel("round")
figure.tight_layout()
figure.savefig(arguments.output / "train_reach.png", dpi=100)
