# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.gym: the tasks as environments of Gymnasium."""

import itertools
import os
import re
import subprocess
import sys
import warnings
from importlib.machinery import ModuleSpec
from pathlib import Path
from unittest.mock import MagicMock

import gymnasium
import numpy as np
import pyfranka.gym
import pytest
from gymnasium.error import ClosedEnvironmentError, ResetNeeded
from gymnasium.utils.env_checker import check_env
from pyfranka import ArmLimits
from pyfranka.gym import scripted_policy

TOP = Path(__file__).resolve().parents[2]
TASKS = ("Reach", "Push", "PickAndPlace", "HandOver")
CONTROLS = ("torque", "joint_delta", "cartesian_delta")
ROBOTS_TAKE_TURNS = True
PROTOCOLS = {"panda": 5, "fr3": 9}
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


@pytest.mark.parametrize("maker", [make, lambda task, **options: make_vec(task, 2, **options)])
def test_an_unknown_option_is_refused_with_the_known_ones(maker):
    with pytest.raises(TypeError, match="no option 'hue'; its options are robot, control.*, render_size"):
        maker("Reach", hue="red")


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


@pytest.mark.parametrize("task", TASKS)
def test_its_script_solves_a_task(task, name, long_run):
    env = make(task, robot=name)
    for seed in range(20 if long_run else 1 if task == "HandOver" else 2):
        info, rewards = play(env, seed)
        assert info["is_success"], (seed, info)
        assert info["reflexes"] == 0, (seed, info)
        assert rewards[-1] == 0.0 and set(rewards[:-1]) == {-1.0}, "sparse"
    env.close()


@pytest.mark.long_form("ten seeds a task")
@pytest.mark.parametrize("task", TASKS)
def test_its_script_solves_a_task_of_a_realistic_robot(task, name):
    env = make(task, robot=name, randomize={"realism": "recorded"})
    assert sum(play(env, seed)[0]["is_success"] for seed in range(10)) >= 8


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("task", ("PickAndPlace", "HandOver"))
def test_random_actions_never_fail(task, control):
    env = make(task, control=control, max_episode_steps=10**6)
    env.action_space.seed(1)
    env.reset(seed=1)
    for _ in range(100):
        observation, reward, terminated, _, info = env.step(env.action_space.sample())
        assert all(np.isfinite(part).all() for part in observation.values()) and np.isfinite(reward)
        assert not terminated
    if control == "cartesian_delta":
        assert info["reflexes"] == 0
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


def test_actions_have_the_documented_effect():
    env = make("Reach")
    layout = env.unwrapped.layout
    observation, _ = env.reset(seed=1)
    before = observation["observation"][layout["panda.position"]].copy()
    for _ in range(20):
        observation, *_ = env.step(np.array([0, 0.5, 0, 0, 0, 0], dtype=np.float32))
    for _ in range(10):
        observation, *_ = env.step(np.zeros(6, dtype=np.float32))
    way = observation["observation"][layout["panda.position"]] - before
    assert way == pytest.approx([0, 0.125, 0], abs=0.01), "half of 0.25 m/s for a second"
    env.close()

    env = make("Reach", control="joint_delta")
    observation, _ = env.reset(seed=1)
    q = observation["observation"][layout["panda.q"]].copy()
    for _ in range(20):
        observation, *_ = env.step(np.array([0.5, 0, 0, 0, 0, 0, -0.5], dtype=np.float32))
    for _ in range(10):
        observation, *_ = env.step(np.zeros(7, dtype=np.float32))
    moved = observation["observation"][layout["panda.q"]] - q
    assert moved == pytest.approx([0.5, 0, 0, 0, 0, 0, -0.5], abs=0.02), "half of 1 rad/s for a second"
    env.close()


@pytest.mark.parametrize("frequency", [2, 100])
def test_the_frequency_changes_neither_speed_nor_time(frequency):
    env = make("Reach", frequency=frequency, max_episode_steps=1000)
    layout = env.unwrapped.layout
    observation, _ = env.reset(seed=1, options={"goal": [0.9, 0.9, 0.9]})
    before = observation["observation"][layout["panda.position"]].copy()
    for _ in range(frequency):
        observation, *_ = env.step(np.array([0, 0.5, 0, 0, 0, 0], dtype=np.float32))
    assert env.unwrapped.simulation.ticks == 1000
    way = observation["observation"][layout["panda.position"]] - before
    assert way[1] == pytest.approx(0.125, abs=0.02)
    env.close()


