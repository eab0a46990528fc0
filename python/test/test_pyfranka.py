# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka against simulated robots in lock-step: states, settings, motions of every kind."""

import copy
import math
import subprocess
import sys
import threading

import numpy as np
import pyfranka
import pytest

Mode = pyfranka.ControllerMode
EYE = np.eye(4)


# --- states and settings ----------------------------------------------------------------------------------

MATRICES = {
    (4, 4): ["O_T_EE", "O_T_EE_d", "O_T_EE_c", "F_T_EE", "F_T_NE", "NE_T_EE", "EE_T_K"],
    (3, 3): ["I_ee", "I_load", "I_total"],
    (7,): ["q", "q_d", "dq", "dq_d", "ddq_d", "theta", "dtheta", "tau_J", "tau_J_d", "dtau_J"]
    + ["joint_contact", "joint_collision", "tau_ext_hat_filtered"],
    (6,): ["O_dP_EE_d", "O_dP_EE_c", "O_ddP_EE_c", "cartesian_contact", "cartesian_collision"]
    + ["O_F_ext_hat_K", "K_F_ext_hat_K"],
    (3,): ["F_x_Cee", "F_x_Cload", "F_x_Ctotal", "O_ddP_O"],
    (2,): ["elbow", "elbow_d", "elbow_c", "delbow_c", "ddelbow_c"],
}


def test_state_members_are_numpy_arrays(robot):
    state = robot.read_once()
    arrays = {
        field
        for field in dir(type(state))
        if not field.startswith("_") and isinstance(getattr(state, field), np.ndarray)
    }
    assert arrays == {field for fields in MATRICES.values() for field in fields}
    for shape, fields in MATRICES.items():
        for field in fields:
            array = getattr(state, field)
            assert array.shape == shape and array.dtype == np.float64, field
            with pytest.raises(ValueError):
                array[...] = 0.0
    # Matrices have two dimensions: rows and columns of the rotation, then the homogeneous row.
    pose = state.O_T_EE
    np.testing.assert_allclose(pose[:3, :3] @ pose[:3, :3].T, np.eye(3), atol=1e-6)
    assert pose[3].tolist() == [0, 0, 0, 1]
    assert pose[2, 3] > 0.3
    assert state.m_total == pytest.approx(state.m_ee + state.m_load)
    assert not state.current_errors and str(state.current_errors) == "[]"
    assert not state.last_motion_errors
    assert state.control_command_success_rate == 0.0
    assert '"q"' in repr(state)


def test_arrays_outlive_their_state(robot):
    q = robot.read_once().q
    kept = q.copy()
    states = [robot.read_once() for _ in range(20)]
    assert (q == kept).all()
    assert states[-1].time > states[0].time


def test_a_connection_has_numpy_before_a_motion():
    """The first call of a callback would import it otherwise, which takes 50 ms or more."""
    code = (
        "import sys, pyfranka\n"
        "try: pyfranka.Robot('127.0.0.1:1')\n"
        "except pyfranka.NetworkException: sys.exit('numpy' not in sys.modules)"
    )
    subprocess.run([sys.executable, "-c", code], check=True, timeout=120)


def test_read_continues_until_the_callback_returns_false(robot):
    times = []

    def take(state):
        times.append(state.time)
        return len(times) < 5

    robot.read(take)
    assert len(times) == 5
    assert min(np.diff(times)) > 0.999e-3  # a busy reader may miss one


def test_settings_reach_the_robot(robot):
    turned = np.array([[0.0, -1, 0, 0.01], [1, 0, 0, 0.02], [0, 0, 1, 0.03], [0, 0, 0, 1]])
    inertia = np.diag([1e-3, 2e-3, 3e-3])
    robot.set_EE(turned)
    robot.set_K(turned.T.reshape(16))  # column-major, as in libfranka
    robot.set_load(0.4, [0.0, 0.01, 0.05], inertia)
    robot.set_joint_impedance([3000.0] * 4 + [2000.0] * 3)
    robot.set_cartesian_impedance(np.array([3000, 3000, 3000, 300, 300, 300]))
    robot.set_collision_behavior([20.0] * 7, [40.0] * 7, [20.0] * 6, [40.0] * 6)
    robot.set_guiding_mode([True] * 6, False)
    state = robot.read_once()
    np.testing.assert_allclose(state.NE_T_EE, turned, atol=1e-7)
    np.testing.assert_allclose(state.EE_T_K, turned, atol=1e-7)
    np.testing.assert_allclose(state.I_load, inertia, atol=1e-9)
    assert state.m_load == pytest.approx(0.4)
    robot.set_EE(EYE)
    robot.set_K(EYE)
    robot.set_load(0.0, [0.0] * 3, np.zeros((3, 3)))


