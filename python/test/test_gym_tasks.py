# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The tasks of pyfranka.gym: scripts, actions, goals, rewards, and how an episode begins and ends."""

import numpy as np
import pytest
from gym_tasks import RANDOMIZE, TASKS, make, play
from pyfranka.gym import scripted_policy
from pyfranka.gym.environment import Options
from pyfranka.gym.tasks import PickAndPlace

CONTROLS = ("torque", "joint_delta", "cartesian_delta")
ROBOTS_TAKE_TURNS = True


@pytest.mark.parametrize("task", TASKS)
def test_its_script_solves_a_task(task, name, long_run):
    env = make(task, robot=name)
    for seed in range(20 if long_run else 1 if task == "HandOver" else 2):
        info, rewards = play(env, seed)
        assert info["is_success"], (seed, info)
        assert info["reflexes"] == 0, (seed, info)
        assert rewards[-1] == 0.0 and set(rewards[:-1]) == {-1.0}, "sparse"
    env.close()


@pytest.mark.parametrize(("task", "frequency"), zip(TASKS, [10, 25, 200, 50]))
def test_its_script_solves_a_task_at_other_frequencies(task, frequency, name):
    env = make(task, robot=name, frequency=frequency)
    info, _ = play(env, 1)
    assert info["is_success"] and info["reflexes"] == 0
    env.close()


@pytest.mark.long_form("ten seeds a task")
@pytest.mark.parametrize("task", TASKS)
def test_its_script_solves_a_task_of_a_realistic_robot(task, name):
    env = make(task, robot=name, randomize={"realism": "recorded"})
    assert sum(play(env, seed)[0]["is_success"] for seed in range(10)) >= 8


def test_a_script_needs_its_control():
    with pytest.raises(ValueError, match="need cartesian_delta"):
        scripted_policy(make("Reach", control="torque"))


@pytest.mark.parametrize("control", CONTROLS)
@pytest.mark.parametrize("task", ("PickAndPlace", "HandOver"))
def test_random_actions_never_fail(task, control):
    env = make(task, control=control, time_limit=None)
    env.action_space.seed(1)
    env.reset(seed=1)
    for _ in range(100):
        observation, reward, terminated, _, info = env.step(env.action_space.sample())
        assert all(np.isfinite(part).all() for part in observation.values()) and np.isfinite(reward)
        assert not terminated
    if control == "cartesian_delta":
        assert info["reflexes"] == 0
    env.close()


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
    env = make("Reach", frequency=frequency)
    layout = env.unwrapped.layout
    observation, _ = env.reset(seed=1, options={"goal": [0.9, 0.9, 0.9]})
    before = observation["observation"][layout["panda.position"]].copy()
    for _ in range(frequency):
        observation, *_ = env.step(np.array([0, 0.5, 0, 0, 0, 0], dtype=np.float32))
    assert env.unwrapped.simulation.ticks == 1000
    way = observation["observation"][layout["panda.position"]] - before
    assert way[1] == pytest.approx(0.125, abs=0.02)
    env.close()


@pytest.mark.parametrize("task", TASKS)
def test_the_time_limit_is_the_same_at_each_frequency(task):
    limits = {"Reach": 2.5, "Push": 10.0, "PickAndPlace": 15.0, "HandOver": 20.0}
    for ticks in range(1, 1001):
        options = Options(task, frequency=1000 / ticks)
        assert options.ticks == ticks
        assert options.steps * ticks == pytest.approx(1000 * limits[task], abs=ticks / 2)
    assert Options(task, time_limit=None).steps is None
    assert Options(task, time_limit=1.0).steps == 20


@pytest.mark.parametrize("frequency", [5, 100])
def test_an_episode_is_truncated_after_its_time_limit(frequency):
    env = make("Reach", frequency=frequency, time_limit=1.0)
    assert env.spec.max_episode_steps == frequency
    env.reset(seed=1, options={"goal": [2, 2, 2]})
    ended = [env.step(np.zeros(6, dtype=np.float32))[3] for _ in range(frequency)]
    assert ended == [False] * (frequency - 1) + [True]
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

    held, on_tray = [0, 1, 1, 0], [1, 0, 1, 0]  # at the end: both, and neither
    achieved = PickAndPlace.achieved(np.tile(tray, (4, 1)), [], np.array([held, on_tray], dtype=float).T)
    assert achieved[:, 3].tolist() == [1, 0, 0, 0], "it rests if only something else than a robot touches it"


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
    env = make("PickAndPlace")
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
    env = make("Reach", robot=name, control="torque", time_limit=None)
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
