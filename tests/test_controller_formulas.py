# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Every example controller of one arm in FrankaHWSim matches its formula; stopped and started again. That of
the Cartesian impedance has gtests: cartesian_impedance*_test.cpp.

The simulation is stepped, so the results do not depend on the speed of this program.
"""

import json
import threading
from functools import partial

import controller_formulas as formulas
import numpy as np
import pytest
import rigid_arm
import rospy
from dynamic_reconfigure.msg import Config, DoubleParameter
from dynamic_reconfigure.srv import Reconfigure
from franka_msgs.msg import Errors, FrankaState
from franka_msgs.srv import SetJointConfiguration
from franka_sim_mujoco.srv import DeleteObject, GetContacts, SpawnObject, Step
from geometry_msgs.msg import Point, Pose
from ros_client import Controllers, launched
from ros_client import call as call_any
from rosgraph_msgs.msg import Log
from std_srvs.srv import Empty
from waiting import holds, wait_for

JOINT_ERROR, POSE_ERROR = 1e-3, 5e-4  # [rad], [m] of measured values
DESIRED_ERROR = 1e-5  # [rad] or [m] of desired values
FORCE_ERROR = 0.05  # share of the largest
PERIOD = 0.035  # [s] between two recorded states, at most
LAG = 0.01  # [s] several time constants of the 100 Hz filter between a controller and the robot
SETTLING = 0.2  # [s] around a step of the acceleration
ROTOR_INERTIA = 0.1 * np.eye(7)  # [kg m^2] physics.yaml
GRAVITY = 9.81  # [m/s^2]
MOTIONS = [
    "joint_position",
    "joint_velocity",
    "cartesian_pose",
    "cartesian_velocity",
    "elbow",
    "joint_impedance",
]
OTHERS = ["model", "force"]
START = [0, -np.pi / 4, 0, -3 * np.pi / 4, 0, np.pi / 2, np.pi / 4]
FIELDS = ["q", "q_d", "dq", "dq_d", "tau_J_d", "O_T_EE", "O_T_EE_d", "elbow_d", "time", "robot_mode"]
IDLE, MOVE = FrankaState.ROBOT_MODE_IDLE, FrankaState.ROBOT_MODE_MOVE
WAIT = 60.0  # [s] of the wall
REST = 1e-5  # [rad/s]
# Distances from the end effector to the fingertips, and from them to the block at first [m].
TIP, GAP = 0.0584 + 0.04525 + 0.0185 / 2 - 0.1034, 1e-4
PRESSES = [  # parameters of the force controller in its first and its second run
    {"desired_mass": 1.0, "k_p": 0.0, "k_i": 0.0},
    {"desired_mass": 1.5, "k_p": 0.5, "k_i": 0.5},
]
FORCE_SETTINGS = "/dynamic_reconfigure_desired_mass_param_node/set_parameters"

pytestmark = pytest.mark.own_process("robot")


@pytest.fixture(scope="module", params=["panda", "fr3"])
def robot(request):
    return request.param


@pytest.fixture(scope="module")
def lengths(robot, long_run):
    """Simulated seconds of a motion's first and second run."""
    if long_run:
        return 30.0, 3.0
    return (17.0, 3.0) if robot == "panda" else (6.0, 3.0)  # the longest motion has a period of 16 s


def mostly(robot):
    """A test for one of the robots; for the other one in the long form."""
    again = pytest.mark.long_form("the same with the other robot")
    robots = [pytest.param(each, marks=() if each == robot else again) for each in ("panda", "fr3")]
    return pytest.mark.parametrize("robot", robots, indirect=True, scope="module")


@pytest.fixture(scope="module")
def simulation(robot, tmp_path_factory):
    launch = ["franka_gazebo", f"{robot}.launch", "headless:=true", "real_time_factor:=0"]
    log = tmp_path_factory.mktemp("formulas") / "launch.log"
    with launched(*launch, log=log, disable_rostime=True):
        yield Arm(robot)


@pytest.fixture
def arm(simulation):
    """The arm, at rest at its start position."""
    simulation.place()
    return simulation


def full(name):
    return name + "_example_controller"


def call(service, kind, *arguments, **fields):
    answer = call_any(service, kind, *arguments, **fields)
    assert getattr(answer, "success", True), f"{service}: {answer}"
    return answer


def pose_of(state):
    return np.array(state.O_T_EE).reshape(4, 4).T


def at_rest(state):
    return max(map(abs, state.dq)) < REST


