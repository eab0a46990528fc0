# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sim: robots that a Python program steps in its own process."""

import math
import threading
import time
from pathlib import Path

import contact_motion
import numpy as np
import pyfranka
import pyfranka.sim
import pytest
from contact_motion import SCENE, TICKS, down_and_back, press
from fci_session import go_first, go_with_all, simulated
from pyfranka.sim import FR3, KINDS, GripperOutcome, Panda, RequestRefused, Simulation

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
LOOSE = [100.0] * 7, [100.0] * 7, [300.0] * 6, [300.0] * 6
TORQUES = np.array([0.5, -1.0, 0.3, 0.8, 0.1, -0.2, 0.05])  # [Nm]


@pytest.fixture
def sim(name):
    with Simulation(robots=[KINDS[name]()]) as simulation:
        yield simulation


@pytest.fixture
def arm(sim, name):
    return sim[name]


def hash_over_fci(name):
    """The robot's hash of a motion by a client in lock-step, and the joint positions at its start."""
    go_first()
    try:
        with simulated(name, "lockstep", *SCENE) as served:
            first = press(served.address, served.protocol)
            return served.remote.hash(), first
    finally:
        go_with_all()


def test_a_motion_has_the_same_hash_in_this_process_and_over_the_network(name):
    expected, first = hash_over_fci(name)
    with Simulation(contact_motion.WORLD, [KINDS[name](base=contact_motion.BASE)]) as sim:
        robot = sim[name]
        robot.set_collision_behavior(*LOOSE)
        pressed = 0.0
        for k in range(TICKS + 1):
            robot.command(joint_positions=down_and_back(first, k))
            if k == TICKS:
                robot.finish()
            sim.step()
            pressed = max(pressed, abs(robot.state.tau_ext_hat_filtered[1]))
        assert pressed > 10.0, "the hand touches the table"
        hashes = set()
        for _ in range(2000):  # a served world runs on until it rests
            hashes.add(robot.hash())
            sim.step()
        assert expected in hashes


def test_each_kind_of_command_moves_the_arm(sim, name):
    robot = sim[name]
    start = robot.state.copy()

    def ramp(k):
        return 0.02 * (1 - math.cos(math.pi * min(k / 500, 1.0))) / 2

    def speed(k):
        return 0.02 * math.pi * math.sin(math.pi * min(k / 500, 1.0)) / 2 / 0.5

    shift = np.zeros((4, 4))
    shift[2, 3] = 1.0
    kinds = {
        "joint_positions": lambda k: start.q_d + ramp(k),
        "joint_velocities": lambda k: np.full(7, speed(k)),
        "cartesian_pose": lambda k: start.O_T_EE_d + shift * ramp(k),
        "cartesian_velocities": lambda k: [0, 0, speed(k), 0, 0, 0],
        "torque": lambda k: TORQUES * speed(k) / speed(250),
    }
    for kind_of_command, value in kinds.items():
        sim.reset()
        for k in range(1, 501):
            robot.command(**{kind_of_command: value(k)})
            sim.step()
            assert robot.moving, (kind_of_command, k, str(robot.state.last_motion_errors))
        robot.finish()
        sim.step(1000)
        assert not robot.moving and not robot.state.current_errors, kind_of_command
        if kind_of_command.startswith("joint"):
            assert robot.state.q == pytest.approx(start.q + 0.02, abs=1e-3)
        elif kind_of_command.startswith("cartesian"):
            assert robot.state.O_T_EE[2, 3] == pytest.approx(start.O_T_EE[2, 3] + 0.02, abs=1e-3)
        else:
            assert np.abs(robot.state.q - start.q).max() > 1e-3


def test_laws_in_cpp_run_below_a_slow_policy(sim, arm):
    target = arm.state.q + 0.1
    arm.joint_impedance(target, duration=0.5, stiffness=[800.0] * 4 + [300.0] * 3)
    for _ in range(20):
        sim.step(50)
    assert arm.state.q == pytest.approx(target, abs=2e-3)
    arm.finish()
    sim.step(500)
    pose = arm.state.O_T_EE.copy()
    pose[:3, 3] += [0.03, 0.02, -0.04]
    arm.cartesian_impedance(pose, duration=0.5)
    sim.step(2000)
    assert arm.state.O_T_EE == pytest.approx(pose, abs=2e-3)


def test_targets_that_follow_each_other_move_at_constant_speed(sim, arm):
    def spread(linear):
        sim.reset()
        target, speeds = arm.state.q.copy(), []
        for _ in range(20):
            target[0] += 0.02
            arm.joint_impedance(target, duration=0.05, linear=linear)
            for _ in range(50):
                sim.step()
                speeds.append(arm.state.dq[0])
        return np.mean(speeds[500:]), np.std(speeds[500:])

    mean, deviation = spread(linear=True)
    assert mean == pytest.approx(0.4, rel=0.02) and deviation < 0.01
    assert spread(linear=False)[1] > 0.05, "from rest to rest"


