# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Errors at the start of the hardware nodes, and their exit: with a message, whatever they wait for."""

import os
import socket
from contextlib import contextmanager
from pathlib import Path

import pytest
import ros_nodes
from fci_proxy import Proxy
from fci_session import simulated
from fci_wire import PORT
from lock_step import stopped
from ros_nodes import parameters
from waiting import wait_for

ADDRESS, OTHER, SILENT, NOBODY, BEHIND_PROXY = (f"127.0.32.{i}" for i in range(1, 6))
CLEAN_END, SHORT_END = 40.0, 0.1  # [s] values of shutdown_timeout
ENDED_BY_TIMEOUT = "ended without the robot's answer"
ONE, ALL = "/franka_control", "/combined_panda"  # names of the nodes

# Requests a recovery, and exits as soon as the node has accepted the goal.
ASK_RECOVERY = f"""
import actionlib, rospy, rospy_connections, threading
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal
rospy_connections.init_node("asks_for_recovery")
client = actionlib.ActionClient("{ONE}/error_recovery", ErrorRecoveryAction)
assert client.wait_for_server(rospy.Duration(30))
active, is_active = threading.Event(), lambda goal: goal.get_comm_state() == actionlib.CommState.ACTIVE
goal = client.send_goal(ErrorRecoveryGoal(), lambda goal: is_active(goal) and active.set())
assert active.wait(30), goal.get_goal_status()
"""


@pytest.fixture(scope="module")
def urdf():
    return ros_nodes.robot_description("panda")


@pytest.fixture(scope="module")
def bare(tmp_path_factory):
    with ros_nodes.master(tmp_path_factory.mktemp("start")) as started:
        yield started


@pytest.fixture
def master(bare, urdf):
    bare.delete(ONE)
    bare.delete(ALL)
    return prepared(bare, urdf)


def prepared(bare, urdf):
    """A master with valid parameters for each of the two nodes."""
    bare.set("/robot_description", urdf)
    both = {"shutdown_timeout": CLEAN_END}
    one = parameters("franka_control_node.yaml", arm_id="panda") | both
    bare.set(ONE, dict(one, robot_ip=ADDRESS, connect_timeout=0.0, realtime_config="ignore"))
    arms = parameters("franka_combined_control_node.yaml") | both
    for arm, address in (("panda_1", ADDRESS), ("panda_2", OTHER)):
        arms[arm]["robot_ip"] = address
    bare.set(ALL, dict(arms, robot_description=urdf.replace("panda_", "panda_1_")))
    return bare


@pytest.fixture(scope="module")
def robot():
    with simulated("panda", "realtime", hand=False, address=ADDRESS) as robot:
        yield robot


def one(master, through=()):
    return master.node("franka_control", "franka_control_node", ONE[1:], through)


def combined(master, through=()):
    return master.node("franka_control", "franka_combined_control_node", ALL[1:], through)


@contextmanager
def silent_robot():
    """Accepts connections, and is silent."""
    with socket.create_server((SILENT, PORT)):
        yield


# --- errors at the start --------------------------------------------------------------------------------

# The parameters that franka_hw reads itself have a gtest, franka_hw/test/robot/parameters_test.cpp.
WRONG = [
    # parameter, value, error text
    ("robot_ip", NOBODY, "Connection to FCI refused"),
    ("connect_timeout", -1.0, "'/franka_control/connect_timeout' is not a number"),
    ("shutdown_timeout", "soon", "'/franka_control/shutdown_timeout' is not a number"),
    ("reconnect", "please", "'/franka_control/reconnect' is not true or false"),
    ("restart_controllers_after_recovery", 1, "_after_recovery' is not true or false"),
]


@pytest.mark.parametrize("name, value, sentence", WRONG)
def test_a_node_reports_errors_and_exits(master, name, value, sentence):
    master.set(f"{ONE}/{name}", value)
    with one(master) as node:
        assert node.ends() == 1, node.output
        assert sentence in node.output
        if name != "shutdown_timeout":
            assert "could not be set up (see above)" in node.output


# --- robots that do not match the parameters ----------------------------------------------------------------

TRAJECTORY, STATES = "effort_joint_trajectory_controller", "franka_state_controller"


def manager(master, *arguments):
    """Answers of the controller manager."""
    result = master.run(ros_nodes.executable("controller_manager", "controller_manager"), *arguments)
    return result.stdout + result.stderr


def set_controllers(master, arm_id):
    for name, values in parameters("default_controllers.yaml", arm_id=arm_id).items():
        master.set("/" + name, values)