def test_thresholds_may_differ_while_the_robot_accelerates(robot):
    """With a lower threshold of 0 any torque is a contact; at rest the nominal thresholds apply."""
    sensitive, dull = [0.0] * 7, [50.0] * 7
    upper = [87.0] * 7

    def contacts(while_accelerating, nominal):
        robot.set_collision_behavior(
            lower_torque_acceleration=while_accelerating,
            upper_torque_acceleration=upper,
            lower_torque_nominal=nominal,
            upper_torque_nominal=upper,
            lower_force_acceleration=[20.0] * 6,
            upper_force_acceleration=[40.0] * 6,
            lower_force_nominal=[20.0] * 6,
            upper_force_nominal=[40.0] * 6,
        )
        found = []
        drive = Driver("torques")

        def note(state, period):
            found.append(state.joint_contact.any())
            return drive(state, period)

        robot.control_torques(note)
        return found[-1]

    assert contacts(dull, sensitive)
    assert not contacts(sensitive, dull)


def test_walls_and_filters_are_those_of_a_panda(robot, name):
    filters = [100.0, 100.0, 100.0, 100.0, 1000.0]
    if name == "fr3":
        for refused in (lambda: robot.get_virtual_wall(1), lambda: robot.set_filters(*filters)):
            with pytest.raises(pyfranka.CommandException, match="protocol version 10"):
                refused()
        return
    wall = robot.get_virtual_wall(1)
    assert wall.id == 1 and not wall.active
    assert wall.object_world_size.shape == (3,) and wall.p_frame.shape == (4, 4)
    with pytest.raises(pyfranka.CommandException):
        robot.get_virtual_wall(-1)
    robot.set_filters(*filters)
    with pytest.raises(pyfranka.CommandException):
        robot.set_filters(0.5, *filters[1:])
    robot.set_filters(*[1000.0] * 5)


def test_refused_commands_raise_command_exceptions(robot):
    with pytest.raises(pyfranka.CommandException):
        robot.set_load(-1.0, [0.0] * 3, [0.0] * 9)
    for error in ("Command", "Control", "Network", "Protocol", "Realtime", "Model", "InvalidOperation"):
        assert issubclass(getattr(pyfranka, error + "Exception"), pyfranka.Exception)
    assert issubclass(pyfranka.Exception, RuntimeError)


def test_unreachable_robot_is_reported():
    for kind in (pyfranka.Robot, pyfranka.Gripper, pyfranka.VacuumGripper):
        with pytest.raises(pyfranka.NetworkException, match="refused"):
            kind("127.0.32.9")


# --- motions ----------------------------------------------------------------------------------------------

TICKS = 100


def rise(tick):
    """From 0 to 1 in TICKS milliseconds, smooth up to the acceleration."""
    s = min(tick / TICKS, 1.0)
    return s**3 * (10 - 15 * s + 6 * s**2)


def speed(tick):
    """Its derivative [1/s]."""
    s = min(tick / TICKS, 1.0)
    return 30 * s**2 * (1 - s) ** 2 / (TICKS * 1e-3)


def lifted(pose, by):
    pose = np.array(pose)
    pose[2, 3] += by
    return pose


KINDS = {
    "torques": lambda begin, tick: pyfranka.Torques([0.0] * 7),
    "joint_positions": lambda begin, tick: pyfranka.JointPositions(begin.q_d + 2e-3 * rise(tick)),
    "joint_velocities": lambda begin, tick: pyfranka.JointVelocities([2e-3 * speed(tick)] * 7),
    "cartesian_pose": lambda begin, tick: pyfranka.CartesianPose(lifted(begin.O_T_EE_c, 5e-4 * rise(tick))),
    "cartesian_velocities": lambda begin, tick: pyfranka.CartesianVelocities(
        [0, 0, 5e-4 * speed(tick), 0, 0, 0]
    ),
}
ACTIVE = {
    "torques": "torque",
    "joint_positions": "joint_position",
    "joint_velocities": "joint_velocity",
    "cartesian_pose": "cartesian_pose",
    "cartesian_velocities": "cartesian_velocity",
}


class Driver:
    """A callback for one kind of motion that records its arguments."""

    def __init__(self, kind):
        self.kind, self.begin, self.last, self.periods = KINDS[kind], None, None, []

    def __call__(self, state, period):
        self.begin, self.last = self.begin or state, state
        self.periods.append(period)
        tick = len(self.periods) - 1
        command = self.kind(self.begin, tick)
        return pyfranka.motion_finished(command) if tick >= TICKS + 20 else command


