# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka.sim: robots that a Python program steps in its own process."""

import copy
import io
import json
import math
import pickle
import warnings
from functools import partial
from pathlib import Path

import numpy as np
import page_output
import pyfranka
import pyfranka.plot
import pyfranka.sim
import pytest
from PIL import Image
from pyfranka import libfranka
from pyfranka.sim import (
    FR3,
    KINDS,
    GripperOutcome,
    Panda,
    Picture,
    RequestRefused,
    Simulation,
    SimulationBatch,
)

BASE = (-0.5, 0, 0)  # beside the table of stone.xml
TORQUES = np.array([0.5, -1.0, 0.3, 0.8, 0.1, -0.2, 0.05])  # [Nm]
ROBOTS_TAKE_TURNS = True


@pytest.fixture
def sim(name):
    with Simulation(robots=[KINDS[name]()]) as simulation:
        yield simulation


@pytest.fixture
def arm(sim, name):
    return sim[name]


def test_each_kind_of_command_moves_the_arm(sim, name):
    robot = sim[name]
    start = robot.state

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


def elbow_motion(sim, robot, controller, **command):
    """The elbow turns while the end effector stays; how far joint 3 and the end effector have moved."""
    state = robot.live_state
    start, pose = state.elbow_d.copy(), state.O_T_EE_d.copy()
    for k in range(1, 1001):
        way = 0.1 * (1 - math.cos(math.pi * k / 1000)) / 2
        values = {"cartesian_pose": pose} if command["pose"] else {"cartesian_velocities": [0.0] * 6}
        robot.command(**values, elbow=[start[0] + way, start[1]], controller=controller)
        sim.step()
        assert robot.moving, (k, str(state.last_motion_errors))
    robot.finish()
    sim.step(500)
    assert not robot.moving and not state.current_errors
    return state.q[2] - start[0], np.abs(state.O_T_EE - pose).max()


@pytest.mark.parametrize(("controller", "pose"), [("joint_impedance", True), ("cartesian_impedance", False)])
def test_a_commanded_elbow_turns_about_a_resting_end_effector(sim, arm, controller, pose):
    turned, moved = elbow_motion(sim, arm, controller, pose=pose)
    assert turned == pytest.approx(0.1, abs=5e-3) and moved < 2e-3


def test_the_robots_controllers_yield_differently(sim, arm, name):
    """Beside its motion generator: a soft Cartesian controller gives way to a push as its spring says."""
    arm.set_cartesian_impedance([500.0] * 3 + [50.0] * 3)
    arm.set_collision_behavior(*[[100.0] * 7] * 2, *[[100.0] * 6] * 2)

    def pushed(controller):
        sim.reset()
        pose = arm.state.O_T_EE_d.copy()
        for k in range(2500):
            if k == 500:
                before = arm.state.O_T_EE[1, 3]
                sim.push(f"{name}_hand", [0, 5, 0], ticks=2000)
            arm.command(cartesian_pose=pose, controller=controller)
            sim.step()
        assert arm.moving, str(arm.state.last_motion_errors)
        return arm.state.O_T_EE[1, 3] - before

    assert pushed("cartesian_impedance") == pytest.approx(5 / 500, abs=2e-3)
    assert pushed("joint_impedance") < 4e-3


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


def test_a_refusal_says_what_to_do(sim, arm):
    def refused(sentence, *calls):
        for call in calls:
            before = arm.state.robot_mode, arm.state_hash()
            with pytest.raises(RequestRefused, match=sentence):
                call()
            assert (arm.state.robot_mode, arm.state_hash()) == before

    command, guide = lambda: arm.command(torque=TORQUES), lambda: arm.set_guiding(True)
    arm.command(joint_positions=arm.state.q_d + 0.5)
    sim.step(20)
    refused("mode Reflex: .* Recover it first", command)
    arm.recover()
    refused("step until it is Idle", command, guide)
    sim.step(2000)
    command()
    refused("End the motion first", arm.recover)
    arm.finish()
    sim.step(500)
    guide()
    refused("End guiding first", command, arm.recover)
    arm.set_guiding(False)
    arm.set_user_stop(True)
    refused("Release the user stop first", command, guide, arm.recover)
    arm.set_user_stop(False)
    sim.step(2000)
    arm.close_brakes()
    sim.step(200)
    refused("brakes are closed: open them first", command, guide, arm.recover)
    arm.open_brakes()
    sim.step(3000)
    command()
    sim.step(5)
    arm.finish()
    sim.step(1)
    refused("is ending", command)


