# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The dense rewards of all tasks of pyfranka.gym, with a written policy and with random actions.

    python3 task_rewards.py [--robot fr3] [--episodes 10] [--output FOLDER]

Prints how many episodes succeed, and writes task_rewards.png.
"""

# %%
import numpy
from common import options, progress
from matplotlib import pyplot

arguments, _ = options(__doc__, needs=["gymnasium"], episodes=10)

import gymnasium  # noqa: E402
import pyfranka.gym  # noqa: E402

TASKS = ("Reach", "Push", "PickAndPlace", "HandOver")


# %%
def random_policy(env):
    return lambda observation: env.action_space.sample()


def play(env, make_policy, seed):
    """An episode: the reward of each step, and whether it ended with success."""
    observation, _ = env.reset(seed=seed)
    policy, rewards, over = make_policy(env), [], False
    while not over:
        observation, reward, terminated, truncated, info = env.step(policy(observation))
        rewards.append(reward)
        over = terminated or truncated
    return rewards, info["is_success"]


# %%
policies = {"written policy": pyfranka.gym.scripted_policy, "random actions": random_policy}
figure, axes = pyplot.subplots(2, 2, figsize=(9, 6))
for number, (task, one) in enumerate(zip(TASKS, axes.flat, strict=True)):
    env = gymnasium.make(f"pyfranka/{task}-v0", robot=arguments.robot, reward="dense")
    env.action_space.seed(1)
    rates = []
    for color, (name, make_policy) in enumerate(policies.items()):
        episodes = [play(env, make_policy, seed) for seed in range(arguments.episodes)]
        for rewards, success in episodes:
            time = numpy.arange(1, len(rewards) + 1) / env.metadata["render_fps"]
            one.plot(time, rewards, color=f"C{color}", alpha=0.5, linewidth=1)
            if success:
                one.plot(time[-1], rewards[-1], "o", color=f"C{color}", markersize=4)
        rates.append(f"{name} {numpy.mean([success for _, success in episodes]):.0%}")
    env.close()
    print(f"{task}: success of {rates[0]}, of {rates[1]}")
    one.set_title(task)
    one.set_xlabel("time [s]")
    one.set_ylabel("dense reward of a step")
    progress(number + 1, len(TASKS), "tasks")

# %%
for color, name in enumerate(policies):
    axes[0, 0].plot([], [], color=f"C{color}", label=name)
axes[0, 0].plot([], [], "o", color="gray", markersize=4, label="success, which ends an episode")
figure.legend(loc="lower center", ncol=3)
figure.tight_layout(rect=(0.0, 0.06, 1.0, 1.0))
figure.savefig(arguments.output / "task_rewards.png", dpi=100)