def test_goals_rewards_and_success_agree():
    env = make("PickAndPlace", reward="dense")
    info, rewards = play(env, seed=1)
    assert info["is_success"] and rewards[0] < -0.6 and rewards[-1] > -0.1
    assert np.mean(rewards[-10:]) > np.mean(rewards[:10]) + 0.4
    env.close()

    sparse = make("PickAndPlace").unwrapped
    tray, lying = np.array([0.0, 0.2, 0.475]), np.array([1.0])
    desired = np.array([*tray, *lying])
    away = np.stack([desired, desired + [0.04, 0, 0, 0], desired + [0.06, 0, 0, 0], desired - [0, 0, 0, 1]])
    assert sparse.compute_reward(away, np.tile(desired, (4, 1)), [{}] * 4).tolist() == [0, 0, -1, -1]
    assert sparse.compute_reward(away[2], desired, {}) == -1.0
    sparse.close()


@pytest.mark.parametrize("reward", ["sparse", "dense"])
@pytest.mark.parametrize("task", TASKS)
def test_rewards_come_from_goals_alone(task, reward):
    """As replay with other goals needs it: HerReplayBuffer gives empty infos."""
    env = make(task, reward=reward)
    env.reset(seed=1)
    steps = [env.step(env.action_space.sample()) for _ in range(5)]
    goals = [np.stack([step[0][name] for step in steps]) for name in ("achieved_goal", "desired_goal")]
    rewards = [step[1] for step in steps]
    assert env.unwrapped.compute_reward(*goals, np.array([{}] * 5)).tolist() == rewards
    assert env.unwrapped.compute_reward(goals[0][0], goals[1][0], {}) == rewards[0]
    if reward == "dense":
        info, achieved = steps[-1][4], goals[0][-1]
        assert task == "Reach" or achieved[-1] == pytest.approx(info["reach"], abs=1e-6)
        near = env.unwrapped.compute_reward(achieved, achieved, {})
        assert near == pytest.approx(-info["reach"], abs=1e-6)
    env.close()


def test_stone_held_over_the_tray_is_not_a_success():
    env = make("PickAndPlace", max_episode_steps=1000)
    observation, _ = env.reset(seed=1)
    policy, touched, nearest = scripted_policy(env), False, 1.0
    for _ in range(200):
        action = policy(observation)
        if touched:
            action[-1] = -1.0  # never lets go
        observation, _, terminated, _, info = env.step(action)
        touched = touched or observation["achieved_goal"][2] > 0.5
        away = (observation["achieved_goal"] - observation["desired_goal"])[:3]
        nearest = min(nearest, np.linalg.norm(away))
        assert not terminated and not info["is_success"]
    assert touched and nearest < 0.02 and observation["achieved_goal"][3] == 0.0
    env.close()


def test_reset_takes_options():
    env = make("PickAndPlace")
    q = [0.1, -0.7, 0.0, -2.3, 0.0, 1.6, 0.8]
    options = {"q": q, "object": [0.02, -0.2, 0.475], "goal": [0.0, 0.23, 0.475]}
    observation, _ = env.reset(seed=1, options=options)
    layout = env.unwrapped.layout
    assert observation["observation"][layout["panda.q"]] == pytest.approx(q)
    assert observation["observation"][layout["stone.position"]] == pytest.approx(options["object"])
    assert observation["desired_goal"] == pytest.approx([*options["goal"], 1.0])
    assert observation["observation"][layout["panda.width"]] == pytest.approx(0.08, abs=1e-3), "open"
    env.close()


def struck(env):
    """The first step after a blow to the hand that causes a reflex."""
    env.reset(seed=1)
    env.step(np.zeros(7, dtype=np.float32))
    env.unwrapped.simulation.push("panda_hand", [0, 0, 150], ticks=10)
    for _ in range(5):
        _, _, terminated, _, info = env.step(np.zeros(7, dtype=np.float32))
        if info["reflexes"]:
            break
    return terminated, info


def test_a_reflex_is_recovered_or_ends_the_episode():
    env = make("Reach", control="joint_delta", on_reflex="terminate")
    terminated, info = struck(env)
    assert terminated and info["reflexes"] == 1 and not info["is_success"]
    env.close()
    env = make("Reach", control="joint_delta")
    terminated, info = struck(env)
    assert not terminated and info["reflexes"] == 1
    robot = env.unwrapped.simulation["panda"]
    for _ in range(20):
        *_, truncated, info = env.step(np.array([0.5, 0, 0, 0, 0, 0, 0], dtype=np.float32))
    assert robot.moving and not robot.state.current_errors and info["reflexes"] == 1, "it moves again"
    assert robot.state.dq[0] == pytest.approx(0.5, abs=0.1) and not truncated
    env.close()


