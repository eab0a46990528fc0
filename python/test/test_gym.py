# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.gym: the tasks as environments of Gymnasium, their spaces, options and random numbers."""

import re
import subprocess
import sys
import warnings
from pathlib import Path

import numpy as np
import page_output
import pyfranka.gym
import pytest
from gym_tasks import TASKS, make, make_vec, same
from gymnasium.error import ResetNeeded
from gymnasium.utils.env_checker import check_env
from pyfranka import ArmLimits

TOP = Path(__file__).resolve().parents[2]
PROTOCOLS = {"panda": 5, "fr3": 9}
ROBOTS_TAKE_TURNS = True


@pytest.mark.parametrize(
    ("task", "robot", "control"),
    [
        ("Reach", "panda", "torque"),
        ("Push", "fr3", "joint_delta"),
        ("PickAndPlace", "panda", "cartesian_delta"),
        ("HandOver", "fr3", "cartesian_delta"),
    ],
)
def test_the_checker_of_gymnasium_passes(task, robot, control):
    env = make(task, robot=robot, control=control)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        check_env(env.unwrapped, skip_render_check=True)
    env.close()


def documented_bounds(task, robot):
    """The table of docs/gym.md: lowest and highest values of the parts of the vector "observation", and of
    a goal."""
    rows = {}
    for line in (TOP / "docs" / "gym.md").read_text().splitlines():
        if found := re.fullmatch(r"\| (`.+) \| (\S+) to (\S+) \|", line):
            rows.update(
                dict.fromkeys(re.findall("`([^`]+)`", found[1]), tuple(map(float, found.group(2, 3))))
            )
    env = make(task, robot=robot, reward="dense").unwrapped
    setup = {each.setup.name: each.setup for each in env.simulation.values()}
    limits = {
        "q": [env.simulation[name].limits for name in setup],
        "dq": [(-ArmLimits(PROTOCOLS[robot]).dq, ArmLimits(PROTOCOLS[robot]).dq)] * len(setup),
    }
    low, high = np.full((2, env.observation_space["observation"].shape[0]), np.nan)
    for part, where in env.layout.items():
        name, _, field = part.partition(".")
        if field in limits:
            low[where], high[where] = limits[field].pop(0)
        elif name in setup and field == "position":
            base = np.array(setup[name].base[:3])
            low[where], high[where] = (base + end for end in rows["position"])
        elif field == "position":
            low[where], high[where] = zip(rows["x, y"], rows["x, y"], rows["z"])
        elif field == "quaternion":
            low[where], high[where] = zip(rows["quaternion w"], *[rows["quaternion x, y, z"]] * 3)
        else:
            low[where], high[where] = rows[field]
    flags = len(env.options.kind.flags)
    goal = [rows["x, y"]] * 2 + [rows["z"]] + [rows["flags"]] * flags
    goal += [rows["reach"]] * (task != "Reach")
    env.close()
    return env.observation_space, (low, high), np.transpose(goal)


@pytest.mark.parametrize("task", TASKS)
def test_spaces_have_the_documented_bounds(task, name):
    space, bounds, goal = documented_bounds(task, name)
    for part, (low, high) in {"observation": bounds, "achieved_goal": goal, "desired_goal": goal}.items():
        box = space[part]
        assert box.dtype == np.float32 and box.is_bounded()
        assert (box.low == np.float32(low)).all() and (box.high == np.float32(high)).all(), part
    vector = make_vec(task, 1, robot=name, reward="dense").unwrapped
    assert vector.single_observation_space == space
    vector.close()


def test_what_is_beyond_the_bounds_is_clipped():
    for env, of in (
        (make("Push", disable_env_checker=True), lambda env: env.simulation),
        (make_vec("Push", 1), lambda env: env.episodes[0].sim),
    ):
        env.reset(seed=1)
        of(env.unwrapped).place_body("cube", (9, 0, 50))
        observation, *_ = env.step(np.zeros(env.action_space.shape, dtype=np.float32))
        assert env.observation_space.contains(observation)
        achieved = observation["achieved_goal"].ravel()
        assert achieved[0] == achieved[2] == 2.5, "far away, and high"
        velocity = observation["observation"].ravel()[env.unwrapped.layout["cube.velocity"]]
        assert velocity[0] == velocity[2] == 5.0
        env.close()


def test_the_same_seed_and_actions_give_the_same_bits(name):
    def run(env):
        env.action_space.seed(7)
        seen = [env.reset(seed=5)[0]]
        return seen + [env.step(env.action_space.sample())[0] for _ in range(12)]

    env = make("PickAndPlace", robot=name, realism="recorded")
    first = run(env)
    env.reset(seed=6)
    env.step(env.action_space.sample())
    again = run(env)
    env.close()
    other = make("PickAndPlace", robot=name, realism="recorded")
    fresh = run(other)
    other.close()
    for one, two, three in zip(first, again, fresh):
        assert same(one, two) and same(one, three)
    assert not same(first[0], env_of_another_seed(name))


def env_of_another_seed(name):
    env = make("PickAndPlace", robot=name, realism="recorded")
    observation, _ = env.reset(seed=8)
    env.close()
    return observation


def test_a_step_before_the_first_reset_is_refused():
    for env, shape in (
        (pyfranka.gym.Environment("Reach"), (6,)),
        (pyfranka.gym.VectorEnvironment(2, task="Reach"), (2, 6)),
    ):
        with pytest.raises(ResetNeeded, match="before the first step"):
            env.step(np.zeros(shape))
        env.close()


def test_tasks_are_found_by_the_name_of_their_module():
    code = "import gymnasium; gymnasium.make('pyfranka.gym:pyfranka/Reach-v0').reset(seed=1)"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_without_gymnasium_the_rest_of_pyfranka_works():
    code = (
        "import sys; sys.modules['gymnasium'] = None; import pyfranka.sim; pyfranka.sim.Simulation().step()"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


@pytest.mark.parametrize(("module", "needed"), [("gym", "gymnasium"), ("plot", "matplotlib")])
def test_a_module_whose_extra_is_missing_says_so(module, needed):
    code = f"import sys; sys.modules['{needed}'] = None; import pyfranka.{module}"
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120)
    *_, last = ran.stderr.splitlines()
    assert re.search(rf"pyfranka.{module} needs the Python package {needed}: .*\[{module}\]", last)


def test_the_example_of_the_documentation_runs(capsys):
    (example,) = page_output.examples("gym.md")
    example.run()
    example.check(capsys.readouterr().out)
