# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every entrance of a transform in Python, and the line end_effector, takes the same rounded matrices
(faults 22)."""

import numpy as np
import pyfranka
import pyfranka.sim
import pytest
from pyfranka.remote import LineRefused
from transform_sweep import check, raised

UNLIMITED = {"limit_rate": False, "cutoff_frequency": 1000.0}
FRAME = np.eye(4)
FRAME[:3, 3] = 0.01, -0.02, 0.03
TURNED = np.array([[0.0, -1.0, 0.0, 0.01], [1.0, 0.0, 0.0, 0.02], [0.0, 0.0, 1.0, 0.1], [0.0, 0.0, 0.0, 1.0]])


@pytest.mark.parametrize("options", [{}, UNLIMITED], ids=["limited", "unlimited"])
def test_commanded_poses_of_a_client(robot, options):
    def refusal(perturbed):
        command = pyfranka.motion_finished(pyfranka.CartesianPose(perturbed.matrix))
        return raised(
            lambda: robot.control_cartesian_pose(lambda state, period: command, **options), ValueError
        )

    check(robot.read_once().O_T_EE_c, refusal)


def test_poses_that_a_client_writes_itself(robot):
    with robot.start_cartesian_pose_control(pyfranka.ControllerMode.JointImpedance) as motion:
        state, _ = motion.read_once()
        start = state.O_T_EE_c

        def write(pose):
            """A refused pose is not sent, so another one takes its place."""
            text = raised(lambda: motion.write_once(pyfranka.CartesianPose(pose)), ValueError)
            if text:
                motion.write_once(pyfranka.CartesianPose(start))
            motion.read_once()
            return text

        check(start, lambda perturbed: write(perturbed.matrix))
        motion.write_once(pyfranka.motion_finished(pyfranka.CartesianPose(start)))


@pytest.mark.parametrize("setter", ["set_EE", "set_K"])
def test_setters_of_a_client(robot, setter):
    def refusal(perturbed):
        return raised(lambda: getattr(robot, setter)(perturbed.matrix), pyfranka.CommandException)

    check(FRAME, refusal, because="invalid argument")
    getattr(robot, setter)(np.eye(4))


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
    with pytest.raises(ValueError, match="4x4"):
        served[name].remote.end_effector(*body, np.ones((2, 8)))
    served[name].remote.end_effector(before.m_ee, before.F_x_Cee, before.I_ee, before.F_T_NE)


@pytest.fixture(scope="module", params=[pyfranka.sim.Panda, pyfranka.sim.FR3])
def simulation(request):
    return pyfranka.sim.Simulation(robots=[request.param()])


@pytest.fixture
def simulated(simulation):
    simulation.reset()
    (name,) = simulation
    return simulation[name]


@pytest.mark.parametrize("setter", ["set_EE", "set_K"])
def test_setters_in_a_simulation(simulated, setter):
    check(FRAME, lambda perturbed: raised(lambda: getattr(simulated, setter)(perturbed.matrix), ValueError))


@pytest.mark.parametrize("setter, field", [("set_EE", "NE_T_EE"), ("set_K", "EE_T_K")])
def test_a_matrix_and_its_columns_set_the_same_frame_in_a_simulation(simulation, simulated, setter, field):
    for given in (TURNED, TURNED.tolist(), TURNED.T.ravel()):
        getattr(simulated, setter)(np.eye(4))
        getattr(simulated, setter)(given)
        simulation.step(1)
        np.testing.assert_allclose(getattr(simulated.state, field), TURNED, atol=1e-12)


def test_impedance_targets_in_a_simulation(simulation, simulated):
    def refusal(perturbed):
        return raised(lambda: simulated.cartesian_impedance(perturbed.matrix, 0.1), ValueError)

    check(simulated.state.O_T_EE_c, refusal)
    simulation.step(10)
    assert simulated.state.robot_mode == pyfranka.RobotMode.Move


def test_commanded_poses_in_a_simulation(simulation, simulated):
    start = simulated.state.O_T_EE_c.copy()

    def refusal(perturbed):
        """The robot itself refuses, as it does over the network."""
        simulation.reset()
        simulated.command(cartesian_pose=perturbed.matrix)
        simulation.step(3)
        errors = simulated.state.current_errors
        assert (simulated.state.robot_mode == pyfranka.RobotMode.Reflex) == bool(errors)
        return str(errors) if errors else ""

    check(start, refusal, because="cartesian_position_motion_generator_invalid_frame")
