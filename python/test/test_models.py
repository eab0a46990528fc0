# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The models of pyfranka: the robot's own and ModelKDL."""

import re

import numpy as np
import pyfranka
import pytest

Frame = pyfranka.Frame
EYE = np.eye(4)


@pytest.fixture(scope="module")
def urdf(robots):
    return robots["fr3"].get_robot_model()


@pytest.fixture(scope="module")
def offline(urdf):
    prefix = re.search(r'link name="(\w*)link0"', urdf).group(1)
    return pyfranka.ModelKDL(urdf, prefix + "link0", prefix + "link8")


Q = np.array([0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.6])


def test_the_flange_of_a_stretched_arm_matches_the_drawing(offline):
    pose = offline.pose(Frame.Flange, np.zeros(7), EYE, EYE)
    np.testing.assert_allclose(pose[:3, 3], [0.088, 0.0, 0.333 + 0.316 + 0.384 - 0.107], atol=1e-9)


def test_poses_chain_and_accept_both_matrix_formats(offline):
    tool = np.array([[0.0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]])
    flange = offline.pose(Frame.Flange, Q, EYE, EYE)
    np.testing.assert_allclose(offline.pose(Frame.EndEffector, Q, tool, EYE), flange @ tool, atol=1e-12)
    np.testing.assert_allclose(
        offline.pose(Frame.Stiffness, Q, tool.T.reshape(16), tool), flange @ tool @ tool, atol=1e-12
    )


def test_both_models_agree_at_the_robots_state(robot, name, offline):
    """The robot's own library and KDL are two implementations of one arm's model."""
    state, own = robot.read_once(), robot.load_model()
    if name == "panda":
        assert own.mass(state).shape == (7, 7)
        assert own.pose(Frame.Joint1, state)[2, 3] == pytest.approx(0.333)
        return
    for frame in Frame.__members__.values():
        np.testing.assert_allclose(own.pose(frame, state), offline.pose(frame, state), atol=1e-9)
        for jacobian in ("zero_jacobian", "body_jacobian"):
            mine = getattr(own, jacobian)(frame, state)
            assert mine.shape == (6, 7)
            np.testing.assert_allclose(mine, getattr(offline, jacobian)(frame, state), atol=1e-9)
    np.testing.assert_allclose(own.pose(Frame.EndEffector, state), state.O_T_EE, atol=1e-6)
    mass = own.mass(state)
    np.testing.assert_allclose(mass, mass.T, atol=1e-9)
    np.testing.assert_allclose(mass, offline.mass(state), atol=1e-6)
    np.testing.assert_allclose(own.coriolis(state), offline.coriolis(state), atol=1e-6)
    np.testing.assert_allclose(own.gravity(state), offline.gravity(state), atol=1e-6)
    np.testing.assert_allclose(
        own.gravity(state, [0.0, 0.0, -9.81]), offline.gravity(state, [0.0, 0.0, -9.81]), atol=1e-6
    )


def test_a_model_at_rest_gives_the_torques_that_the_robot_measures(robot):
    state = robot.read_once()
    expected = robot.load_model().gravity(state, state.O_ddP_O)
    np.testing.assert_allclose(state.tau_J - state.tau_J_d, expected, atol=0.05)


# --- with explicit arguments -----------------------------------------------------------------------------

TOOL = np.array([[0.0, -1, 0, 0.1], [1, 0, 0, 0.2], [0, 0, 1, 0.3], [0, 0, 0, 1]])
DQ = np.array([0.4, -0.3, 0.6, 0.2, -0.5, 0.7, -0.1])
NO_LOAD = (np.zeros((3, 3)), 0.0, [0.0] * 3)


def test_arguments_and_states_give_the_same_results(robot, name, offline):
    """For the robot's own model and, for the described arm, ModelKDL."""
    robot.set_EE(TOOL)
    robot.set_K(TOOL)
    robot.set_load(0.7, [0.01, -0.02, 0.08], np.diag([2e-3, 3e-3, 4e-3]))
    state = robot.read_once()
    load = (state.I_total, state.m_total, state.F_x_Ctotal)
    for model in [robot.load_model()] + ([offline] if name == "fr3" else []):
        for frame in Frame.__members__.values():
            for function in (model.pose, model.zero_jacobian, model.body_jacobian):
                explicit = function(frame, state.q, state.F_T_EE, state.EE_T_K)
                np.testing.assert_array_equal(explicit, function(frame, state))
        np.testing.assert_array_equal(model.mass(state.q, *load), model.mass(state))
        np.testing.assert_array_equal(model.coriolis(state.q, state.dq, *load), model.coriolis(state))
        gravity = model.gravity(state.q, *load[1:], gravity_earth=state.O_ddP_O)
        np.testing.assert_array_equal(gravity, model.gravity(state, state.O_ddP_O))
        np.testing.assert_array_equal(
            model.gravity(state.q, *load[1:]), model.gravity(state, [0.0, 0.0, -9.81])
        )
    robot.set_EE(EYE)
    robot.set_K(EYE)
    robot.set_load(0.0, [0.0] * 3, np.zeros((3, 3)))