def test_a_robot_of_another_type_is_reported_and_not_commanded(master, urdf):
    set_controllers(master, "panda")
    master.set(ONE + "/robot_ip", OTHER)
    sentence = "the robot is an FR3 "
    with simulated("fr3", "lockstep", hand=False, address=OTHER) as robot, one(master) as node:
        node.must_print("is ready", sentence, "robot_description is a Panda's")
        node.must_print("'/franka_control/ignore_robot_mismatch' is not true")
        assert node.output.count(sentence) == 1
        assert "Started" in manager(master, "spawn", STATES), "a read-only controller is accepted"
        assert "Started" not in manager(master, "spawn", TRAJECTORY)
        node.must_print(f"'{TRAJECTORY}' cannot command 'panda'")
        assert node.output.count(sentence) == 2
        assert robot.remote.state().mode == "Idle"
        master.set(ONE + "/ignore_robot_mismatch", True)
        assert "Started" in manager(master, "start", TRAJECTORY), node.output


def test_read_only_nodes_warn_about_another_robot(bare, master):
    joints = [f"panda_joint{i}" for i in range(1, 8)]
    fingers = [f"left_finger_joint{i}" for i in (1, 2)]
    looks = {"robot_ip": OTHER, "publish_rate": 30.0}
    bare.set("/arm_looks", dict(looks, joint_names=joints))
    bare.set("/hand_looks", dict(looks, joint_names=fingers))
    bare.set("/hand", dict(looks, joint_names=fingers))
    with simulated("fr3", "realtime", address=OTHER):
        with bare.node("franka_visualization", "robot_joint_state_publisher", "arm_looks") as node:
            node.must_print("the robot is an FR3", "robot_description is a Panda's")
        for package, kind, name in (
            ("franka_visualization", "gripper_joint_state_publisher", "hand_looks"),
            ("franka_gripper", "franka_gripper_node", "hand"),
        ):
            with bare.node(package, kind, name) as node:
                node.must_print("'left_finger_joint1', which is not a joint of '/robot_description'")


WRONG_FOR_ALL = [
    ("robot_hardware", 1, "robot_hardware"),
    ("panda_2/type", "no_such/Hardware", "no_such/Hardware"),
    ("panda_2/robot_ip", NOBODY, "Connection to FCI refused"),
]


@pytest.mark.parametrize("name, value, sentence", WRONG_FOR_ALL)
def test_a_node_with_several_arms_reports_errors_and_exits(master, robot, name, value, sentence):
    master.set(f"{ALL}/{name}", value)
    with combined(master) as node:
        assert node.ends() == 1, node.output
        assert sentence in node.output
        assert "could not be set up (see above)" in node.output


# --- exit -----------------------------------------------------------------------------------------------


def check_ends_by_timeout(node):
    """It waits for a silent robot, which libfranka does for a minute."""
    assert node.interrupt() == 1, node.output
    assert ENDED_BY_TIMEOUT in node.output


def check_ends_by_itself(node, status=0):
    assert node.interrupt() == status, node.output
    assert ENDED_BY_TIMEOUT not in node.output


def check_ends(node):
    """By itself, or by the timeout if it is just waiting for a silent robot."""
    assert node.interrupt() == (1 if ENDED_BY_TIMEOUT in node.output else 0), node.output


def test_a_node_connecting_to_a_silent_robot_exits_on_interrupt(master):
    master.set(ONE + "/robot_ip", SILENT)
    master.set(ONE + "/connect_timeout", 60.0)
    master.set(ONE + "/shutdown_timeout", SHORT_END)
    with silent_robot(), one(master) as node:
        node.must_print("Connecting to the robot")
        check_ends_by_timeout(node)


def test_a_node_waiting_for_a_robot_exits_on_interrupt(master):
    master.set(ONE + "/robot_ip", NOBODY)
    master.set(ONE + "/connect_timeout", 600.0)
    with one(master) as node:
        node.must_print("Connecting to the robot")
        check_ends_by_itself(node, status=1)


def test_a_node_with_several_arms_connecting_to_a_silent_robot_exits_on_interrupt(master, robot):
    master.set(ALL + "/panda_2/robot_ip", SILENT)
    master.set(ALL + "/shutdown_timeout", SHORT_END)
    with silent_robot(), combined(master) as node:
        node.must_print(f"at {SILENT}")
        check_ends_by_timeout(node)


def test_a_node_that_lost_its_robot_exits_on_interrupt(master):
    master.set(ONE + "/robot_ip", OTHER)
    with one_with_robot(master) as (node, robot):
        robot.server.kill()
        node.must_print("the robot is lost")
        check_ends_by_itself(node)


def test_a_node_reconnecting_to_a_silent_robot_exits_on_interrupt(master):
    master.set(ONE + "/robot_ip", OTHER)
    master.set(ONE + "/reconnect", True)
    master.set(ONE + "/shutdown_timeout", SHORT_END)
    with one_with_robot(master) as (node, robot), stopped(robot.server.process):
        node.must_print("the robot is lost")
        check_ends(node)


def test_a_node_with_a_running_controller_exits_on_interrupt(master):
    with moving(master) as (node, robot):
        check_ends_by_itself(node)
        assert robot.remote.state().mode == "Idle", "The motion did not end with the node."