def test_an_arm_that_cannot_be_recovered_ends_the_episode():
    env = make("Reach", control="torque")
    env.reset(seed=1)
    sim = env.unwrapped.simulation
    sim["panda"].command(torque=[0, 0, 0, 10, 0, 0, 0], limit_rate=True, damping=[10.0] * 7)
    sim.step(4000)
    assert "joint_position_limits_violation" in str(sim["panda"].state.current_errors)
    ended = [env.step(np.zeros(7, dtype=np.float32))[3] for _ in range(25)]
    assert not any(ended[:15]) and ended[24], "after a second"
    env.close()


def test_torques_do_not_drive_a_joint_against_its_limit(name):
    env = make("Reach", robot=name, control="torque", max_episode_steps=10**6)
    env.reset(seed=1, options={"goal": [2, 2, 2]})
    for joint in range(7):
        for sign in (1, -1):
            action = np.zeros(7, dtype=np.float32)
            action[joint] = sign
            env.reset(seed=1, options={"goal": [2, 2, 2]})
            for _ in range(80):
                *_, info = env.step(action)
            errors = str(env.unwrapped.simulation[name].state.last_motion_errors)
            assert "position_limits" not in errors, (joint, sign)
    env.close()


def test_each_episode_may_have_another_robot_and_another_stone():
    env = make("PickAndPlace", randomize=RANDOMIZE)
    seen, forces = set(), set()
    for seed in (1, 2, 1):
        env.reset(seed=seed)
        sim = env.unwrapped.simulation
        robot = sim["panda"]
        sim.step(500)
        pressed = sum(c.force[2] for c in sim.contacts() if c.body2 == "stone")
        pressed -= sum(c.force[2] for c in sim.contacts() if c.body1 == "stone")
        forces.add(round(pressed / 9.81, 4))
        seen.add((robot.setup.base[2], robot.setup.realism, float(robot.state.m_load), sim.state_hash()))
    assert len(seen) == 2, "the same seed, the same episode"
    assert len(forces) == 2 and all(0.5 * 0.1 < mass < 2.0 * 0.11 for mass in forces), "the stone's weight"
    env.close()


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


def video(episodes, steps, **options):
    """Plays a script, and yields a picture of each step, as gymnasium.wrappers.RecordVideo takes them."""
    env = make(render_size=(64, 48), render_mode="rgb_array", **options)
    for seed in range(episodes):
        observation, _ = env.reset(seed=seed)
        policy = scripted_policy(env)
        for _ in range(steps):
            observation, *_ = env.step(policy(observation))
            yield env.render()
    env.close()


def test_videos_of_two_environments_side_by_side_equal_those_of_each_alone():
    long = {"episodes": 1, "steps": 24, "task": "Push", "robot": "fr3"}
    # Each episode has a new simulation, and the end comes half-way.
    short = {"episodes": 2, "steps": 6, "task": "PickAndPlace", "randomize": RANDOMIZE}
    alone = list(video(**long)), list(video(**short))
    pairs = list(itertools.zip_longest(video(**long), video(**short)))
    together = [pair[0] for pair in pairs], [pair[1] for pair in pairs[:12]]
    for one, other in zip(alone, together):
        assert all(picture.std() > 5.0 for picture in other), "none is black"
        assert len(one) == len(other) and all((a == b).all() for a, b in zip(one, other))
    assert [one.shape for one in together[0]] == [(48, 64, 3)] * 24


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


def test_a_script_needs_its_control():
    with pytest.raises(ValueError, match="need cartesian_delta"):
        scripted_policy(make("Reach", control="torque"))


def test_calls_at_the_wrong_time_are_refused_with_a_sentence():
    for env, shape in (
        (pyfranka.gym.Environment("Reach"), (6,)),
        (pyfranka.gym.VectorEnvironment(2, task="Reach"), (2, 6)),
    ):
        with pytest.raises(ResetNeeded, match="before the first step"):
            env.step(np.zeros(shape))
        env.reset(seed=1)
        env.close()
        env.close()
        for call in (env.reset, lambda env=env, shape=shape: env.step(np.zeros(shape)), env.render):
            with pytest.raises(ClosedEnvironmentError, match="is closed"):
                call()


def test_tasks_are_found_by_the_name_of_their_module():
    code = "import gymnasium; gymnasium.make('pyfranka.gym:pyfranka/Reach-v0').reset(seed=1)"
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_the_example_of_the_documentation_runs(capsys):
    page = Path(__file__).resolve().parents[2] / "docs" / "gym.md"
    code = page.read_text().partition("```python\n")[2].partition("```")[0]
    exec(compile(code, str(page), "exec"), {})
    assert capsys.readouterr().out.split() == ["True", "0"]


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