@pytest.fixture(params=["own", "offline"])
def model(request, robots, offline):
    return offline if request.param == "offline" else robots["fr3"].load_model()


def test_jacobians_are_the_derivatives_of_poses(model):
    for frame in (Frame.Joint4, Frame.Flange, Frame.EndEffector, Frame.Stiffness):
        zero = model.zero_jacobian(frame, Q, TOOL, TOOL)
        pose = model.pose(frame, Q, TOOL, TOOL)
        for joint, step in enumerate(1e-6 * np.eye(7)):
            there, back = (model.pose(frame, Q + s, TOOL, TOOL) for s in (step, -step))
            rate = (there - back) / 2e-6
            turn = rate[:3, :3] @ pose[:3, :3].T
            np.testing.assert_allclose(zero[:3, joint], rate[:3, 3], atol=1e-8)
            np.testing.assert_allclose(zero[3:, joint], [turn[2, 1], turn[0, 2], turn[1, 0]], atol=1e-8)
        axes = np.kron(np.eye(2), pose[:3, :3].T)
        np.testing.assert_allclose(model.body_jacobian(frame, Q, TOOL, TOOL), axes @ zero, atol=1e-12)


def test_a_load_adds_its_mass_and_inertia(model):
    """J^T m J, J^T I J, and J^T m g, with the Jacobian of the load's center of mass."""
    mass, com, inertia = 1.3, np.array([0.02, -0.03, 0.1]), np.diag([0.01, 0.02, 0.03])
    center = EYE.copy()
    center[:3, 3] = com
    body = model.body_jacobian(Frame.EndEffector, Q, center, EYE)
    added = model.mass(Q, inertia, mass, com) - model.mass(Q, *NO_LOAD)
    expected = mass * body[:3].T @ body[:3] + body[3:].T @ inertia @ body[3:]
    np.testing.assert_allclose(added, expected, atol=1e-9)
    zero = model.zero_jacobian(Frame.EndEffector, Q, center, EYE)
    for earth in ([0.0, 0.0, -9.81], [1.0, -2.0, -9.0]):
        added = model.gravity(Q, mass, com, earth) - model.gravity(Q, *NO_LOAD[1:], earth)
        np.testing.assert_allclose(added, -mass * zero[:3].T @ np.array(earth), atol=1e-9)
    np.testing.assert_array_equal(model.gravity(Q, mass, com), model.gravity(Q, mass, com, [0.0, 0.0, -9.81]))


def test_coriolis_torques_balance_the_change_of_the_mass_matrix(model):
    """dq^T c = dq^T dM/dt dq / 2: without gravity only torques change the kinetic energy."""
    load = (np.diag([0.01, 0.02, 0.03]), 1.3, [0.02, -0.03, 0.1])
    step = 1e-6 * DQ
    rate = (model.mass(Q + step, *load) - model.mass(Q - step, *load)) / 2e-6
    power = DQ @ model.coriolis(Q, DQ, *load)
    assert power == pytest.approx(0.5 * DQ @ rate @ DQ, abs=1e-8)
    assert abs(power) > 1e-3
    np.testing.assert_allclose(model.coriolis(Q, 2 * DQ, *load), 4 * model.coriolis(Q, DQ, *load), atol=1e-9)


@pytest.mark.parametrize(
    "arguments, error",
    [
        (("no urdf", "fr3_link0", "fr3_link8"), ValueError),
        ((None, "fr3_link0", "nowhere"), Exception),
        ((None, "nowhere", "fr3_link8"), Exception),
    ],
)
def test_an_impossible_model_is_refused(urdf, arguments, error):
    text, root, tip = arguments
    with pytest.raises(error) as caught:
        pyfranka.ModelKDL(text or urdf, root, tip)
    assert str(caught.value)
