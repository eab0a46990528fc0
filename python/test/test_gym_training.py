# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Learning libraries train in the environments of pyfranka.gym."""

import os
import subprocess
from pathlib import Path

import pytest

TOP = Path(__file__).resolve().parents[2]
STABLE_BASELINES3 = ["torch==2.13.0", "stable-baselines3==2.9.2", "gymnasium==1.4.0", "pygame==2.6.1"]
CHECKS = """
import sys
import gymnasium, gymnasium.utils.env_checker, pyfranka.gym
from stable_baselines3 import PPO, SAC, HerReplayBuffer
from stable_baselines3.common.env_checker import check_env

for task in ("Reach", "Push", "PickAndPlace", "HandOver"):
    for robot in ("panda", "fr3"):
        for control in ("torque", "joint_delta", "cartesian_delta"):
            env = gymnasium.make(f"pyfranka/{task}-v0", robot=robot, control=control)
            check_env(env.unwrapped, warn=True)
            env.close()
env = gymnasium.make("pyfranka/Reach-v0")
gymnasium.utils.env_checker.check_env(env.unwrapped)  # renders in all modes
env.close()
env = gymnasium.make("pyfranka/Push-v0", observation="state+pictures", size=(48, 40), render_mode="rgb_array")
check_env(env.unwrapped, warn=True)
env.close()
env = gymnasium.make("pyfranka/Reach-v0")
PPO("MultiInputPolicy", env, n_steps=64, batch_size=32).learn(128)
SAC("MultiInputPolicy", env, learning_starts=60, replay_buffer_class=HerReplayBuffer).learn(150)
env.close()
env = gymnasium.make("pyfranka/Reach-v0", reward="dense")
SAC("MultiInputPolicy", env, learning_starts=60, replay_buffer_class=HerReplayBuffer).learn(150)
env.close()
print("passed")
"""


@pytest.fixture(scope="module")
def learning_python():
    """The interpreter of an environment with stable-baselines3, beside this one's packages. It is kept."""
    folder = TOP / "out" / "learning"
    python, stamp = folder / "bin" / "python", folder / "installed"
    if not (stamp.exists() and stamp.read_text() == " ".join(STABLE_BASELINES3)):
        venv = ["/usr/bin/python3", "-m", "venv", "--clear", "--system-site-packages", folder]
        subprocess.run(venv, check=True, timeout=300)
        pip = [python, "-m", "pip", "install", "--quiet", "--disable-pip-version-check"]
        result = subprocess.run([*pip, *STABLE_BASELINES3], capture_output=True, text=True, timeout=3000)
        assert result.returncode == 0, result.stderr
        stamp.write_text(" ".join(STABLE_BASELINES3))
    return python


@pytest.mark.long_form("its library brings torch")
def test_the_checker_of_stable_baselines3_passes_and_it_learns(learning_python):
    own = {**os.environ, "SDL_VIDEODRIVER": "dummy"}
    ran = subprocess.run(
        [learning_python, "-c", CHECKS], capture_output=True, text=True, timeout=1800, env=own
    )
    assert ran.returncode == 0 and ran.stdout.endswith("passed\n"), ran.stdout[-2000:] + ran.stderr[-3000:]