def test_a_simulation_is_true_and_knows_its_robots(sim, arm, name):
    assert (len(sim), list(sim), name in sim, [name] in sim) == (1, [name], True, False)
    assert dict(sim) == dict(sim.items()) == {name: arm} and list(sim.values()) == [arm]
    with Simulation(robots=[]) as empty:
        assert empty and len(empty) == 0 and list(empty.keys()) == []


def test_descriptions_of_equal_robots_are_equal(kind=Panda):
    first = kind(base=np.zeros(3), load=(0.1, np.zeros(3), np.eye(3)), hand="gripper")
    second = kind(base=[0, 0, 0], load=[0.1, (0, 0, 0), np.eye(3).ravel()], hand=True)
    assert first == second and hash(first) == hash(second) and first.base == (0.0, 0.0, 0.0)
    assert kind(hand="none") == kind(hand=False) != kind(hand="vacuum")


def test_every_public_class_shows_itself():
    classes = {
        each
        for module in (pyfranka, pyfranka.sim, pyfranka.plot)
        for outer in (getattr(module, name) for name in module.__all__)
        for each in (outer, *(vars(outer).values() if isinstance(outer, type) else ()))
        if isinstance(each, type)
    }
    handler = pyfranka.AsyncPositionControlHandler
    assert {handler, handler.CommandResult, pyfranka.Record, pyfranka.plot.Collector} <= classes
    assert not [each.__qualname__ for each in classes if each.__repr__ is object.__repr__]
    target = handler.JointPositionTarget([0.5] * 7)
    assert repr(target) == "<JointPositionTarget: joint_positions [0.5, 0.5, 0.5, 0.5, 0.5, 0.5, 0.5]>"
    assert repr(pyfranka.plot.Collector("arm")) == "<Collector of 'arm': 0 states>"


def test_the_model_takes_copies_of_states(sim, arm):
    arm.set_load(0.5, [0.01, 0.02, 0.05], np.diag([1e-3, 2e-3, 3e-3]))
    arm.joint_impedance(arm.state.q + 0.1)
    sim.step(100)
    live, kept, model = arm.live_state, arm.state, arm.model
    assert np.abs(kept.dq).min() > 0.0 and kept.m_load == 0.5
    for frame in (pyfranka.Frame.Joint4, pyfranka.Frame.Stiffness):
        for function in (model.pose, model.zero_jacobian, model.body_jacobian):
            np.testing.assert_array_equal(function(frame, kept), function(frame, live))
    for function in (model.mass, model.coriolis, model.gravity, model.zero_jacobian):
        np.testing.assert_array_equal(function(kept), function(live))
    np.testing.assert_array_equal(model.gravity(kept, [0, 1, 2]), model.gravity(live, [0, 1, 2]))
    np.testing.assert_array_equal(
        model.mass(kept), model.mass(kept.q, kept.I_total, kept.m_total, kept.F_x_Ctotal)
    )


COPIES = {
    "copy": lambda state: state.copy(),
    "copy.copy": copy.copy,
    "copy.deepcopy": copy.deepcopy,
    "pickle": lambda state: pickle.loads(pickle.dumps(state)),
}
FIELDS = [name for name, member in vars(pyfranka.RobotState).items() if isinstance(member, property)]


@pytest.fixture
def stopped_arm(sim, arm):
    """In a reflex, with errors."""
    arm.command(joint_positions=arm.state.q_d + 0.5)
    sim.step(20)
    assert arm.state.last_motion_errors
    return arm


