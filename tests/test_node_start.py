# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Errors at the start of the hardware nodes, and their exit: with a message, whatever they wait for."""

import os
import signal
import socket
import threading
from contextlib import contextmanager
from pathlib import Path

import pytest
import ros_nodes
from fci_session import simulated
from fci_wire import CONNECT, HEADER, PORT
from lock_step import stopped
from ros_nodes import parameters
from waiting import wait_for

ADDRESS, OTHER, SILENT, ODD, NOBODY = (f"127.0.32.{i}" for i in range(1, 6))
CLEAN_END, SHORT_END = 40.0, 0.1  # [s] values of shutdown_timeout
ENDED_BY_TIMEOUT = "ended without the robot's answer"
ONE, ALL = "/franka_control", "/combined_panda"  # names of the nodes

# The robot becomes silent, and shortly later a recovery is requested.
ASK_RECOVERY = f"""
import actionlib, os, rospy, rospy_connections, signal, sys, time
from actionlib_msgs.msg import GoalStatus
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal
rospy_connections.init_node("asks_for_recovery")
client = actionlib.ActionClient("{ONE}/error_recovery", ErrorRecoveryAction)
assert client.wait_for_server(rospy.Duration(30))
os.kill(int(sys.argv[1]), signal.SIGSTOP)
goal = client.send_goal(ErrorRecoveryGoal())
deadline = time.monotonic() + 30.0
while goal.get_goal_status() != GoalStatus.ACTIVE:  # it has left before the program does
    assert time.monotonic() < deadline, goal.get_goal_status()
    time.sleep(0.01)  # between two looks
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
    with simulated("panda", "realtime", "--no-hand", address=ADDRESS) as robot:
        yield robot


def one(master, through=()):
    return master.node("franka_control", "franka_control_node", ONE[1:], through)


def combined(master, through=()):
    return master.node("franka_control", "franka_combined_control_node", ALL[1:], through)


@contextmanager
def listening(address: str, answer: bytes = b""):
    """A robot that accepts connections and then is silent, or sends the same answer to all."""
    with socket.socket() as server:
        server.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        server.bind((address, PORT))
        server.listen()
        connections = []

        def serve():
            while True:
                try:
                    connection, _ = server.accept()
                except OSError:
                    return
                connections.append(connection)
                if answer and connection.recv(HEADER.size):
                    connection.sendall(answer)

        thread = threading.Thread(target=serve, daemon=True)
        thread.start()
        try:
            yield
        finally:
            server.shutdown(socket.SHUT_RDWR)
            thread.join()
            for connection in connections:
                connection.close()


# --- errors at the start --------------------------------------------------------------------------------

WRONG = [
    # parameter, value (None: missing), error text
    ("/franka_control/robot_ip", "no.such.robot.invalid", "no.such.robot.invalid"),
    ("/franka_control/robot_ip", NOBODY, "Connection to FCI refused"),
    ("/franka_control/robot_ip", None, "'/franka_control/robot_ip' is missing"),
    ("/franka_control/arm_id", None, "'/franka_control/arm_id' is missing"),
    ("/franka_control/arm_id", 5, "'/franka_control/arm_id' is missing or is not a string"),
    ("/franka_control/joint_names", ["a", "b"], "holds 2 names instead of seven"),
    ("/franka_control/joint_names", "panda_joint1", "is not a list of seven names"),
    ("/franka_control/rate_limiting", "often", "is not true or false"),
    ("/franka_control/cutoff_frequency", "low", "is not a number"),
    ("/franka_control/realtime_config", "perhaps", "must be enforce or ignore"),
    ("/franka_control/connect_timeout", "soon", "'/franka_control/connect_timeout' is not a number"),
    ("/franka_control/connect_timeout", -1.0, "'/franka_control/connect_timeout' is not a number"),
    ("/franka_control/reconnect", "please", "'/franka_control/reconnect' is not true or false"),
    (
        "/franka_control/restart_controllers_after_recovery",
        1,
        "'/franka_control/restart_controllers_after_recovery' is not true or false",
    ),
    ("/robot_description", None, "no URDF could be read from the parameter '/robot_description'"),
    ("/robot_description", "<robot", "no URDF could be read from the parameter '/robot_description'"),
]


def put(master, name, value):
    if value is None:
        master.delete(name)
    else:
        master.set(name, value)


@pytest.mark.parametrize("name, value, sentence", WRONG)
def test_a_node_reports_errors_and_exits(master, name, value, sentence):
    put(master, name, value)
    with one(master) as node:
        assert node.ends() == 1, node.output
        assert sentence in node.output
        assert "could not be set up (see above)" in node.output


@pytest.mark.parametrize("value", ["soon", -1.0])
def test_a_wrong_shutdown_timeout_is_refused(master, value):
    master.set(ONE + "/shutdown_timeout", value)
    with one(master) as node:
        assert node.ends() == 1, node.output
        assert "'/franka_control/shutdown_timeout' is not a number" in node.output


def test_a_robot_of_no_known_version_is_refused(master):
    answer = HEADER.pack(CONNECT, 0, HEADER.size + 3) + bytes([1, 99, 0])  # status, version
    master.set(ONE + "/robot_ip", ODD)
    with listening(ODD, answer), one(master) as node:
        assert node.ends() == 1, node.output
        assert "99" in node.output and "version" in node.output


@pytest.mark.parametrize("version", [3, 4])
def test_an_older_robot_is_accepted(master, version):
    master.set(ONE + "/robot_ip", OTHER)
    with (
        simulated("panda", "realtime", "--no-hand", "--protocol", str(version), address=OTHER),
        one(master) as node,
    ):
        node.must_print("is ready")


# --- robots that do not match the parameters ----------------------------------------------------------------

TRAJECTORY, STATES = "effort_joint_trajectory_controller", "franka_state_controller"


def manager(master, *arguments):
    """Answers of the controller manager."""
    result = master.run("rosrun", "controller_manager", "controller_manager", *arguments)
    return result.stdout + result.stderr


def set_controllers(master, arm_id):
    for name, values in parameters("default_controllers.yaml", arm_id=arm_id).items():
        master.set("/" + name, values)


@pytest.mark.parametrize("there, described", [("fr3", "panda"), ("panda", "fr3")])
def test_a_robot_of_another_type_is_reported_and_not_commanded(master, there, described):
    set_controllers(master, "panda")
    master.set("/robot_description", ros_nodes.robot_description(described, arm_id="panda"))
    master.set(ONE + "/robot_ip", OTHER)
    is_there, is_described = [{"fr3": "an FR3", "panda": "a Panda"}[kind] for kind in (there, described)]
    sentence = f"the robot is {is_there} "
    with simulated(there, "lockstep", "--no-hand", address=OTHER) as robot, one(master) as node:
        node.must_print("is ready", sentence, f"robot_description is {is_described}'s")
        node.must_print("'/franka_control/ignore_robot_mismatch' is not true")
        assert node.output.count(sentence) == 1
        assert "Started" in manager(master, "spawn", STATES), "a read-only controller is accepted"
        assert "Started" not in manager(master, "spawn", TRAJECTORY)
        node.must_print(f"'{TRAJECTORY}' cannot command 'panda'")
        assert node.output.count(sentence) == 2
        assert robot.remote.state().mode == "Idle"
        master.set(ONE + "/ignore_robot_mismatch", True)
        assert "Started" in manager(master, "start", TRAJECTORY), node.output


@pytest.mark.parametrize(
    "name, value, sentence",
    [
        ("arm_id", "fr3", "arm_id is 'fr3', but joint_names holds 'panda_joint1'"),
        (
            "/robot_description",
            "left",
            "robot_description holds no joint 'panda_joint1': it describes 'left'",
        ),
    ],
)
def test_an_arm_with_another_name_is_reported_and_not_commanded(master, robot, urdf, name, value, sentence):
    set_controllers(master, "panda")
    if name == "arm_id":
        master.set(f"{ONE}/arm_id", value)
    else:
        master.set(name, urdf.replace("panda_", value + "_"))
    with one(master) as node:
        node.must_print("is ready")
        node.must_print(sentence)
        assert "Started" not in manager(master, "spawn", TRAJECTORY)
        # A controller whose joints are in the description is refused, another one does not load.
        assert node.output.count(sentence) == (2 if name == "arm_id" else 1), node.output


def test_one_arm_of_several_with_another_type_is_reported(master, robot, urdf):
    master.set(ALL + "/panda_2/robot_ip", NOBODY)
    master.set(ALL + "/robot_description", urdf.replace("panda_", "panda_2_"))
    with simulated("fr3", "realtime", "--no-hand", address=NOBODY), combined(master) as node:
        node.must_print(f"no controller can command 'panda_2' at {NOBODY}")
        node.must_print("the robot is an FR3")
        node.must_print("'/combined_panda/panda_2/ignore_robot_mismatch' is not true")


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


def test_joints_missing_in_the_description_are_named(master, robot, urdf):
    master.set("/robot_description", urdf.replace("panda_", "somebody_"))
    with one(master) as node:
        node.must_print("is ready")
        assert "joint 'panda_joint1' has no <limit>" in node.output


WRONG_FOR_ALL = [
    ("/combined_panda/robot_hardware", None, "robot_hardware"),
    ("/combined_panda/panda_2/type", None, "panda_2"),
    ("/combined_panda/panda_2/type", "no_such/Hardware", "no_such/Hardware"),
    ("/combined_panda/panda_2/robot_ip", None, "'/combined_panda/panda_2/robot_ip' is missing"),
    ("/combined_panda/panda_2/robot_ip", NOBODY, "Connection to FCI refused"),
    ("/combined_panda/panda_2/joint_names", ["a"], "holds 1 names instead of seven"),
    ("/combined_panda/robot_description", None, "no URDF could be read from the parameter"),
]


@pytest.mark.parametrize("name, value, sentence", WRONG_FOR_ALL)
def test_a_node_with_several_arms_reports_errors_and_exits(master, robot, name, value, sentence):
    put(master, name, value)
    if name == ALL + "/robot_description":
        master.delete("/robot_description")  # which it would use instead of its own
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


def test_an_idle_node_exits_on_interrupt(master, robot):
    with one(master) as node:
        node.must_print("is ready")
        check_ends_by_itself(node)


@pytest.mark.parametrize("patience", [0.0, 60.0], ids=["at_once", "patiently"])
def test_a_node_connecting_to_a_silent_robot_exits_on_interrupt(master, patience):
    master.set(ONE + "/robot_ip", SILENT)
    master.set(ONE + "/connect_timeout", patience)
    master.set(ONE + "/shutdown_timeout", SHORT_END)
    with listening(SILENT), one(master) as node:
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
    with listening(SILENT), combined(master) as node:
        node.must_print(f"at {SILENT}")
        check_ends_by_timeout(node)


@pytest.mark.parametrize("reconnect", [True, False], ids=["reconnecting", "lost"])
def test_a_node_that_lost_its_robot_exits_on_interrupt(master, reconnect):
    master.set(ONE + "/robot_ip", OTHER)
    master.set(ONE + "/reconnect", reconnect)
    master.set(ONE + "/shutdown_timeout", SHORT_END if reconnect else CLEAN_END)
    with one_with_robot(master) as (node, robot), stopped(robot.server.process):
        node.must_print("the robot is lost")
        (check_ends if reconnect else check_ends_by_itself)(node)


def test_a_node_with_a_running_controller_exits_on_interrupt(master):
    with moving(master) as (node, robot):
        check_ends_by_itself(node)
        assert robot.remote.state().mode == "Idle", "The motion did not end with the node."


# Neither root nor a member of the group realtime.
UNPRIVILEGED = ("prlimit", "--rtprio=0:0", "--memlock=65536:65536")
if os.geteuid() == 0:
    UNPRIVILEGED += ("setpriv", "--inh-caps=-sys_nice,-ipc_lock", "--bounding-set=-sys_nice,-ipc_lock")


def test_a_node_without_privileges_moves_if_real_time_is_not_enforced(master):
    with moving(master, UNPRIVILEGED) as (node, robot):
        assert robot.remote.state().mode == "Move", node.output


def test_a_controller_without_real_time_privileges_is_not_started(master):
    set_controllers(master, "panda")
    master.set(ONE + "/realtime_config", "enforce")
    master.set(ONE + "/robot_ip", OTHER)
    sentence = "Start with realtime_config:=ignore"
    through = ("env", "FRANKA_REALTIME=enforce", *UNPRIVILEGED)  # as with a real robot
    with simulated("panda", "lockstep", "--no-hand", address=OTHER) as robot, one(master, through) as node:
        node.must_print("is ready")
        node.must_print(sentence)
        for times, order in ((2, "spawn"), (3, "start")):  # at each request
            assert "Started" not in manager(master, order, TRAJECTORY)
            node.must_print(f"'{TRAJECTORY}' cannot command 'panda'")
            assert node.output.count(sentence) == times
        assert "running" not in manager(master, "list")
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
        simulated("panda", "realtime", "--no-hand", address=OTHER),
        combined(master, (*ANYHOW, *UNPRIVILEGED)) as node,
    ):
        node.must_print("going on without real-time priority")
        check_ends_by_itself(node)


def test_a_node_with_several_arms_ends_without_real_time_privileges(master, robot):
    """It controls from its main thread, so it refuses at its start."""
    master.set(ALL + "/realtime_config", "enforce")
    through = ("env", "FRANKA_REALTIME=enforce", *UNPRIVILEGED)  # as with real robots
    with (
        simulated("panda", "realtime", "--no-hand", address=OTHER) as other,
        combined(master, through) as node,
    ):
        assert node.ends() == 1, node.output
        assert "realtime_config:=ignore" in node.output
        assert robot.remote.state().mode == other.remote.state().mode == "Idle"


def test_a_motion_continues_without_the_master(tmp_path, urdf):
    with ros_nodes.master(tmp_path) as own, moving(prepared(own, urdf)) as (node, robot):
        own.stop()
        end = robot.remote.time() + 2.0
        wait_for(lambda: robot.remote.time() > end, "Two seconds of the motion")
        assert robot.remote.state().mode == "Move", node.output
        assert node.process.poll() is None
        check_ends_by_itself(node)


def test_a_node_waiting_for_a_recovery_exits_on_interrupt(master):
    master.set(ONE + "/shutdown_timeout", SHORT_END)
    with moving(master) as (node, robot):
        robot.remote.push("panda_link7", (0, 0, -220), 60)
        node.must_print("reflex")
        with woken_at_last(robot.server.process):
            recovery = master.run("/usr/bin/python3", "-c", ASK_RECOVERY, str(robot.server.process.pid))
            assert recovery.returncode == 0, recovery
            node.must_print("recovering", "the robot is lost")
            check_ends(node)


@contextmanager
def woken_at_last(process):
    try:
        yield
    finally:
        os.kill(process.pid, signal.SIGCONT)


@contextmanager
def one_with_robot(master, pace="patient", through=()):
    with simulated("panda", pace, "--no-hand", address=OTHER) as robot, one(master, through) as node:
        node.must_print("is ready")
        yield node, robot


@contextmanager
def moving(master, through=()):
    """A node with a controller that holds the arm."""
    master.set(ONE + "/robot_ip", OTHER)
    set_controllers(master, "panda")
    with one_with_robot(master, "lockstep", through) as (node, robot):
        answer = manager(master, "spawn", TRAJECTORY)
        assert "Started" in answer, f"{answer}\n{node.output}"
        yield node, robot
