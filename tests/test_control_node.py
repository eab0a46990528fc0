# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Each service, each topic and each report of franka_control_node."""

import csv
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import rospy
import tf2_ros
import yaml
from control_nodes import ERROR, OK, SUCCEEDED, WARN, ControlNode, Diagnosis
from fci_session import simulated
from pyfranka.plot import read_log
from ros_client import call, launched
from scipy.spatial.transform import Rotation
from setters import SETTERS
from tutorial import TOP, read
from waiting import wait_for

CONTROLLER = "position_joint_trajectory_controller"
LONG = 600.0  # [s] for seconds of the robot, on a busy machine
PUSH = [0.0, 0.0, -8.0]  # at the seventh link [N]
BRIEFLY = 50  # [ms]
NO_COMMANDS = "The robot takes no commands in this mode"
NEWEST = {"panda": 5, "fr3": 10}  # versions of the protocol
REST = 1e-6  # [rad/s] of an arm at rest
WIDE = {"torque": [60.0] * 7, "force": [60.0] * 6}  # thresholds that are never reached here [Nm], [N, Nm]

pytestmark = pytest.mark.own_process("robot")


@pytest.fixture(
    scope="module",
    params=[pytest.param("panda", marks=pytest.mark.long_form("the same with a Panda")), "fr3"],
)
def robot(request):
    return request.param


class Node(ControlNode):
    """The node, its robot, and what it publishes."""

    def __init__(self, robot, address):
        super().__init__({robot: address})
        (self.arm,) = self.arms
        self.diagnosis = Diagnosis("franka_control")
        self.controllers.load(CONTROLLER)
        self.frames = {"NE_T_EE": self.arm.state.NE_T_EE, "EE_T_K": self.arm.state.EE_T_K}

    def wait_for_rest(self):
        wait_for(lambda: self.arm.is_in("idle") and max(map(abs, self.arm.state.dq)) < REST, "Rest", LONG)

    def set(self, name, **values):
        """(success, error)"""
        answer = call(f"/franka_control/{name}", SETTERS[name], **values)
        return answer.success, answer.error

    def sets(self, name, **values):
        assert self.set(name, **values) == (True, "")

    def start(self):
        self.controllers.start(CONTROLLER)
        wait_for(lambda: self.arm.is_in("moving"), "The motion")

    def stop(self):
        """Stops the controller, and waits for the states that show it: the next Move is another one."""
        self.controllers.stop(CONTROLLER)
        wait_for(lambda: not self.arm.is_in("moving"), "The end of the motion")


@pytest.fixture(scope="module")
def node(robot, tmp_path_factory):
    launch = ["franka_control", "franka_control.launch", f"robot:={robot}"]
    launch += ["load_gripper:=false", "realtime_config:=ignore"]
    log = tmp_path_factory.mktemp("control") / "launch.log"
    # Patient, not in lock-step: its time is at most as fast as the clock, so that topics keep up with it.
    with (
        simulated(robot, "patient") as simulation,
        launched(*launch, f"robot_ip:={simulation.address}", log=log),
    ):
        yield Node(robot, simulation.address)


@pytest.fixture
def resting(node):
    """The arm rests without an error, with the node's first settings, whatever happened before."""
    if CONTROLLER in node.controllers.running():
        node.stop()
    assert node.recover() == SUCCEEDED
    node.wait_for_rest()
    node.sets("set_load", mass=0.0, F_x_center_load=[0.0] * 3, load_inertia=[0.0] * 9)
    node.sets("set_EE_frame", NE_T_EE=node.frames["NE_T_EE"])
    node.sets("set_K_frame", EE_T_K=node.frames["EE_T_K"])
    node.sets("set_full_collision_behavior", **thresholds())
    wait_for(lambda: apart(node.arm.state.EE_T_K, node.frames["EE_T_K"]) < 1e-6, "The first frames")
    wait_for(lambda: node.arm.state.m_load == 0.0, "The end of the load")
    return node


def transform(position=(0, 0, 0), about_x=0.0, about_z=0.0):
    """A translation, then a rotation about x, then one about z; 4x4."""
    cx, sx, cz, sz = np.cos(about_x), np.sin(about_x), np.cos(about_z), np.sin(about_z)
    matrix = np.eye(4)
    matrix[:3, :3] = np.array([[1, 0, 0], [0, cx, -sx], [0, sx, cx]]) @ [[cz, -sz, 0], [sz, cz, 0], [0, 0, 1]]
    matrix[:3, 3] = position
    return matrix