class Arm:
    """A simulated arm whose time advances only by steps."""

    def __init__(self, arm_id):
        self.arm_id, self.states = arm_id, []
        topic = "/franka_state_controller/franka_states"
        rospy.Subscriber(topic, FrankaState, self.states.append, queue_size=10000, buff_size=1 << 24)
        wait_for(lambda: self.states, "A first state", WAIT)
        call("/gazebo/pause_physics", Empty)
        self.step(0.1)
        self.controllers = Controllers()
        self.controllers.load(*map(full, MOTIONS + OTHERS))

    def step(self, seconds, age=0.08):
        """Advances the time until the latest state is at most so old [s]; returns the new states."""
        begin = len(self.states)
        now = call("/gazebo/step", Step, round(1000 * seconds)).time
        # A state is published every 34 ms, unless the last one is still being sent.
        recent = rospy.Duration(age)
        for _ in range(100):
            if holds(lambda now=now: self.states[-1].header.stamp > now - recent, 0.5, 0.001):
                return self.states[begin:]
            now = call("/gazebo/step", Step, 20).time
        raise AssertionError("No states come any more.")

    def until(self, condition, what, limit=60.0):
        """Advances the time until a state meets a condition, at most by a limit of simulated seconds."""
        seen = self.step(0.1)
        for _ in range(round(limit / 0.1)):
            if condition(seen[-1]):
                return seen
            seen += self.step(0.1)
        raise AssertionError(f"{what} did not come within {limit} s: {self.states[-1]}")

    def during(self, act):
        """The result of an act that ends only if time advances."""
        results = []
        thread = threading.Thread(target=lambda: results.append(act()))
        thread.start()
        while thread.is_alive():
            self.step(0.02, age=0.036)
        assert results, "It failed."
        return results[0]

    def place(self):
        names = [f"{self.arm_id}_joint{i}" for i in range(1, 8)]
        self.during(lambda: call("/set_franka_model_configuration", SetJointConfiguration, names, START))
        return self.until(lambda state: state.robot_mode == IDLE and at_rest(state), "Rest at the start")[-1]

    def switches(self, start=(), stop=()):
        return self.during(lambda: self.controllers.switches(map(full, start), map(full, stop)))

    def run(self, name, act):
        """A controller's run from the last state before its start to its stop, and what `act` returns."""
        begin = len(self.states) - 1
        assert self.switches(start=[name]), name
        for _ in range(10):  # loses none of the first states, because each is awaited
            self.step(0.02, age=0.036)
        try:
            result = act()
        finally:
            end = len(self.states)
            assert self.switches(stop=[name]), name
            self.until(lambda state: state.robot_mode == IDLE, f"The end of {name}")
        return Run(self.states[begin:end], self.arm_id), result

    def runs_of(self, name, lengths):
        """The first run of a controller, and another one: each from the start position."""
        for seconds in lengths:
            self.place()
            yield self.run(name, lambda seconds=seconds: self.step(seconds))[0]


class Run:
    """Each field an array over the states (n, ...), matrices as such."""

    def __init__(self, states, robot):
        for field in FIELDS:
            setattr(self, field, np.array([getattr(state, field) for state in states]))
        self.O_T_EE, self.O_T_EE_d = (as_poses(poses) for poses in (self.O_T_EE, self.O_T_EE_d))
        self.elbow_d = self.elbow_d[:, 0]
        assert all(state.current_errors == Errors() for state in states)
        self.moving = self.robot_mode == MOVE
        self.bodies = bodies_of(states[-1], robot)

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


def bodies_of(state, robot):
    inertia = np.reshape(state.I_total, (3, 3))
    load = rigid_arm.Body(rigid_arm.FLANGE, state.m_total, np.array(state.F_x_Ctotal), inertia)
    return rigid_arm.bodies(load, robot)


def as_poses(columns):
    return np.reshape(columns, (-1, 4, 4)).transpose(0, 2, 1)


def distances(poses, others):
    return np.linalg.norm((poses - others)[..., :3, 3], axis=-1)


def share(difference, of):
    """For each column, over all states: single states mean little at a step of the circle's acceleration."""
    return np.linalg.norm(difference, axis=0) / np.linalg.norm(of, axis=0)


@pytest.mark.parametrize("controller", ["joint_position", "joint_velocity"])
def test_joints_follow_the_formula(arm, lengths, controller):
    for states in arm.runs_of(controller, lengths):
        expected = states.led_by(getattr(formulas, controller), "q_d")
        assert np.abs(states.q - expected).max() < JOINT_ERROR


@pytest.mark.parametrize("controller", ["cartesian_pose", "cartesian_velocity"])
def test_the_end_effector_follows_the_formula(arm, lengths, controller):
    for states in arm.runs_of(controller, lengths):
        expected = states.led_by(getattr(formulas, controller), "O_T_EE_d")
        assert distances(states.O_T_EE, expected).max() < POSE_ERROR
        assert np.abs(states.O_T_EE - expected)[:, :3, :3].max() < JOINT_ERROR


def test_the_elbow_moves_while_the_end_effector_rests(arm, lengths):
    for states in arm.runs_of("elbow", lengths):
        expected = states.led_by(formulas.elbow, "elbow_d")
        assert np.abs(states.q[:, 2] - expected).max() < JOINT_ERROR
        assert distances(states.O_T_EE, states.O_T_EE[0]).max() < POSE_ERROR


