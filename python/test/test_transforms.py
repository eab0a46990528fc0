# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every entrance of a transform in Python, and the line end_effector, takes the same rounded matrices
(faults 22)."""

import inspect
import re

import numpy as np
import pyfranka
import pyfranka.sim
import pytest
from pyfranka import libfranka
from pyfranka.remote import LineRefused
from transform_sweep import check, raised

READY = [0, -0.7854, 0, -2.3562, 0, 1.5708, 0.7854]
FRAME = np.eye(4)
FRAME[:3, 3] = 0.01, -0.02, 0.03
TURNED = np.array([[0.0, -1.0, 0.0, 0.01], [1.0, 0.0, 0.0, 0.02], [0.0, 0.0, 1.0, 0.1], [0.0, 0.0, 0.0, 1.0]])


COLUMNS = TURNED.T.ravel()
NO_TRANSFORMS = (
    *(TURNED[None], TURNED[:, :, None], COLUMNS[None], COLUMNS[:, None], np.ones((2, 8)), np.ones((8, 2))),
    *(TURNED.astype(complex), TURNED.astype(str), TURNED.astype(object), COLUMNS.reshape(2, 2, 4)),
)


def doors_of_a_model(model, q):
    frame, end = pyfranka.Frame.EndEffector, np.eye(4)
    return {
        f"{type(model).__name__}.{function}.{argument}": lambda T, f=function, a=argument: getattr(model, f)(
            frame, q, **{"F_T_EE": end, "EE_T_K": end, a: T}
        )
        for function in ("pose", "zero_jacobian", "body_jacobian")
        for argument in ("F_T_EE", "EE_T_K")
    }


def set_and_read(state, setter, field):
    def read(transform):
        setter(transform)
        return getattr(state(), field)

    return read


def doors_of_states():
    state = pyfranka.RobotState()

    def door(name):
        return lambda T: setattr(state, name, T) or getattr(state, name).copy()

    return {
        f"RobotState.{name}": door(name)
        for name, value in vars(pyfranka.RobotState).items()
        if isinstance(value, property) and np.shape(getattr(state, name)) == (4, 4)
    }


def names_of_doors():
    """Functions with an argument that is a transform by its name."""
    for cls in (pyfranka.Robot, pyfranka.Model, pyfranka.ModelKDL, *map(vars(pyfranka.sim).get, IN_SIM)):
        for name, function in vars(cls).items():
            if inspect.isroutine(function) and name[0] != "_":
                text = function.__doc__ or ""
                lines = re.findall(rf"^(?:\d+\. )?{name}\((.*)\) -> ", text, re.MULTILINE)
                text = str(inspect.signature(function)) if inspect.isfunction(function) else " ".join(lines)
                for argument in set(re.findall(r"\w+_T_\w+", text)):
                    yield f"{cls.__name__}.{name}", f"{cls.__name__}.{name}.{argument}"


IN_SIM = ("ArmModel", "SimulatedRobot", "Remote")
ELSEWHERE = {"Remote.end_effector"}  # in test_a_matrix_and_its_columns_set_the_same_end_effector


def test_each_entrance_takes_a_matrix_or_its_columns_and_nothing_else(robot, robots, simulation, simulated):
    urdf = robots["fr3"].get_robot_model()
    kdl = pyfranka.ModelKDL(urdf, *re.findall(r'link name="(\w*link[08])"', urdf))
    with_client = {
        **doors_of_states(),
        **doors_of_a_model(kdl, READY),
        "CartesianPose": lambda T: pyfranka.CartesianPose(T).O_T_EE,
        "libfranka.CartesianPose": lambda T: np.reshape(libfranka.CartesianPose(T).O_T_EE, (4, 4), order="F"),
        "is_homogeneous": pyfranka.is_homogeneous_transformation,
        "Robot.set_EE": set_and_read(robot.read_once, robot.set_EE, "NE_T_EE"),
        "Robot.set_K": set_and_read(robot.read_once, robot.set_K, "EE_T_K"),
        **doors_of_a_model(robot.load_model(), READY),
    }

    def stepped():
        simulation.step(1)
        return simulated.state

    in_process = {
        "SimulatedRobot.set_EE": set_and_read(stepped, simulated.set_EE, "NE_T_EE"),
        "SimulatedRobot.set_K": set_and_read(stepped, simulated.set_K, "EE_T_K"),
        **doors_of_a_model(simulated.model, READY),
    }
    assert {f"RobotState.{name}" for name in ("O_T_EE", "O_T_EE_c", "F_T_NE", "EE_T_K")} <= set(with_client)
    tested = {*with_client, *in_process} | ELSEWHERE
    assert [names for names in names_of_doors() if not tested & {*names}] == []
    for door, take in {**with_client, **in_process}.items():
        results = [np.array(take(form)) for form in (TURNED, TURNED.tolist(), COLUMNS, COLUMNS.tolist())]
        for each in results[1:]:
            np.testing.assert_array_equal(each, results[0], err_msg=door)
        if results[0].shape == (4, 4) and "pose" not in door:
            np.testing.assert_allclose(results[0], TURNED, atol=1e-12, err_msg=door)
    motions = {
        "SimulatedRobot.cartesian_impedance": lambda T: simulated.cartesian_impedance(T, 0.01),
        "SimulatedRobot.command": lambda T: simulated.command(cartesian_pose=T),
    }
    for door, move in motions.items():
        reached = []
        simulation.reset()
        pose = simulated.state.O_T_EE_d.copy()
        assert np.abs(pose - pose.T).max() > 0.1, "a pose that would show if it were turned over"
        for form in (pose, pose.T.ravel(), pose.tolist()):
            simulation.reset()
            move(form)
            simulation.step(50)
            assert simulated.state.robot_mode == pyfranka.RobotMode.Move, (door, simulated.state)
            reached.append(simulated.state.O_T_EE.copy())
        np.testing.assert_allclose(reached[0], pose, atol=1e-3, err_msg=door)
        assert all((each == reached[0]).all() for each in reached), door
    simulation.reset()
    for door, take in {**with_client, **in_process, **motions}.items():
        for wrong in NO_TRANSFORMS:
            with pytest.raises(ValueError, match="needs 16 numbers"):
                take(wrong)
                pytest.fail(f"{door} takes {wrong.shape} of {wrong.dtype}")
    assert not simulated.moving
    for setter in (robot.set_EE, robot.set_K):
        setter(np.eye(4))


def test_the_line_end_effector(robot, served, name):
    def refusal(perturbed):
        words = [0.5, 0, 0, 0.03, *(1e-3 * np.eye(3)).ravel().tolist(), *perturbed.column_major]
        line = "end_effector " + " ".join(map(repr, words))
        return raised(lambda: served[name].remote.send(line), LineRefused)

    before = robot.read_once()
    check(FRAME, refusal)
    words = [before.m_ee, *before.F_x_Cee, *before.I_ee.ravel(), *before.F_T_NE.T.ravel()]
    served[name].remote.send("end_effector " + " ".join(repr(float(word)) for word in words))


def test_a_matrix_and_its_columns_set_the_same_end_effector(robot, served, name):
    before = robot.read_once()
    body = (0.5, [0.0, 0.0, 0.03], 1e-3 * np.eye(3))
    for given in (TURNED, TURNED.tolist(), TURNED.T.ravel()):
        served[name].remote.end_effector(*body, np.eye(4))
        served[name].remote.end_effector(*body, given)
        np.testing.assert_allclose(robot.read_once().F_T_NE, TURNED, atol=1e-12)
    for wrong in NO_TRANSFORMS:
        with pytest.raises(ValueError, match="4x4|16 (finite )?numbers"):
            served[name].remote.end_effector(*body, wrong)
    for wrong in (np.ones((9, 1)), np.ones((1, 3, 3)), 1j * np.eye(3)):
        with pytest.raises(ValueError, match="inertia"):
            served[name].remote.end_effector(*body[:2], wrong, TURNED)
    served[name].remote.end_effector(before.m_ee, before.F_x_Cee, before.I_ee, before.F_T_NE)


@pytest.fixture(scope="module", params=[pyfranka.sim.Panda, pyfranka.sim.FR3])
def simulation(request):
    return pyfranka.sim.Simulation(robots=[request.param()])


@pytest.fixture
def simulated(simulation):
    simulation.reset()
    (name,) = simulation
    return simulation[name]


def turned_by(degrees, digits):
    """A rotation about z with the digits that a person types, 4x4."""
    angle = np.radians(degrees)
    typed = np.array(FRAME)
    typed[:2, :2] = [[np.cos(angle), -np.sin(angle)], [np.sin(angle), np.cos(angle)]]
    return np.round(typed, digits)


@pytest.mark.parametrize("setter, field", [("set_EE", "NE_T_EE"), ("set_K", "EE_T_K")])
@pytest.mark.parametrize("degrees", [30, 45, 190])
def test_typed_rotations_become_exact_in_a_simulation(simulation, simulated, setter, field, degrees):
    for digits in (3, 4):
        with pytest.warns(RuntimeWarning, match=field):
            getattr(simulated, setter)(turned_by(degrees, digits))
        simulation.step(1)
        rotation = getattr(simulated.state, field)[:3, :3]
        np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-14)
        np.testing.assert_allclose(rotation, turned_by(degrees, 15)[:3, :3], atol=0.5 * 10.0**-digits)
    with pytest.raises(ValueError, match="row-major"):
        getattr(simulated, setter)(turned_by(degrees, 15).T)


@pytest.mark.parametrize("setter, field", [("set_EE", "NE_T_EE"), ("set_K", "EE_T_K")])
def test_typed_rotations_of_a_client_become_exact(robot, setter, field):
    getattr(robot, setter)(turned_by(45, 3))
    rotation = getattr(robot.read_once(), field)[:3, :3]
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-6)  # states of FR3 are float32
    with pytest.raises(ValueError, match="row-major"):
        getattr(robot, setter)(turned_by(45, 15).T)
    getattr(robot, setter)(np.eye(4))


def test_a_typed_rotation_of_the_end_effector_becomes_exact(robot, served, name):
    before = robot.read_once()
    body = (0.5, [0.0, 0.0, 0.03], 1e-3 * np.eye(3))
    with pytest.warns(RuntimeWarning, match="F_T_NE"):
        served[name].remote.end_effector(*body, turned_by(30, 3))
    rotation = robot.read_once().F_T_NE[:3, :3]
    np.testing.assert_allclose(rotation.T @ rotation, np.eye(3), atol=1e-6)
    with pytest.raises(LineRefused, match="row-major"):
        served[name].remote.end_effector(*body, turned_by(30, 15).T)
    served[name].remote.end_effector(before.m_ee, before.F_x_Cee, before.I_ee, before.F_T_NE)


def test_impedance_targets_in_a_simulation(simulation, simulated):
    def refusal(perturbed):
        return raised(lambda: simulated.cartesian_impedance(perturbed.matrix, 0.1), ValueError)

    check(simulated.state.O_T_EE_c, refusal)
    simulation.step(10)
    assert simulated.state.robot_mode == pyfranka.RobotMode.Move
