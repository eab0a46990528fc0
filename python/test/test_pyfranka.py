# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""pyfranka against simulated robots in lock-step: states, settings, motions of every kind, models."""

import copy
import math
import re
import threading
import time
from contextlib import ExitStack

import numpy as np
import pyfranka
import pytest
from fci_session import simulated

ADDRESSES = {"panda": "127.0.32.1", "fr3": "127.0.32.2"}
Frame, Mode = pyfranka.Frame, pyfranka.ControllerMode
EYE = np.eye(4)


@pytest.fixture(scope="module")
def robots():
    with ExitStack() as stack:
        for robot in ADDRESSES:
            stack.enter_context(simulated(robot, ADDRESSES[robot], "lockstep"))
        yield {
            name: pyfranka.Robot(address, pyfranka.RealtimeConfig.Ignore)
            for name, address in ADDRESSES.items()
        }


@pytest.fixture(params=["panda", "fr3"])
def name(request):
    return request.param


@pytest.fixture
def robot(robots, name):
    robots[name].automatic_error_recovery()
    yield robots[name]
    assert robots[name].read_once().robot_mode == pyfranka.RobotMode.Idle


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


def test_a_state_shows_itself_as_numpy(robot):
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
    # Matrices as matrices: the rotation's rows and columns, the homogeneous row below.
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


def test_reading_goes_on_until_told(robot):
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
    robot.set_K(turned.T.reshape(16))  # column by column, as libfranka has it
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


@pytest.mark.parametrize(
    "call, sentence",
    [
        (lambda robot: robot.set_joint_impedance([1.0] * 6), "K_theta needs 7 numbers, not 6"),
        (lambda robot: robot.set_cartesian_impedance("stiff"), "K_x needs 6 numbers"),
        (lambda robot: robot.set_EE(np.eye(3)), "NE_T_EE needs 16 numbers, not 9"),
        (lambda robot: robot.set_load(1.0, None, [0.0] * 9), "F_x_Cload needs 3 numbers"),
        (lambda robot: pyfranka.Torques([0.0] * 8), "needs 7 numbers, not 8"),
        (lambda robot: pyfranka.CartesianPose(EYE, [0.0]), "elbow needs 2 numbers, not 1"),
    ],
)
def test_wrong_numbers_of_numbers_are_refused_with_a_sentence(robots, call, sentence):
    with pytest.raises(ValueError, match=sentence):
        call(robots["fr3"])


def test_what_the_robot_refuses_is_an_error_of_its_own(robot):
    with pytest.raises(pyfranka.CommandException):
        robot.set_load(-1.0, [0.0] * 3, [0.0] * 9)
    for error in ("Command", "Control", "Network", "Protocol", "Realtime", "Model", "InvalidOperation"):
        assert issubclass(getattr(pyfranka, error + "Exception"), pyfranka.Exception)
    assert issubclass(pyfranka.Exception, RuntimeError)


def test_nobody_there_is_a_sentence():
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
    """A callback for a motion of one kind that notes what it is given."""

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
def test_torques_go_along_with_a_motion(robots, kind):
    robot = robots["fr3"]
    robot.automatic_error_recovery()
    drive, calls = Driver(kind), []

    def torques(state, period):
        calls.append(period)
        return pyfranka.Torques(200.0 * (state.q_d - state.q) - 20.0 * state.dq)

    getattr(robot, f"control_{kind}")(drive, torques, limit_rate=False, cutoff_frequency=1000.0)
    assert len(calls) >= TICKS
    # Afterwards the robot holds what these soft torques reached.
    check_moved(kind, drive.begin, drive.last)


@pytest.mark.parametrize("kind", KINDS)
def test_programs_drive_the_robot_themselves(robot, kind):
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


def test_a_motion_that_nobody_ends_ends_with_its_block(robot):
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
        (lambda state: None, TypeError, "positional argument"),
        (lambda state, period: pyfranka.Torques([math.nan] * 7), ValueError, "finite|NaN|infinite"),
    ],
)
def test_errors_of_a_callback_come_out_and_leave_the_robot_at_rest(robot, callback, error, sentence):
    with pytest.raises(error, match=sentence):
        robot.control_torques(callback)