@mostly("fr3")
def test_joint_impedance_moves_the_arm_along_a_circle(arm, lengths):
    """The robot's own motion is the circle. The arm's lag follows from its springs and dampers, whose torques
    accelerate the links and rotors: gravity and Coriolis torques are compensated."""
    for states in arm.runs_of("joint_impedance", lengths):
        states.led_by(formulas.joint_impedance, "O_T_EE_d")
        torques = formulas.joint_impedance_torques(states.q_d - states.q, states.dq_d - states.dq)
        accelerations = np.gradient(states.dq, states.time, axis=0)
        # Differences are wrong at a step of the acceleration: at the start, and when the circle
        # reaches its speed.
        time = states.time - states.time[states.moving][0]
        steady = (time > SETTLING) & (np.abs(time - formulas.ACCELERATION_TIME) > SETTLING)
        some = np.flatnonzero(states.moving & steady)[:-2:5]
        needed = [
            (rigid_arm.mass(states.q[i], states.bodies) + ROTOR_INERTIA) @ accelerations[i] for i in some
        ]
        assert max(share(torques[some] - needed, of=needed)) < FORCE_ERROR
        commanded = torques[some] + states.coriolis(some)
        assert max(share(states.tau_J_d[some] - commanded, of=commanded)) < FORCE_ERROR


def read_model(arm, lines):
    """The next output of the model example, and the state it belongs to."""
    begin = len(lines)
    state = arm.step(1.5)[-1]
    wait_for(lambda: any("joint_zero_jacobian" in line for line in lines[begin:]), "The model's print", WAIT)
    printed = {}
    for line in lines[begin:]:
        name, _, numbers = line.partition(":")
        if numbers.strip().startswith("["):
            printed[name.strip()] = json.loads(numbers)
    return printed, state


def test_model_prints_the_textbook_values(arm):
    lines = []
    listener = rospy.Subscriber("/rosout", Log, lambda log: lines.append(log.msg), queue_size=1000)
    same = partial(np.testing.assert_allclose, rtol=1e-5, atol=1e-5)  # six digits are printed
    for _ in range(2):
        _, (printed, state) = arm.run("model", lambda: read_model(arm, lines))
        bodies, links = bodies_of(state, arm.arm_id), rigid_arm.poses(state.q)
        same(as_poses(printed["joint_pose"])[0], links[4])
        end = pose_of(state)[:3, 3]
        same(np.reshape(printed["joint_zero_jacobian"], (7, 6)).T, rigid_arm.jacobian(links, end))
        turned = np.kron(np.eye(2), links[4, :3, :3].T) @ rigid_arm.jacobian(links, links[4, :3, 3], 4)
        same(np.reshape(printed["joint4_body_jacobian"], (7, 6)).T, turned)
        same(np.reshape(printed["mass"], (7, 7)), rigid_arm.mass(state.q, bodies))
        same(printed["gravity"], rigid_arm.gravity(state.q, bodies))
        same(printed["gravity"], state.tau_J)  # the arm rests
        same(printed["coriolis"], 0)
    listener.unregister()


def press(arm, settings):
    """Sets the desired mass of a running force controller; returns forces on the block [N]."""
    doubles = [DoubleParameter(name, value) for name, value in settings.items()]
    call(FORCE_SETTINGS, Reconfigure, Config(doubles=doubles))
    arm.step(10.0)  # its targets approach with a time constant of 1 s
    return [force_on_block(arm) for _ in range(20)]


def force_on_block(arm):
    arm.step(0.1)
    contacts = call("/gazebo/get_contacts", GetContacts, body1="block", body2="")
    down = [
        force.z if first == "block" else -force.z for first, force in zip(contacts.body1s, contacts.forces)
    ]
    return sum(down)


@pytest.fixture
def block(arm):
    """Puts it under the fingers: they must touch something when the force controller starts."""
    side = 0.1
    x, y, z = pose_of(arm.states[-1])[:3, 3]
    xml = (
        f'<body name="block"><geom type="box" size="{side} {side} {side}" friction="1 0.005 0.0001"/></body>'
    )
    pose = Pose(position=Point(x, y, z - TIP - GAP - side))
    pose.orientation.w = 1.0
    call("/gazebo/spawn_object", SpawnObject, "block", xml, pose)
    yield
    call("/gazebo/delete_object", DeleteObject, "block")


@mostly("fr3")
def test_force_presses_with_the_desired_force(arm, block):
    for settings in PRESSES:
        arm.place()
        states, forces = arm.run("force", lambda settings=settings: press(arm, settings))
        weight = GRAVITY * settings["desired_mass"]
        assert forces == pytest.approx([weight] * len(forces), rel=FORCE_ERROR)
        J = rigid_arm.jacobian(rigid_arm.poses(states.q[-1]), states.O_T_EE[-1, :3, 3])
        np.testing.assert_allclose(
            states.tau_J_d[-1], -weight * J[2], atol=FORCE_ERROR * weight * np.abs(J[2]).max()
        )