def check_moved(kind, begin, end):
    if kind.startswith("joint"):
        np.testing.assert_allclose(end.q_d - begin.q_d, 2e-3, atol=1e-5)
    elif kind.startswith("cartesian"):
        np.testing.assert_allclose(end.O_T_EE_c[:3, 3] - begin.O_T_EE_c[:3, 3], [0, 0, 5e-4], atol=1e-5)
    else:
        np.testing.assert_allclose(end.q, begin.q, atol=1e-3)


@pytest.mark.parametrize("kind", KINDS)
def test_callbacks_drive_the_robot(robot, kind):
    begin = robot.read_once()
    drive = Driver(kind)
    options = {} if kind == "torques" else {"controller_mode": Mode.JointImpedance}
    getattr(robot, f"control_{kind}")(drive, limit_rate=False, cutoff_frequency=1000.0, **options)
    assert drive.periods[0] == 0.0
    np.testing.assert_allclose(drive.periods[1:], 1e-3, atol=1e-9)
    check_moved(kind, begin, robot.read_once())


@pytest.mark.parametrize("kind", [kind for kind in KINDS if kind != "torques"])
def test_torques_accompany_a_motion(robots, kind):
    robot = robots["fr3"]
    robot.automatic_error_recovery()
    drive, calls = Driver(kind), []

    def torques(state, period):
        calls.append(period)
        return pyfranka.Torques(200.0 * (state.q_d - state.q) - 20.0 * state.dq)

    getattr(robot, f"control_{kind}")(drive, torques, limit_rate=False, cutoff_frequency=1000.0)
    assert len(calls) >= TICKS
    # Afterwards the robot holds the position that these soft torques reached.
    check_moved(kind, drive.begin, drive.last)


@pytest.mark.parametrize(
    "options, first",
    [({}, "motion"), ({"callback_order": pyfranka.CallbackOrder.ControlFirst}, "torques")],
)
def test_the_order_of_callbacks_can_be_chosen(robot, options, first):
    drive, order = Driver("joint_positions"), []

    def motion(state, period):
        order.append("motion")
        return drive(state, period)

    def torques(state, period):
        order.append("torques")
        return pyfranka.Torques(200.0 * (state.q_d - state.q) - 20.0 * state.dq)

    robot.set_control_options(**options)
    try:
        robot.control_joint_positions(motion, torques, limit_rate=False, cutoff_frequency=1000.0)
    finally:
        robot.set_control_options()
    assert order[0] == first and set(order[:2]) == {"motion", "torques"}


@pytest.mark.parametrize("reference, is_exact", [("RobotState", False), ("Command", True)])
def test_the_first_command_is_filtered_from_the_state(robots, reference, is_exact):
    """The filter's first output is between the state and the command, or is the command."""
    robot, drive = robots["panda"], Driver("joint_positions")
    begins = []

    def motion(state, period):
        begins.append((state, drive(state, period)))
        if len(begins) == 1:
            return pyfranka.JointPositions(state.q_d + 5e-4)
        begins.append(state)
        raise StopIteration

    robot.set_control_options(first_cycle_reference=getattr(pyfranka.FirstCycleReference, reference))
    try:
        with pytest.raises(StopIteration):
            robot.control_joint_positions(motion, limit_rate=False, cutoff_frequency=100.0)
    finally:
        robot.set_control_options()
    moved = begins[-1].q_d - begins[0][0].q_d
    gain = 1e-3 / (1e-3 + 1 / (2 * math.pi * 100.0))
    np.testing.assert_allclose(moved, 5e-4 * (1.0 if is_exact else gain), rtol=1e-6)


def test_asynchronous_position_control(robot, name):
    velocities = [1.0] * 7
    if name == "panda":
        with pytest.raises(pyfranka.CommandException, match="5.9.0"):
            robot.start_async_joint_position_control(velocities)
        return
    with pytest.raises(ValueError, match="seven"):
        robot.start_async_joint_position_control([1.0] * 6)
    with robot.start_async_joint_position_control(velocities) as motion:
        state, _ = motion.read_once()
        target = state.q_d + 0.01
        for _ in range(5000):
            motion.write_once(pyfranka.JointPositions(target))
            state, _ = motion.read_once()
            if np.abs(state.q_d - target).max() < 1e-5 and np.abs(state.dq_d).max() < 1e-4:
                break
        motion.write_once(pyfranka.motion_finished(pyfranka.JointPositions(target)))
    np.testing.assert_allclose(robot.read_once().q_d, target, atol=1e-4)