@pytest.mark.parametrize("copied", COPIES.values(), ids=COPIES)
def test_copies_of_states_are_equal_and_stay(sim, stopped_arm, copied):
    live = stopped_arm.live_state
    for state in (live, stopped_arm.state, libfranka.RobotState(stopped_arm.state)):
        kept = copied(state)
        assert type(kept) is (pyfranka.RobotState if state is live else type(state))
        assert kept == state and state == kept and not kept != state
        before = repr(kept)
        sim.step()
        assert kept != live and live != kept and repr(kept) == before


def test_states_differ_in_each_field(stopped_arm):
    state, other = stopped_arm.state, pyfranka.RobotState()
    for name in FIELDS:
        changed, value = state.copy(), getattr(state, name)
        numeric = isinstance(value, (float, np.ndarray))
        setattr(changed, name, value + 1.0 if numeric else getattr(other, name))
        assert changed != state, name
        setattr(changed, name, value)
        assert changed == state, name
    assert state != "a state" and state is not None
    with pytest.raises(TypeError, match="unhashable"):
        hash(state)


def test_errors_compare_by_value(stopped_arm):
    errors, none = stopped_arm.state.last_motion_errors, pyfranka.Errors()
    for copied in (copy.copy, copy.deepcopy, COPIES["pickle"]):
        assert copied(errors) == errors and hash(copied(errors)) == hash(errors)
    assert errors != none and none == pyfranka.Errors() and errors != str(errors)


def test_a_state_is_a_dict_of_plain_values(stopped_arm):
    state = stopped_arm.state
    values = state.to_dict()
    assert values.keys() == {*FIELDS} and stopped_arm.live_state.to_dict().keys() == values.keys()
    assert values["robot_mode"] == state.robot_mode.name and type(values["time"]) is float
    assert values["last_motion_errors"] == json.loads(str(state.last_motion_errors))
    for name, value in values.items():
        if isinstance(value, np.ndarray):
            assert (value == getattr(state, name)).all() and value.shape == getattr(state, name).shape
            value += 1.0  # its own
            assert (value != getattr(state, name)).all()
        else:
            assert type(value) in (float, list, str), name
    plain = libfranka.RobotState(state).to_dict()
    assert plain["O_T_EE"] == libfranka.RobotState(state).O_T_EE and type(plain["q"]) is list


def test_notebooks_show_pictures():
    rgb = np.random.default_rng(1).integers(0, 256, (5, 7, 3), dtype=np.uint8)
    shown = Image.open(io.BytesIO(Picture(rgb, None)._repr_png_()))
    assert shown.format == "PNG" and (np.asarray(shown) == rgb).all()


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
    with pytest.raises(RuntimeError, match="The move still runs"):
        bool(opening)
    sim.step(1500)
    assert opening and opening.succeeded and arm.gripper.width == pytest.approx(0.08, abs=1e-3)
    nothing = arm.gripper.grasp(0.03, 0.1, 20.0)
    sim.step(2000)
    assert nothing.outcome == GripperOutcome.Failed and not nothing and not arm.gripper.is_grasped
    with pytest.raises(RequestRefused, match="The hand has refused the motion: width must be 0 to 0.08 m"):
        arm.gripper.move(1.0)
    homing = arm.gripper.homing()
    sim.step(10)
    arm.gripper.stop()
    assert homing.outcome == GripperOutcome.Interrupted


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


def test_arrays_of_a_live_state_are_views_that_cannot_be_written(sim, arm):
    q, state = arm.live_state.q, arm.state
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


def test_too_many_contacts_are_a_warning_once(narrow_world):
    with pyfranka.sim.Simulation(narrow_world, []) as sim:
        with pytest.warns(RuntimeWarning, match="Raise nconmax") as caught:
            sim.step(10)
        assert caught[0].filename == __file__
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            sim.step(10)