def test_torques_in_steps_pass_with_their_rate_limited(sim, arm):
    step = np.array([0, 0, 0, 10.0, 0, 0, 0])
    arm.command(torque=step)
    sim.step(5)
    assert "controller_torque_discontinuity" in str(arm.state.last_motion_errors)
    sim.reset()
    arm.command(torque=step, limit_rate=True)
    sim.step(5)
    assert arm.moving and 3.0 < arm.state.tau_J_d[3] < 5.0, "1 Nm per tick"
    sim.step(10)
    assert arm.moving and arm.state.tau_J_d == pytest.approx(step)
    sim.reset()
    arm.command(torque=step, limit_rate=True)
    arm.command(torque=step)
    sim.step(5)
    assert not arm.moving, "each command says for itself whether its rate is limited"


def test_torques_can_be_damped(sim, arm):
    swing = np.array([2.0, 0, 0, 0, 0, 0, 0])
    arm.command(torque=swing, limit_rate=True, damping=[10.0] * 7)
    sim.step(1000)
    assert arm.state.dq[0] == pytest.approx(0.2, rel=0.05), "torque over damping"
    assert arm.state.tau_J_d == pytest.approx(swing - 10.0 * arm.state.dq, abs=0.02)


def test_damping_of_the_joints_ends_a_swing(sim, arm):
    def overshoot(damping):
        sim.reset()
        target, beyond = arm.state.O_T_EE.copy(), 0.0
        for k in range(40):
            target[0, 3] += 0.0125 if k < 12 else 0.0
            arm.cartesian_impedance(target, duration=0.05, linear=True, damping=damping)
            sim.step(50)
            beyond = max(beyond, arm.state.O_T_EE[0, 3] - target[0, 3])
        return beyond

    assert overshoot(None) > 5e-3
    assert overshoot([5.0] * 4 + [1.0] * 3) < 2e-3


def test_what_a_robot_refuses_is_said_and_it_recovers(sim, arm):
    arm.command(joint_positions=arm.state.q_d)
    sim.step(5)
    with pytest.raises(RequestRefused, match="another kind"):
        arm.command(torque=TORQUES)
    with pytest.raises(RequestRefused, match="in mode Move"):
        arm.set_load(0.1, [0, 0, 0], np.zeros(9))
    arm.command(joint_positions=arm.state.q_d + 0.5)
    sim.step(5)
    assert arm.state.robot_mode == pyfranka.RobotMode.Reflex
    assert "joint_motion_generator_velocity_discontinuity" in str(arm.state.last_motion_errors)
    with pytest.raises(RequestRefused, match=r"mode Reflex: .*Recover it first"):
        arm.command(torque=TORQUES)
    arm.recover()
    sim.step(2000)
    assert arm.state.robot_mode == pyfranka.RobotMode.Idle
    arm.set_user_stop(True)
    sim.step(500)
    assert arm.state.robot_mode == pyfranka.RobotMode.UserStopped and arm.brakes_closed
    sim.reset()
    assert arm.state.robot_mode == pyfranka.RobotMode.Idle and not arm.brakes_closed


def test_a_command_to_a_motion_that_ends_is_refused(sim, arm):
    arm.joint_impedance(arm.state.q)
    sim.step(5)
    arm.finish()
    for call in (lambda: arm.command(torque=TORQUES), lambda: arm.joint_impedance(arm.state.q)):
        with pytest.raises(RequestRefused, match="is ending"):
            call()
    sim.step(500)
    arm.command(torque=TORQUES)
    assert arm.moving