def test_an_abort_brings_its_log(robot):
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
    # What was sent, in the last record the leap.
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

    helper = threading.Thread(target=lambda: (started.wait(20), robot.stop()))
    helper.start()
    with pytest.raises(pyfranka.ControlException):
        robot.control_torques(wait)
    helper.join(20)
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


def test_the_hand_and_threads_that_run_while_it_moves(robots, name):
    hand = pyfranka.Gripper(ADDRESSES[name])
    assert hand.server_version == 3
    assert hand.move(0.07, 0.1)
    state = hand.read_once()
    assert state.width == pytest.approx(0.07, abs=1e-3)
    assert state.max_width == pytest.approx(0.08)
    assert not state.is_grasped and state.temperature > 0 and state.time > 0

    counted, moving = [0], threading.Event()

    def count():
        while not moving.is_set():
            counted[0] += 1
            time.sleep(1e-3)

    counter = threading.Thread(target=count)
    counter.start()
    before = counted[0]
    assert hand.move(0.05, 0.05)
    # Were the interpreter held, nothing would be counted meanwhile; a busy machine counts less than 400.
    assert counted[0] - before > 5
    moving.set()
    counter.join()
    assert not hand.grasp(0.02, 0.1, 20.0)  # nothing there
    with pytest.raises(pyfranka.CommandException):
        hand.move(0.5, 0.1)


def test_states_of_the_hand_come_thirty_times_a_second(robots, name):
    hand = pyfranka.Gripper(ADDRESSES[name])
    hand.read_once()
    begin = time.monotonic()
    for _ in range(30):
        hand.read_once()
    # Not sooner; a busy machine may be late.
    assert 0.9 < time.monotonic() - begin < 3.0


def test_a_hand_is_stopped_from_another_thread(robots, name):
    hand = pyfranka.Gripper(ADDRESSES[name])
    hand.move(0.08, 0.1)
    ended = threading.Event()

    # In lock-step a homing may be over in a tenth of a second, or not yet have begun after that.
    def stop_until_it_ended():
        while not ended.wait(0.005):
            hand.stop()

    stopper = threading.Thread(target=stop_until_it_ended)
    stopper.start()
    try:
        with pytest.raises(pyfranka.CommandException):
            hand.homing()
    finally:
        ended.set()
        stopper.join(20)


# --- models -----------------------------------------------------------------------------------------------


@pytest.fixture(scope="module")
def urdf(robots):
    return robots["fr3"].get_robot_model()


@pytest.fixture(scope="module")
def offline(urdf):
    prefix = re.search(r'link name="(\w*)link0"', urdf).group(1)
    return pyfranka.ModelKDL(urdf, prefix + "link0", prefix + "link8")


Q = np.array([0.3, -0.5, 0.2, -2.0, 0.4, 1.8, 0.6])


def test_the_flange_of_a_stretched_arm_is_where_the_drawing_says(offline):
    pose = offline.pose(Frame.Flange, np.zeros(7), EYE, EYE)
    np.testing.assert_allclose(pose[:3, 3], [0.088, 0.0, 0.333 + 0.316 + 0.384 - 0.107], atol=1e-9)


def test_poses_chain_and_take_either_form_of_a_matrix(offline):
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


@pytest.mark.parametrize(
    "arguments, error",
    [
        (("no urdf", "fr3_link0", "fr3_link8"), ValueError),
        ((None, "fr3_link0", "nowhere"), Exception),
        ((None, "nowhere", "fr3_link8"), Exception),
    ],
)
def test_a_model_that_cannot_be_is_refused(urdf, arguments, error):
    text, root, tip = arguments
    with pytest.raises(error) as caught:
        pyfranka.ModelKDL(text or urdf, root, tip)
    assert str(caught.value)