def matrix(columns):
    return np.array(columns).reshape(4, 4).T


def columns(pose):
    return pose.T.flatten().tolist()


def matrix_of(message):
    """A geometry_msgs/Transform."""
    at, turn = message.translation, message.rotation
    pose = np.eye(4)
    pose[:3, :3] = Rotation.from_quat([turn.x, turn.y, turn.z, turn.w]).as_matrix()
    pose[:3, 3] = [at.x, at.y, at.z]
    return pose


def apart(a, b):
    """The largest difference of two arrays."""
    return float(np.abs(np.asarray(a, float) - np.asarray(b, float)).max())


def thresholds(**changed):
    """Arguments of set_full_collision_behavior: wide, except those named as in lower_force=5."""
    arguments = {}
    for bound in ("lower", "upper"):
        for what, wide in WIDE.items():
            values = [changed[f"{bound}_{what}"]] * len(wide) if f"{bound}_{what}" in changed else wide
            for phase in ("acceleration", "nominal"):
                arguments[f"{bound}_{what}_thresholds_{phase}"] = values
    return arguments


def good_values():
    """Requests of the setters that the state shows, with its fields."""
    hand = transform((0.01, -0.02, 0.15), 0.0, 0.5)
    stiffness = transform((0.0, 0.0, 0.05), 0.3)
    inertia = np.diag([1e-3, 2e-3, 2.5e-3]).flatten().tolist()
    return {
        "set_EE_frame": ({"NE_T_EE": columns(hand)}, {"NE_T_EE": columns(hand)}),
        "set_K_frame": ({"EE_T_K": columns(stiffness)}, {"EE_T_K": columns(stiffness)}),
        "set_load": (
            {"mass": 0.4, "F_x_center_load": [0.0, 0.01, 0.06], "load_inertia": inertia},
            {"m_load": 0.4, "F_x_Cload": [0.0, 0.01, 0.06], "I_load": inertia},
        ),
    }


def test_setters_take_effect(resting):
    for name, (values, effect) in good_values().items():
        resting.sets(name, **values)

        def seen(effect=effect):
            return all(apart(getattr(resting.arm.state, field), v) < 1e-6 for field, v in effect.items())

        wait_for(seen, f"The effect of {name}")
    assert resting.arm.state.m_total == pytest.approx(resting.arm.state.m_ee + 0.4, abs=1e-6)


def test_transforms_connect_the_base_with_the_end_effector(robot, resting):
    """The chain of /tf against the robot's O_T_EE, with frames and a load."""
    for name, (values, _) in good_values().items():
        resting.sets(name, **values)
    # While the world runs, states show it.
    resting.arm.operator.push(f"{robot}_link7", (0, 0, 0), ticks=10)
    hand = good_values()["set_EE_frame"][1]["NE_T_EE"]
    wait_for(lambda: apart(resting.arm.state.NE_T_EE, hand) < 1e-6, "The new frame")
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)

    def match():
        if not buffer.can_transform(f"{robot}_link0", f"{robot}_EE", rospy.Time()):
            return False
        found = buffer.lookup_transform(f"{robot}_link0", f"{robot}_EE", rospy.Time()).transform
        return apart(matrix_of(found), matrix(resting.arm.state.O_T_EE)) < 1e-5

    wait_for(match, "A transform that matches")
    listener.unregister()


def test_a_reflex_is_published_and_logged(robot, resting, tmp_path):
    """A push above a threshold, and the node's reports about it."""
    arm = resting.arm
    resting.sets("set_full_collision_behavior", **thresholds(upper_force=4.0))
    resting.start()
    arm.operator.push(f"{robot}_link7", PUSH, ticks=BRIEFLY)
    wait_for(lambda: arm.is_in("in reflex") and arm.has_error, "The reflex")
    wait_for(lambda: arm.state.current_errors.cartesian_reflex, "The flag of the reflex")
    # A diagnostics message at the time of the reflex may still hold the last state of the motion.
    level, _, values = resting.diagnosis.shows(
        "Robot", "In error; call the action error_recovery", Mode="Reflex"
    )
    assert level == ERROR and values["Mode"] == "Reflex"
    assert "cartesian_reflex" in values["Current errors"]
    # Latched: late subscribers get it too.
    echo = read(TOP / "docs/how_to/recording.md").block_with("/franka_control/abort")
    printed = subprocess.check_output(["bash", "-c", echo], text=True, timeout=60)
    abort = next(yaml.safe_load_all(printed))["data"]
    assert "cartesian_reflex" in abort.splitlines()[0]
    plot = read(TOP / "docs/how_to/plots.md").block_with("franka_plot log")
    plot = re.sub(r"\S+\.csv", abort.splitlines()[-1].split(": ", 1)[1], plot)
    subprocess.run(["bash", "-ec", plot], cwd=tmp_path, check=True, timeout=60)
    assert (tmp_path / "abort.png").stat().st_size > 10_000
    check_log(abort, arm.state, NEWEST[robot])
    assert resting.recover() == SUCCEEDED
    wait_for(lambda: not arm.has_error, "The end of the error")