# Neither root nor a member of the group realtime.
UNPRIVILEGED = ("prlimit", "--rtprio=0:0", "--memlock=65536:65536")
if os.geteuid() == 0:
    UNPRIVILEGED += ("setpriv", "--inh-caps=-sys_nice,-ipc_lock", "--bounding-set=-sys_nice,-ipc_lock")


def test_a_controller_without_real_time_privileges_is_not_started(master):
    set_controllers(master, "panda")
    master.set(ONE + "/realtime_config", "enforce")
    master.set(ONE + "/robot_ip", OTHER)
    sentence = "Start with realtime_config:=ignore"
    through = ("env", "FRANKA_REALTIME=enforce", *UNPRIVILEGED)  # as with a real robot
    with simulated("panda", "lockstep", hand=False, address=OTHER) as robot, one(master, through) as node:
        node.must_print("is ready")
        node.must_print(sentence)
        for times, order in ((2, "spawn"), (3, "start")):  # at each request
            assert "Started" not in manager(master, order, TRAJECTORY)
            node.must_print(f"'{TRAJECTORY}' cannot command 'panda'")
            assert node.output.count(sentence) == times
        assert robot.remote.state().mode == "Idle"
        assert node.process.poll() is None


# Otherwise a kernel with real-time support would be used.
HAS_REALTIME = Path("/sys/kernel/realtime").exists()
ANYHOW = ("env", "FRANKA_REALTIME=ignore") if HAS_REALTIME else ()


def test_a_simulated_robot_needs_no_real_time_kernel(master):
    master.set(ONE + "/realtime_config", "enforce")
    with moving(master, (*ANYHOW, *UNPRIVILEGED)) as (node, robot):
        assert robot.remote.state().mode == "Move", node.output
        count = node.output.count("The running kernel has no real-time support")
        assert count == (0 if HAS_REALTIME else 1), node.output


def test_a_node_with_several_simulated_arms_needs_no_real_time_kernel(master, robot):
    master.set(ALL + "/realtime_config", "enforce")
    with (
        simulated("panda", "realtime", hand=False, address=OTHER),
        combined(master, (*ANYHOW, *UNPRIVILEGED)) as node,
    ):
        node.must_print("going on without real-time priority")
        check_ends_by_itself(node)


def test_a_node_with_several_arms_ends_without_real_time_privileges(master, robot):
    """It controls from its main thread, so it refuses at its start."""
    master.set(ALL + "/realtime_config", "enforce")
    through = ("env", "FRANKA_REALTIME=enforce", *UNPRIVILEGED)  # as with real robots
    with (
        simulated("panda", "realtime", hand=False, address=OTHER) as other,
        combined(master, through) as node,
    ):
        assert node.ends() == 1, node.output
        assert "realtime_config:=ignore" in node.output
        assert robot.remote.state().mode == other.remote.state().mode == "Idle"


def test_a_motion_continues_without_the_master(tmp_path, urdf):
    with ros_nodes.master(tmp_path) as own, moving(prepared(own, urdf)) as (node, robot):
        own.stop()
        end = robot.remote.time + 2.0
        wait_for(lambda: robot.remote.time > end, "Two seconds of the motion")
        assert robot.remote.state().mode == "Move", node.output
        assert node.process.poll() is None
        check_ends_by_itself(node)


def test_a_node_waiting_for_a_recovery_exits_on_interrupt(master):
    master.set(ONE + "/shutdown_timeout", SHORT_END)
    master.set(ONE + "/robot_ip", BEHIND_PROXY)
    set_controllers(master, "panda")
    with (
        simulated("panda", "lockstep", hand=False, address=OTHER) as robot,
        Proxy(BEHIND_PROXY, OTHER) as proxy,
        one(master) as node,
    ):
        node.must_print("is ready")
        start_trajectory_controller(master, node)
        robot.remote.push("panda_link7", (0, 0, -220), ticks=60)
        node.must_print("reflex")
        proxy.hold_replies()
        recovery = master.run("/usr/bin/python3", "-c", ASK_RECOVERY)
        assert recovery.returncode == 0, recovery
        wait_for(lambda: proxy.holds_a_reply, "The robot's reply to the recovery")
        check_ends_by_timeout(node)


@contextmanager
def one_with_robot(master, pace="patient", through=()):
    with simulated("panda", pace, hand=False, address=OTHER) as robot, one(master, through) as node:
        node.must_print("is ready")
        yield node, robot


@contextmanager
def moving(master, through=()):
    """A node with a controller that holds the arm."""
    master.set(ONE + "/robot_ip", OTHER)
    set_controllers(master, "panda")
    with one_with_robot(master, "lockstep", through) as (node, robot):
        start_trajectory_controller(master, node)
        yield node, robot


def start_trajectory_controller(master, node):
    answer = manager(master, "spawn", TRAJECTORY)
    assert "Started" in answer, f"{answer}\n{node.output}"
