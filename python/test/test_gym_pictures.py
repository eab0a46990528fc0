# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Pictures of the environments of pyfranka.gym: observations, windows, videos, and what they keep."""

import os
import subprocess
import sys
import warnings
from importlib.machinery import ModuleSpec
from unittest.mock import MagicMock

import numpy as np
import pytest
from gym_tasks import make, make_vec
from gymnasium.utils.env_checker import check_env


def test_the_checker_of_gymnasium_passes_with_pictures():
    env = make("Reach", observation="state+pictures", size=(32, 24), render_mode="rgb_array")
    check_env(env.unwrapped, skip_render_check=True)
    observation, _ = env.reset(seed=1)
    assert observation["picture"].shape == (24, 32, 3) and observation["picture"].std() > 5.0
    assert env.render().shape == (480, 640, 3) and env.render().std() > 5.0
    env.close()
    env = make("Reach", observation="state+pictures", render_mode="rgb_array", render_size=(128, 96))
    observation, _ = env.reset(seed=1)
    assert (env.render() == observation["picture"]).all()
    env.close()


def test_the_mode_human_shows_each_step_in_a_window(monkeypatch):
    """With a stand-in for pygame; the long form has the genuine one."""
    pygame = MagicMock()
    pygame.__spec__ = ModuleSpec("pygame", None)
    monkeypatch.setitem(sys.modules, "pygame", pygame)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        env = make("Reach", render_mode="human", render_size=(64, 48), frequency=10)
    env.reset(seed=1)
    env.step(env.action_space.sample())
    assert env.render() is None
    pygame.display.set_mode.assert_called_once_with((64, 48))
    assert pygame.surfarray.make_surface.call_args.args[0].shape == (64, 48, 3)
    assert pygame.display.flip.call_count == 2 and pygame.display.quit.call_count == 0
    pygame.time.Clock().tick.assert_called_with(10)
    env.close()
    pygame.display.quit.assert_called_once()


def test_the_mode_human_without_pygame_is_refused(monkeypatch):
    monkeypatch.setitem(sys.modules, "pygame", None)
    with pytest.raises(ImportError, match="needs pygame: pip install pygame"):
        make("Reach", render_mode="human")
    env = make("Reach")
    assert env.unwrapped.metadata["render_modes"] == ["rgb_array"], "for Gymnasium's checker"
    env.close()


def test_a_vector_of_environments_has_pictures():
    options = {"observation": "state+pictures", "size": (48, 32), "render_size": (48, 32)}
    options["render_mode"] = "rgb_array"
    vector, action = make_vec("Push", 2, **options), np.full((2, 6), 0.5, dtype=np.float32)
    rows = [vector.reset(seed=4)[0], *(vector.step(action)[0] for _ in range(5))]
    assert rows[0]["picture"].shape == (2, 32, 48, 3) and rows[0]["picture"].dtype == np.uint8
    drawn = vector.render()
    assert len(drawn) == 2 and all((rows[-1]["picture"][i] == drawn[i]).all() for i in range(2))
    for i in range(2):
        env = make("Push", **options)
        single = [env.reset(seed=4 + i)[0], *(env.step(action[i])[0] for _ in range(5))]
        for row, observation in zip(rows, single, strict=True):
            assert (row["picture"][i] == observation["picture"]).all()
        env.close()
    assert (rows[0]["picture"][0] != rows[0]["picture"][1]).any(), "other scenes"
    vector.close()


HELD = """
import ctypes, sys
from importlib.machinery import ModuleSpec
from pathlib import Path
import gymnasium, pyfranka.gym
from pyfranka.sim import Simulation

COUNT = 4
def held():  # [pages], without what malloc keeps for later
    ctypes.CDLL(None).malloc_trim(0)
    return int(Path("/proc/self/statm").read_text().split()[1])

options = {"render_mode": "rgb_array"}
makers = {
    "simulation": lambda: [Simulation() for _ in range(COUNT)],
    "environment": lambda: [gymnasium.make("pyfranka/Reach-v0", **options) for _ in range(COUNT)],
    "vector": lambda: [gymnasium.make_vec("pyfranka/Reach-v0", num_envs=COUNT, **options)],
}
everything = []  # nothing is freed because nobody refers to it
for name, maker in {"warm-up": makers["simulation"], **makers}.items():
    ones = maker()
    everything += ones
    if not isinstance(ones[0], Simulation):
        for one in ones:
            one.reset(seed=1)
    before = held()
    for one in ones:
        one.render()
    drawn = held()
    for one in ones:
        one.close()
    print(name, drawn - before, held() - before)
"""


def test_closing_frees_what_pictures_need():
    # This driver draws into memory of the process.
    environment = {**os.environ, "FRANKA_SIM_RENDERER": "osmesa"}
    printed = subprocess.check_output([sys.executable, "-c", HELD], text=True, timeout=300, env=environment)
    _, *rows = (line.split() for line in printed.splitlines())
    assert [row[0] for row in rows] == ["simulation", "environment", "vector"]
    for name, drawn, closed in rows:
        assert int(closed) < int(drawn) / 2, (name, drawn, closed)


ASYNCHRONOUS = """
import gymnasium, numpy, pyfranka.gym
def vector(mode):
    options = {"observation": "state+pictures", "size": (32, 24)}
    env = gymnasium.make_vec("pyfranka/Push-v0", num_envs=2, vectorization_mode=mode, **options)
    env.action_space.seed(1)
    return env
def run(env):
    seen = [env.reset(seed=3)[0]] + [env.step(env.action_space.sample())[0] for _ in range(4)]
    env.close()
    return seen
one, two = run(vector("async")), run(vector("sync"))
print(all((a[part] == b[part]).all() for a, b in zip(one, two) for part in a))
print(one[-1]["picture"].shape, one[-1]["picture"].std() > 5.0)
env = vector("async")  # sync has drawn in this process
try:
    env.reset(seed=3)
except RuntimeError as error:
    print(error)
env.close(terminate=True)
"""


def test_gymnasiums_vector_of_forked_processes_gives_the_same_unless_a_picture_was_drawn_before():
    ran = subprocess.run([sys.executable, "-c", ASYNCHRONOUS], capture_output=True, text=True, timeout=300)
    assert ran.returncode == 0, ran.stderr
    equal, picture, *refusal = ran.stdout.splitlines()
    assert (equal, picture) == ("True", "(2, 24, 32, 3) True")
    assert "Pictures were drawn before this process was forked" in refusal[0]