def check_log(abort, state, version):
    """Content of the files that the text names: the log, and the reason beside it."""
    words, path = abort.splitlines()[-1].split(": ", 1)
    with open(path, encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    times = [int(row["time"]) for row in rows]
    assert len(rows) == int(words.split()[2]) > 1
    assert all(b > a for a, b in zip(times, times[1:]))
    assert 0 <= 1000 * state.time - times[-1]  # all is before the state
    # The last row is the arm's position at the start of braking [rad].
    assert apart([float(rows[-1][f"state.q[{i}]"]) for i in range(7)], state.q) < 0.01
    # The last rows may show the braking, the first ones no command yet.
    echoes = [
        apart(*([float(row[f"{source}.q_d[{i}]"]) for i in range(7)] for source in ("cmd", "state")))
        for row in rows[-5:]
    ]
    assert min(echoes) < 1e-3
    assert len(rows[0]) == 2 + 6 * 7 + 7 + 7 + 16 + 6 + 7
    # franka_plot shows the reason.
    reason = Path(path).with_suffix(".txt").read_text(encoding="utf-8")
    assert reason.splitlines()[0] == abort.splitlines()[0]
    recording, logged = read_log(Path(path))
    assert len(recording) == len(rows) and recording.version == version
    assert "cartesian_reflex" in logged.errors


def test_diagnostics_report_the_state(robot, resting):
    level, hardware, values = resting.diagnosis.shows("Robot", "Ready", Mode="Idle")
    assert (level, hardware, values["Mode"]) == (OK, robot, "Idle")
    _, _, values = resting.diagnosis.status_when(
        "Control loop", lambda _, v: int(v["Cycles since the last report"]) > 0
    )
    longest = float(values["Longest time of the controllers [ms]"])
    assert 0.0 < float(values["Mean time of the controllers [ms]"]) <= longest
    resting.start()
    level, hardware, values = resting.diagnosis.shows("Robot", "Ready", Mode="Move")
    assert (level, hardware, values["Mode"]) == (OK, robot, "Move")
    _, _, values = resting.diagnosis.status_when(
        "Robot", lambda _, v: int(v["Commands since the last report"]) > 0
    )
    longest = float(values["From a state to its command, longest [ms]"])
    assert 0.0 < float(values["From a state to its command, mean [ms]"]) <= longest
    assert float(values["Latest state behind the promptest [ms]"]) > 0.0
    wait_for(lambda: resting.arm.state.time >= float(values["Robot time [s]"]) > 0.0, "The robot's time")
    operator = resting.arm.operator
    operator.loss(0.08)  # commands
    try:
        assert resting.diagnosis.shows("Robot", "Many commands reach the robot too late")[0] == WARN
    finally:
        operator.loss(0)
    resting.stop()
    operator.set_guiding(True)
    try:
        assert resting.diagnosis.shows("Robot", NO_COMMANDS, Mode="Guiding")[0] == WARN
    finally:
        operator.set_guiding(False)


def offered():
    """Names of the node's own services and of its action's goal topic."""
    _, _, (publishers, subscribers, services) = rospy.get_master().getSystemState()
    names = [name for name, _ in services + subscribers if name.startswith("/franka_control/")]
    return {*SETTERS, "error_recovery/goal"} & {name.split("/", 2)[2] for name in names}


def test_robot_services_exist_only_while_connected(resting):
    assert len(offered()) == 8
    assert resting.trigger("disconnect") == (True, "")
    try:
        assert offered() == set()
        assert resting.diagnosis.shows("Robot", "Not connected to the robot")[0] == ERROR
        assert resting.trigger("disconnect") == (True, "")
    finally:
        assert resting.trigger("connect") == (True, "")
    assert len(offered()) == 8
    assert resting.diagnosis.shows("Robot", "Ready")[0] == OK
    resting.sets("set_joint_impedance", joint_stiffness=[3000.0] * 7)
