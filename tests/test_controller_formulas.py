# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every example controller of one arm in FrankaHWSim matches its formula; stopped and started again."""

import json
from functools import partial
from pathlib import Path
from types import SimpleNamespace

import controller_formulas as formulas
import numpy as np
import pytest
import rigid_arm
from franka_sim_mujoco.session import Session

HERE = Path(__file__).resolve().parent

MOVE = 2
JOINT_ERROR, POSE_ERROR = 1e-3, 5e-4  # [rad], [m] of measured values
DESIRED_ERROR = 1e-5  # [rad] or [m] of desired values
FORCE_ERROR = 0.05  # share of the largest
RECORDS_A_SECOND = 30
PERIOD = 0.035  # [s] between two recorded states, at most
LAG = 0.01  # [s] several time constants of the 100 Hz filter between a controller and the robot
SETTLING = 0.2  # [s] around a step of the acceleration
STIFFNESS, NULLSPACE_STIFFNESS = (200.0, 10.0), 0.5  # compliance_param.cfg
PUSH = np.array([0.0, 4.0, 0.0])  # [N] the client's
ROTOR_INERTIA = 0.1 * np.eye(7)  # [kg m^2] physics.yaml
GRAVITY = 9.81  # [m/s^2]
MAY_JOIN = {"model", "cartesian_impedance", "force"}  # a motion of the joints: nothing, or torques


@pytest.fixture(scope="module", params=["panda", "fr3"])
def run(request, long_run, tmp_path_factory):
    robot, folder = request.param, tmp_path_factory.mktemp("formulas")
    seconds = ["30", "3"] if long_run or robot == "panda" else ["6", "3"]
    recording = folder / "recording.npz"
    launch = ["franka_gazebo", f"{robot}.launch", "headless:=true", "real_time_factor:=0"]
    with Session(*launch, log=folder / "launch.log") as session:
        session.wait_for_master()
        command = ["/usr/bin/python3", str(HERE / "controller_formulas_client.py"), robot, str(recording)]
        client = session.run(*command, *seconds, check=False, timeout=400)
        print(client.stderr)
        assert client.returncode == 0, f"{client.stderr}\n{session.tail(20)}"
        session.check()
    report = json.loads(client.stdout.strip().splitlines()[-1])
    return SimpleNamespace(robot=robot, report=report, recording=np.load(recording))


@pytest.fixture(params=[0, 1], ids=["first", "again"])
def recorded(request, run):
    """Recorded states of a controller's run, by its name."""
    return lambda name: Run(run, name, request.param)


class Run:
    """Each field an array over the states (n, ...), matrices as such."""

    def __init__(self, run, controller, number):
        for key in run.recording.files:
            prefix, _, field = key.rpartition("/")
            if prefix == f"{controller}/{number}":
                setattr(self, field, run.recording[key])
        self.O_T_EE, self.O_T_EE_d = (as_poses(poses) for poses in (self.O_T_EE, self.O_T_EE_d))
        self.elbow_d = self.elbow_d[:, 0]
        assert self.flawless
        self.moving = self.robot_mode == MOVE
        load = rigid_arm.Body(
            rigid_arm.FLANGE, self.m_total[0], self.F_x_Ctotal[0], self.I_total[0].reshape(3, 3)
        )
        self.bodies = rigid_arm.bodies(load, run.robot)

    def led_by(self, formula, field):
        """A formula's value for each state, with the start time found from a field of desired values."""
        desired = getattr(self, field)
        formula = partial(formula, start=desired[0])
        first = self.time[self.moving][0]
        begin = formulas.start_time(self.time, desired, formula, first - PERIOD, first + LAG)
        expected = formula(np.maximum(self.time - begin, 0.0))
        assert np.abs(desired - expected).max() < DESIRED_ERROR
        return expected

    def coriolis(self, states):
        return np.array([rigid_arm.coriolis(self.q[i], self.dq[i], self.bodies) for i in states])


def as_poses(columns):
    return np.reshape(columns, (-1, 4, 4)).transpose(0, 2, 1)


def distances(poses, others):
    return np.linalg.norm((poses - others)[..., :3, 3], axis=-1)


def share(difference, of):
    """For each column, over all states: single states mean little at a step of the circle's acceleration."""
    return np.linalg.norm(difference, axis=0) / np.linalg.norm(of, axis=0)


@pytest.mark.parametrize("controller", ["joint_position", "joint_velocity"])
def test_joints_follow_the_formula(recorded, controller):
    states = recorded(controller)
    expected = states.led_by(getattr(formulas, controller), "q_d")
    assert np.abs(states.q - expected).max() < JOINT_ERROR


@pytest.mark.parametrize("controller", ["cartesian_pose", "cartesian_velocity"])
def test_the_end_effector_follows_the_formula(recorded, controller):
    states = recorded(controller)
    expected = states.led_by(getattr(formulas, controller), "O_T_EE_d")
    assert distances(states.O_T_EE, expected).max() < POSE_ERROR
    assert np.abs(states.O_T_EE - expected)[:, :3, :3].max() < JOINT_ERROR


def test_the_elbow_moves_while_the_end_effector_rests(recorded):
    states = recorded("elbow")
    expected = states.led_by(formulas.elbow, "elbow_d")
    assert np.abs(states.q[:, 2] - expected).max() < JOINT_ERROR
    assert distances(states.O_T_EE, states.O_T_EE[0]).max() < POSE_ERROR