def test_bad_input_is_refused_with_a_sentence_and_changes_nothing(sim, arm):
    sim.step(10)
    before = sim.hash(), arm.state.q.copy()
    refused = {
        "torque needs 7 numbers, not 2": lambda: arm.command(torque=[1, 2]),
        "torque must be finite": lambda: arm.command(torque=[math.nan] * 7),
        "A command is one of": lambda: arm.command(),
        "given: torque, joint_positions": lambda: arm.command(torque=TORQUES, joint_positions=TORQUES),
        "An elbow goes with": lambda: arm.command(torque=TORQUES, elbow=[0, 1]),
        "limit_rate and damping go": lambda: arm.command(joint_positions=TORQUES, limit_rate=True),
        "damping must not be": lambda: arm.command(torque=TORQUES, damping=[-1.0] * 7),
        "controller is joint_impedance or": lambda: arm.command(joint_positions=TORQUES, controller="soft"),
        "stiffness must lie between": lambda: arm.joint_impedance(TORQUES, stiffness=[-1.0] * 7),
        "duration must be": lambda: arm.joint_impedance(TORQUES, duration=-1.0),
        "target": lambda: arm.cartesian_impedance(np.ones((4, 4))),
        "Time goes forwards": lambda: sim.step(-1),
        "no body 'nothing'": lambda: sim.body_pose("nothing"),
        "Joint 4 of": lambda: sim.reset(q=np.ones(7)),
        "q is 7 numbers or 'random'": lambda: sim.reset(q="anywhere"),
        "no robot 'ur5'": lambda: sim.reset(q={"ur5": "random"}),
        "no body 'brick'": lambda: sim.reset(objects={"brick": [0, 0, 1]}),
        "3 or 7 finite numbers": lambda: sim.reset(objects={"world": [0, 0]}),
        "q needs 7 numbers": lambda: sim.reset(q=[1, 2]),
        "is not free to move": lambda: sim.place_body(f"{arm.name}_hand", [0, 0, 1]),
        "must be finite": lambda: sim.push("nothing", [math.inf, 0, 0]),
        "10 kg": lambda: arm.set_load(100.0, [0, 0, 0], np.zeros(9)),
    }
    for sentence, call in refused.items():
        with pytest.raises((ValueError, RuntimeError, KeyError)) as caught:
            call()
        assert sentence in str(caught.value)
        assert not arm.moving and sim.ticks == 10, sentence
    assert sim.hash() == before[0] and (arm.state.q == before[1]).all()


def test_robots_and_worlds_that_cannot_be_used_are_refused():
    for sentence, arguments in {
        "no world 'moon.xml'": {"world": "moon.xml"},
        "Two robots have the name 'a'": {"robots": [Panda("a"), FR3("a", base=(0, 1, 0))]},
        "robots are Panda": {"robots": ["panda"]},
        "base needs x, y, z": {"robots": [Panda(base=(1, 2))]},
        "base must be finite": {"robots": [Panda(base=(math.nan, 0, 0))]},
        "'reel' is not known": {"robots": [Panda(realism="reel")]},
        "Cannot read the file": {"robots": [Panda(urdf="/nowhere.urdf")]},
    }.items():
        with pytest.raises((ValueError, RuntimeError, TypeError)) as caught:
            Simulation(**arguments)
        assert sentence in str(caught.value)
    with Simulation(robots=[]) as empty:
        empty.step(5)
        assert not list(empty) and empty.ticks == 5
    with pytest.warns(UserWarning, match="another base"):
        Simulation(robots=[Panda(), FR3()]).close()


def test_several_robots_share_a_world_and_have_names():
    with Simulation(robots=[Panda(), Panda(base=(0, 1, 0, 1.57)), FR3(base=(0, -1, 0), hand=False)]) as sim:
        assert list(sim) == ["panda", "panda_2", "fr3"]
        sim["panda_2"].joint_impedance(sim["panda_2"].state.q + 0.1, 0.3)
        before = sim["panda"].state.q.copy()
        sim.step(600)
        assert sim["panda"].state.q == pytest.approx(before, abs=1e-6)
        assert sim["panda_2"].state.q == pytest.approx(before + 0.1, abs=2e-2)
        with pytest.raises(RuntimeError, match="has no hand"):
            _ = sim["fr3"].gripper


def test_the_hand_grasps_while_the_simulation_steps(arm, sim):
    opening = arm.gripper.move(0.08)
    assert not opening.done
    sim.step(1500)
    assert opening.succeeded and arm.gripper.width == pytest.approx(0.08, abs=1e-3)
    nothing = arm.gripper.grasp(0.03, 0.1, 20.0)
    sim.step(2000)
    assert nothing.outcome == GripperOutcome.Failed and not arm.gripper.is_grasped
    assert arm.gripper.move(1.0).outcome == GripperOutcome.Failed, "no hand opens a metre"
    homing = arm.gripper.homing()
    sim.step(10)
    arm.gripper.stop()
    assert homing.outcome == GripperOutcome.Interrupted


def test_realism_is_chosen_robot_by_robot(name):
    def pushed(realism, seed=1):
        """Joint 1 after a push from the side and after its end."""
        with Simulation(robots=[KINDS[name](realism=realism)], seed=seed) as sim:
            sim.push(f"{name}_hand", [0, 8, 0], ticks=1000)
            sim.step(6000)
            return sim[name].state.q[0], sim[name].state.tau_J.copy()

    start = pushed("ideal")
    with Simulation(robots=[KINDS[name]()]) as sim:
        rest = sim[name].state.q[0]
    assert start[0] == pytest.approx(rest, abs=1e-6), "without friction it returns"
    assert abs(pushed("real")[0] - rest) > 1e-5, "friction holds it"
    noisy = pushed("recorded", 1), pushed("recorded", 1), pushed("recorded", 2)
    assert (noisy[0][1] == noisy[1][1]).all(), "the same seed, the same bits"
    assert (noisy[0][1] != noisy[2][1]).any()
    fixed = pushed("recorded,seed=5", 1), pushed("recorded,seed=5", 2)
    assert (fixed[0][1] == fixed[1][1]).all(), "a seed of its own"