@pytest.mark.parametrize("kind", KINDS)
def test_active_control(robot, kind):
    begin = robot.read_once()
    with getattr(robot, f"start_{ACTIVE[kind]}_control")() as motion:
        for tick in range(TICKS + 21):
            state, period = motion.read_once()
            if tick == 0:
                begin = state
            command = KINDS[kind](begin, tick)
            motion.write_once(pyfranka.motion_finished(command) if tick == TICKS + 20 else command)
            assert isinstance(period, float)
    with pytest.raises(pyfranka.InvalidOperationException, match="has been closed"):
        motion.read_once()
    with pytest.raises(pyfranka.InvalidOperationException, match="has been closed"):
        motion.write_once(KINDS[kind](begin, 0))
    check_moved(kind, begin, robot.read_once())


def test_an_unfinished_motion_ends_with_its_with_block(robot):
    with robot.start_torque_control() as motion:
        motion.read_once()
        motion.write_once(pyfranka.Torques([0.0] * 7))
        with pytest.raises(pyfranka.InvalidOperationException):
            robot.start_torque_control()
        with pytest.raises(pyfranka.InvalidOperationException):
            robot.read_once()
    assert robot.read_once().robot_mode == pyfranka.RobotMode.Idle


@pytest.mark.parametrize(
    "callback, error, sentence",
    [
        (lambda state, period: 1 / 0, ZeroDivisionError, "division by zero"),
        (lambda state, period: [0.0] * 7, ValueError, "The callback returned <class 'list'>"),
        (lambda state, period: None, ValueError, "The callback returned <class 'NoneType'>"),
        (lambda state: None, TypeError, "positional argument"),
        (lambda state, period: pyfranka.Torques([math.nan] * 7), ValueError, "finite|NaN|infinite"),
    ],
)
def test_callback_errors_propagate_and_leave_the_robot_at_rest(robot, callback, error, sentence):
    with pytest.raises(error, match=sentence):
        robot.control_torques(callback)


def test_an_aborted_motion_returns_its_log(robot):
    drive = Driver("joint_positions")

    def leap(state, period):
        command = drive(state, period)
        return pyfranka.JointPositions(state.q_d + 0.2) if len(drive.periods) > 30 else command

    with pytest.raises(pyfranka.ControlException) as caught:
        robot.control_joint_positions(leap, limit_rate=False, cutoff_frequency=1000.0)
    assert "joint" in str(caught.value)
    log = caught.value.log
    assert 1 < len(log) <= 50
    assert log[-1].state.time > log[0].state.time
    # Sent commands; the last record has the jump.
    assert max(abs(log[-1].q_c - log[0].q_c)) > 0.1
    for field in ("q_c", "dq_c", "tau_J_d"):
        assert getattr(log[-1], field).shape == (7,)
    assert log[-1].O_T_EE_c.shape == (4, 4) and log[-1].O_dP_EE_c.shape == (6,)
    rows = pyfranka.log_to_csv(log).splitlines()
    assert len([row for row in rows if row and row[0].isdigit()]) == len(log)
    assert robot.read_once().last_motion_errors
    robot.automatic_error_recovery()


def test_commands_can_be_copied_and_ended():
    command = pyfranka.CartesianPose(EYE, [0.1, -1.0])
    last = pyfranka.motion_finished(command)
    assert last.motion_finished and not command.motion_finished
    np.testing.assert_array_equal(copy.copy(last).elbow, [0.1, -1.0])
    assert copy.copy(last).motion_finished


# --- threads ----------------------------------------------------------------------------------------------


def test_stop_from_another_thread_ends_a_motion(robot):
    started = threading.Event()

    def wait(state, period):
        started.set()
        return pyfranka.Torques([0.0] * 7)

    helper = threading.Thread(target=lambda: (started.wait(60), robot.stop()))
    helper.start()
    with pytest.raises(pyfranka.ControlException):
        robot.control_torques(wait)
    helper.join(60)
    assert not helper.is_alive()


def test_two_robots_in_one_program_do_not_disturb_each_other(robots):
    drivers = {name: Driver("joint_positions") for name in robots}
    begins = {name: robot.read_once() for name, robot in robots.items()}
    errors = []

    def work(name):
        try:
            robots[name].control_joint_positions(drivers[name], limit_rate=False, cutoff_frequency=1000.0)
        except Exception as error:
            errors.append(error)

    threads = [threading.Thread(target=work, args=(name,)) for name in robots]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join(60)
    assert not errors
    for name, robot in robots.items():
        check_moved("joint_positions", begins[name], robot.read_once())


def test_flags_may_be_those_of_numpy(robot):
    robot.set_guiding_mode(np.array([True] * 6), np.True_)
