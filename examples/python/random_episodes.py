# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""A hundred episodes with random actions beside a written policy, in environments of Gymnasium.

    python3 random_episodes.py [--robot fr3] [--episodes 100] [--output FOLDER]

Writes random_episodes.png: how far from its goal the hand of Reach ended.
"""

# %%
import numpy
from common import options, progress
from matplotlib import pyplot

arguments, _ = options(__doc__, needs=["gymnasium"])

import gymnasium  # noqa: E402
import pyfranka.gym  # noqa: E402


# %%
def random_policy(env):
    return lambda observation: env.action_space.sample()


def distances(env, name, make_policy, episodes):
    """From the goal [m], at the end of each episode."""
    ends = []
    for episode in range(episodes):
        observation, _ = env.reset(seed=episode)
        policy, over = make_policy(env), False
        while not over:
            observation, _, terminated, truncated, _ = env.step(policy(observation))
            over = terminated or truncated
        ends.append(numpy.linalg.norm(observation["achieved_goal"] - observation["desired_goal"]))
        progress(episode + 1, episodes, f"episodes, {name}")
    return ends


# %%
env = gymnasium.make("pyfranka/Reach-v0", robot=arguments.robot)
env.action_space.seed(1)
policies = {"random actions": random_policy, "written policy": pyfranka.gym.scripted_policy}
ends = {name: distances(env, name, policy, arguments.episodes) for name, policy in policies.items()}
env.close()
for name, values in ends.items():
    reached = numpy.mean(numpy.less(values, 0.02))
    print(f"{name}: {1e3 * numpy.median(values):.0f} mm (median), {reached:.0%} reached")

# %%
figure, axes = pyplot.subplots(figsize=(7, 3.5))
axes.hist([1e3 * numpy.array(values) for values in ends.values()], bins=25, label=list(ends))
axes.set_xlabel("end effector from its goal at the end [mm]")
axes.set_ylabel("episodes")
axes.legend()
figure.tight_layout()
figure.savefig(arguments.output / "random_episodes.png", dpi=100)