def test_an_arm_without_hand_has_neither_its_links_nor_its_mass(name):
    with Simulation("", [KINDS[name]()]) as with_hand, Simulation("", [KINDS[name](hand=False)]) as sim:
        arm, other = sim[name], with_hand[name]
        of_hand = set(with_hand.bodies()) - set(sim.bodies())
        assert {f"{name}_hand", f"{name}_hand_tcp", f"{name}_leftfinger", f"{name}_rightfinger"} <= of_hand
        assert all("hand" in body or "finger" in body for body in of_hand)
        assert {f"{name}_link{i}" for i in range(9)} <= set(sim.bodies())
        assert arm.state.m_ee == 0.0 and other.state.m_ee == pytest.approx(0.73, abs=0.05)
        assert arm.state.F_T_EE == pytest.approx(np.eye(4)), "the end effector is the flange"
        assert arm.state.O_T_EE[2, 3] == pytest.approx(other.state.O_T_EE[2, 3] + 0.1034, abs=1e-3)
        sim.step(500)
        with_hand.step(500)
        # What the motors carry, and what the robot knows of it, agree: it neither sinks nor feels a force.
        assert np.abs(arm.state.tau_ext_hat_filtered).max() < 1e-3
        assert np.abs(arm.state.dq).max() < 1e-6
        moved = other.state.tau_J[1] - arm.state.tau_J[1]
        reach = (other.state.O_T_EE[0, 3]) * other.state.m_ee * 9.81
        assert abs(moved) == pytest.approx(reach, rel=0.3), "the weight of the hand"
        with pytest.raises(RuntimeError, match="has no hand"):
            _ = arm.gripper


def test_a_description_of_ones_own_keeps_its_hand(name, tmp_path):
    with Simulation("", [KINDS[name]()]) as sim:
        mass, bodies = float(sim[name].state.m_ee), sim.bodies()
    robots = Path(__file__).resolve().parents[2] / "catkin_ws" / "src" / "franka_sim" / "robots"
    own = tmp_path / "own.urdf"
    own.write_text((robots / f"{name}.urdf").read_text())
    with Simulation("", [KINDS[name](urdf=own, hand=False)]) as sim:
        assert sim.bodies() == bodies and sim[name].state.m_ee == mass
        sim.step(100)
        with pytest.raises(RuntimeError, match="has no hand"):
            _ = sim[name].gripper
    with Simulation("", [KINDS[name](urdf=own)]) as sim:
        sim[name].gripper.move(0.04)
        sim.step(1000)
        assert sim[name].gripper.width == pytest.approx(0.04, abs=1e-3)


def test_a_rounded_inertia_of_a_description_is_repaired_with_a_warning(tmp_path):
    robots = Path(__file__).resolve().parents[2] / "catkin_ws" / "src" / "franka_sim" / "robots"
    disc = (
        '<link name="disc"><inertial><mass value="0.3"/>'
        '<inertia ixx="0.00042" iyy="0.00042" izz="0.00085" ixy="0" ixz="0" iyz="0"/></inertial></link>'
        '<joint name="disc_joint" type="fixed"><parent link="panda_link8"/><child link="disc"/></joint>'
    )
    own = tmp_path / "own.urdf"
    own.write_text((robots / "panda.urdf").read_text().replace("</robot>", disc + "</robot>"))
    for make in (Simulation, partial(SimulationBatch, 2)):
        with pytest.warns(RuntimeWarning, match="inertia.*disc") as caught:
            made = make("", [Panda(urdf=own)])
        assert [warning.filename for warning in caught] == [__file__], "once, where it is made"
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            made.step(10)
        made.close()


@pytest.mark.filterwarnings("error")  # of exceptions in threads
def test_the_examples_of_the_documentation_run(capsys):
    first, served, batch = page_output.examples("python.md")[:3]
    for example in (first, served):
        example.run(address="127.0.33.20")
        example.check(capsys.readouterr().out)
    batch.run()
    batch.check(capsys.readouterr().out, tolerance=2e-4)  # of the springs, on another Debian's MuJoCo


def test_the_table_of_the_documentation_is_made(capsys):
    pytest.importorskip("pandas", reason="pandas is not installed")
    (example,) = page_output.examples("python.md", "## Tables and notebooks")
    example.run()
    example.check(capsys.readouterr().out, tolerance=2e-3)