def test_random_joints_are_within_the_limits_and_repeat(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)], seed=4) as sim:
        robot, seen = sim[name], []
        lowest, highest = robot.limits
        for _ in range(30):
            sim.reset(q="random")
            q = robot.state.q.copy()
            assert (lowest <= q).all() and (q <= highest).all()
            assert not any(c.body1.startswith(name) or c.body2.startswith(name) for c in sim.contacts())
            assert sim.ticks == 0
            sim.step(200)
            assert robot.state.q == pytest.approx(q, abs=1e-3) and not robot.state.current_errors
            seen.append(q)
        assert len({tuple(q) for q in seen}) == 30
        sim.reset(q={name: "random"}, seed=4)
        first = robot.state.q.copy()
        sim.reset(q="random", objects={"stone": [0.1, 0.2, 0.6]}, seed=4)
        assert (robot.state.q == first).all() and sim.body_pose("stone")[0] == pytest.approx([0.1, 0.2, 0.6])
        assert (first == seen[0]).all(), "of the same seed"


def test_a_snapshot_brings_the_world_back(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)]) as sim:
        sim.step(300)
        snapshot, before = sim.snapshot(), sim.hash()
        sim.push("stone", [3, 0, 0], ticks=100)
        sim[name].joint_impedance(sim[name].state.q + 0.2, 0.2)
        sim.step(300)
        assert sim.hash() != before
        sim.restore(snapshot)
        assert sim.hash() == before and sim.ticks == 300 and not sim[name].moving


def test_state_arrays_are_live_views_that_cannot_be_written(sim, arm):
    q, state = arm.state.q, arm.state.copy()
    before = q.copy()
    arm.joint_impedance(q + 0.1, 0.1)
    sim.step(300)
    assert (q != before).all() and (state.q == before).all()
    assert arm.state.O_T_EE.shape == (4, 4) and isinstance(state, pyfranka.RobotState)
    with pytest.raises(ValueError, match="read-only"):
        q[0] = 1.0
    gravity = arm.model.gravity(arm.state)
    arm.finish()
    sim.step(2000)
    assert arm.state.tau_J == pytest.approx(arm.model.gravity(arm.state), abs=1e-3)
    assert arm.model.pose(pyfranka.Frame.EndEffector, arm.state) == pytest.approx(arm.state.O_T_EE, abs=1e-12)
    del sim, arm
    assert gravity.shape == (7,) and np.isfinite(q).all(), "a view keeps the simulation"


def test_a_simulation_is_for_one_thread_at_a_time_and_lets_others_run(sim):
    refused = []
    deadline = time.monotonic() + 60

    def step_until_refused():
        while not refused and time.monotonic() < deadline:
            try:
                sim.step(500)
            except RuntimeError as error:
                refused.append(str(error))

    workers = [threading.Thread(target=step_until_refused) for _ in range(2)]
    for worker in workers:
        worker.start()
    for worker in workers:
        worker.join()
    assert refused, "while one steps, the other one runs"
    assert all("Another thread uses this simulation" in error for error in refused)
    sim.step()


def test_a_closed_simulation_says_so(sim, arm):
    sim.close()
    sim.close()
    for call in (sim.step, sim.reset, sim.bodies, arm.recover, lambda: arm.command(torque=TORQUES)):
        with pytest.raises(RuntimeError, match="is closed"):
            call()


def test_pictures_come_as_arrays(name):
    with Simulation("stone.xml", [KINDS[name](base=BASE)]) as sim:
        picture = sim.render(width=160, height=120)
        assert picture.rgb.shape == (120, 160, 3) and picture.rgb.std() > 10.0
        with pytest.raises(RuntimeError, match="no camera"):
            sim.render("nowhere")


@pytest.mark.filterwarnings("error")  # of exceptions in threads
def test_the_examples_of_the_documentation_run(capsys):
    page = Path(__file__).resolve().parents[2] / "docs" / "python.md"
    first, served, batch = (block.partition("```")[0] for block in page.read_text().split("```python\n")[1:4])
    exec(compile(first, str(page), "exec"), {})
    outcome, error, seconds = capsys.readouterr().out.split()
    assert outcome == "GripperOutcome.Succeeded"
    assert abs(float(error)) < 2e-3 and float(seconds) == 4.5
    exec(compile(served.replace("127.0.0.1", "127.0.33.20"), str(page), "exec"), {})
    assert capsys.readouterr().out == "RobotMode.Idle\n"
    exec(compile(batch, str(page), "exec"), {})
    assert float(capsys.readouterr().out) < 5e-3