def test_joint_impedance_moves_the_arm_along_a_circle(recorded):
    """The robot's own motion is the circle. The arm's lag follows from its springs and dampers, whose torques
    accelerate the links and rotors: gravity and Coriolis torques are compensated."""
    states = recorded("joint_impedance")
    states.led_by(formulas.joint_impedance, "O_T_EE_d")
    torques = formulas.joint_impedance_torques(states.q_d - states.q, states.dq_d - states.dq)
    accelerations = np.gradient(states.dq, states.time, axis=0)
    # Differences are wrong at a step of the acceleration: at the start, and when the circle
    # reaches its speed.
    time = states.time - states.time[states.moving][0]
    steady = (time > SETTLING) & (np.abs(time - formulas.ACCELERATION_TIME) > SETTLING)
    some = np.flatnonzero(states.moving & steady)[:-2:5]
    needed = [(rigid_arm.mass(states.q[i], states.bodies) + ROTOR_INERTIA) @ accelerations[i] for i in some]
    assert max(share(torques[some] - needed, of=needed)) < FORCE_ERROR
    commanded = torques[some] + states.coriolis(some)
    assert max(share(states.tau_J_d[some] - commanded, of=commanded)) < FORCE_ERROR


@pytest.mark.parametrize("number", [0, 1], ids=["first", "again"])
def test_model_prints_the_textbook_values(run, number):
    seen, bodies = run.report["model"][number], Run(run, "joint_position", 0).bodies
    printed, q, links = seen["printed"], seen["q"], rigid_arm.poses(seen["q"])
    same = partial(np.testing.assert_allclose, rtol=1e-5, atol=1e-5)  # six digits are printed
    same(as_poses(printed["joint_pose"])[0], links[4])
    end = as_poses(seen["O_T_EE"])[0, :3, 3]
    same(np.reshape(printed["joint_zero_jacobian"], (7, 6)).T, rigid_arm.jacobian(links, end))
    turned = np.kron(np.eye(2), links[4, :3, :3].T) @ rigid_arm.jacobian(links, links[4, :3, 3], 4)
    same(np.reshape(printed["joint4_body_jacobian"], (7, 6)).T, turned)
    same(np.reshape(printed["mass"], (7, 7)), rigid_arm.mass(q, bodies))
    same(printed["gravity"], rigid_arm.gravity(q, bodies))
    same(printed["gravity"], seen["tau_J"])  # the arm rests
    same(printed["coriolis"], 0)


def test_cartesian_impedance_reaches_its_equilibrium_and_yields_like_a_spring(run):
    desired, reached, pushed = (
        np.array(run.report["led"][name]) for name in ("desired", "reached", "pushed")
    )
    assert distances(reached, desired) < POSE_ERROR
    np.testing.assert_allclose(reached[:3, :3], desired[:3, :3], atol=JOINT_ERROR)
    gave_way = (pushed - reached)[:3, 3]
    np.testing.assert_allclose(STIFFNESS[0] * gave_way, PUSH, atol=FORCE_ERROR * np.linalg.norm(PUSH))


def test_cartesian_impedance_commands_match_its_control_law(run):
    """While the hand is pushed and released; the null space target is the start position."""
    states, desired = Run(run, "cartesian_impedance", 0), np.array(run.report["led"]["desired"])
    q_nullspace = run.report["led"]["q_nullspace"]
    some = np.arange(2, len(states.time), 15)
    expected = []
    for i in some:
        pose, links = states.O_T_EE[i], rigid_arm.poses(states.q[i])
        J = rigid_arm.jacobian(links, pose[:3, 3])
        where = (J, pose, desired, states.q[i], states.dq[i], q_nullspace)
        expected.append(formulas.cartesian_impedance_torques(*where, STIFFNESS, NULLSPACE_STIFFNESS))
    expected += states.coriolis(some)
    assert max(share(states.tau_J_d[some] - expected, of=expected)) < FORCE_ERROR


def test_restarted_cartesian_impedance_holds_its_position(run):
    states = Run(run, "cartesian_impedance", 1)
    assert states.moving.sum() > RECORDS_A_SECOND // 2
    assert distances(states.O_T_EE, states.O_T_EE[0]).max() < POSE_ERROR
    assert np.abs(states.q - states.q[0]).max() < JOINT_ERROR


@pytest.mark.parametrize("number", [0, 1], ids=["first", "again"])
def test_force_presses_with_the_desired_force(run, number):
    pressed, states = run.report["pressed"][number], Run(run, "force", number)
    weight = GRAVITY * pressed["desired_mass"]
    assert pressed["forces"] == pytest.approx([weight] * len(pressed["forces"]), rel=FORCE_ERROR)
    J = rigid_arm.jacobian(rigid_arm.poses(states.q[-1]), states.O_T_EE[-1, :3, 3])
    np.testing.assert_allclose(
        states.tau_J_d[-1], -weight * J[2], atol=FORCE_ERROR * weight * np.abs(J[2]).max()
    )


def test_impossible_claims_are_refused_and_change_nothing(run):
    started = run.report["refused"]["started"]
    assert {name for name, success in started.items() if success} == MAY_JOIN
    states = run.report["refused"]["states"]
    running = {name for name, state in states.items() if state == "running"}
    assert running == {"joint_velocity_example_controller", "franka_state_controller", "franka_gripper"}
    assert run.report["refused"]["still_moving"]
