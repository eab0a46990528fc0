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
