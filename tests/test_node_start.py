# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""How the hardware nodes begin where something is wrong, and how they end: with a sentence, and in time."""

import os
import signal
import socket
import threading
import time
from contextlib import contextmanager

import pytest
import ros_nodes
import yaml
from fci_session import simulated
from fci_wire import CONNECT, HEADER, PORT

ADDRESS, OTHER, SILENT, ODD, NOBODY = (f"127.0.32.{i}" for i in range(1, 6))
IN_TIME = 2.0  # to end after an interruption [s]
ONE, ALL = "/franka_control", "/combined_panda"  # names of the nodes

# The robot falls silent, and a moment later somebody wants it to recover.
ASK_RECOVERY = f"""
import actionlib, os, rospy, rospy_connections, signal, sys
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal
rospy_connections.init_node("asks_for_recovery")
client = actionlib.ActionClient("{ONE}/error_recovery", ErrorRecoveryAction)
assert client.wait_for_server(rospy.Duration(20))
os.kill(int(sys.argv[1]), signal.SIGSTOP)
goal = client.send_goal(ErrorRecoveryGoal())
rospy.sleep(1.0)  # no answer comes that could be waited for: the goal is to leave before the program does
"""


def configured(file: str, **arguments: str):
    """A node's parameters as its launch file loads them."""
    text = (ros_nodes.CONTROL_CONFIG / file).read_text()
    for name, value in {"realtime_config": "ignore", "connect_timeout": "0", **arguments}.items():
        text = text.replace(f"$(arg {name})", value)
    return yaml.safe_load(text)


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
    """A master with the parameters of a node for each kind of hardware, where nothing is wrong."""
    bare.set("/robot_description", urdf)
    one = configured("franka_control_node.yaml", arm_id="panda")
    bare.set(ONE, dict(one, robot_ip=ADDRESS, connect_timeout=0.0))
    arms = configured("franka_combined_control_node.yaml")
    for arm, address in (("panda_1", ADDRESS), ("panda_2", OTHER)):
        arms[arm]["robot_ip"] = address
    bare.set(ALL, dict(arms, robot_description=urdf.replace("panda_", "panda_1_")))
    return bare


@pytest.fixture(scope="module")
def robot():
    with simulated("panda", ADDRESS, "realtime", "--no-hand") as robot:
        yield robot


def one(master, *through):
    return master.node("franka_control", "franka_control_node", ONE[1:], through)


def combined(master):
    return master.node("franka_control", "franka_combined_control_node", ALL[1:])


@contextmanager
def listening(address: str, answer: bytes = b""):
    """A robot that takes connections and then says nothing, or the same to everybody who asks."""
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


# --- what is wrong from the start -----------------------------------------------------------------------

WRONG = [
    # parameter, value (None: missing), what is said
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
def test_a_node_says_what_is_wrong_and_ends(master, name, value, sentence):
    put(master, name, value)
    with one(master) as node:
        assert node.ends() == 1, node.output
        assert sentence in node.output
        assert "could not be set up (see above)" in node.output


def test_a_robot_of_no_known_version_is_refused(master):
    answer = HEADER.pack(CONNECT, 0, HEADER.size + 3) + bytes([1, 99, 0])  # status, version
    master.set(ONE + "/robot_ip", ODD)
    with listening(ODD, answer), one(master) as node:
        assert node.ends() == 1, node.output
        assert "99" in node.output and "version" in node.output


@pytest.mark.parametrize("version", [3, 4])
def test_an_older_robot_is_taken(master, version):
    master.set(ONE + "/robot_ip", OTHER)
    with simulated("panda", OTHER, "realtime", "--no-hand", "--protocol", str(version)), one(master) as node:
        assert node.says("is ready", 20), node.output
        assert node.interrupt() < IN_TIME


def test_joints_that_the_description_does_not_hold_are_named(master, robot, urdf):
    master.set("/robot_description", urdf.replace("panda_", "somebody_"))
    with one(master) as node:
        assert node.says("is ready"), node.output
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
def test_a_node_of_several_arms_says_what_is_wrong_and_ends(master, robot, name, value, sentence):
    put(master, name, value)
    if name == ALL + "/robot_description":
        master.delete("/robot_description")  # which would do in the place of its own
    with combined(master) as node:
        assert node.ends() == 1, node.output
        assert sentence in node.output
        assert "could not be set up (see above)" in node.output


# --- the end --------------------------------------------------------------------------------------------


def test_a_resting_node_ends_when_interrupted(master, robot):
    with one(master) as node:
        assert node.says("is ready"), node.output
        assert node.interrupt() < IN_TIME
        assert node.process.returncode == 0


@pytest.mark.parametrize("patience", [0.0, 60.0], ids=["at_once", "patiently"])
def test_a_node_that_connects_to_silence_ends_when_interrupted(master, patience):
    master.set(ONE + "/robot_ip", SILENT)
    master.set(ONE + "/connect_timeout", patience)
    with listening(SILENT), one(master) as node:
        assert node.says("Connecting to the robot"), node.output
        assert node.interrupt() < IN_TIME


def test_a_node_that_waits_for_a_robot_ends_when_interrupted(master):
    master.set(ONE + "/robot_ip", NOBODY)
    master.set(ONE + "/connect_timeout", 60.0)
    with one(master) as node:
        assert node.says("Connecting to the robot"), node.output
        assert node.interrupt() < IN_TIME


def test_a_node_of_several_arms_that_connects_to_silence_ends_when_interrupted(master, robot):
    master.set(ALL + "/panda_2/robot_ip", SILENT)
    with listening(SILENT), combined(master) as node:
        assert node.says(f"at {SILENT}"), node.output
        assert node.interrupt() < IN_TIME


@pytest.mark.parametrize("reconnect", [True, False], ids=["reconnecting", "lost"])
def test_a_node_whose_robot_is_gone_ends_when_interrupted(master, reconnect):
    master.set(ONE + "/robot_ip", OTHER)
    master.set(ONE + "/reconnect", reconnect)
    with one_with_robot(master) as (node, robot), woken_at_last(robot):
        os.kill(robot.process.pid, signal.SIGSTOP)
        assert node.says("the robot is lost"), node.output
        assert node.interrupt() < IN_TIME


def test_a_node_whose_controller_runs_ends_when_interrupted(master):
    with moving(master) as (node, robot):
        assert node.interrupt() < IN_TIME
        assert node.process.returncode == 0
        assert robot.ask("state").startswith("Idle"), "The motion did not end with the node."


# Neither root nor a member of the group realtime.
UNPRIVILEGED = ("prlimit", "--rtprio=0:0", "--memlock=65536:65536")
if os.geteuid() == 0:
    UNPRIVILEGED += ("setpriv", "--inh-caps=-sys_nice,-ipc_lock", "--bounding-set=-sys_nice,-ipc_lock")


def test_a_node_without_privileges_moves_where_it_need_not_enforce_real_time(master):
    with moving(master, UNPRIVILEGED) as (node, robot):
        assert robot.ask("state").startswith("Move"), node.output


def test_a_node_without_privileges_says_why_it_does_not_move_where_it_must(master):
    master.set(ONE + "/realtime_config", "enforce")
    as_a_real_robot = ("env", "FRANKA_REALTIME=enforce")
    with moving(master, (*as_a_real_robot, *UNPRIVILEGED)) as (node, robot):
        assert node.says("RealtimeConfig::kIgnore"), node.output
        assert "realtime" in node.output
        assert robot.ask("state").startswith("Idle")
        assert node.process.poll() is None
        assert node.interrupt() < IN_TIME


def test_a_motion_outlives_the_master(tmp_path, urdf):
    with ros_nodes.master(tmp_path) as own, moving(prepared(own, urdf)) as (node, robot):
        own.stop()
        before = robot.ask("state")
        time.sleep(2.0)
        after = robot.ask("state")
        assert before.startswith("Move") and after.startswith("Move"), (before, after, node.output)
        assert node.process.poll() is None
        assert node.interrupt() < IN_TIME


def test_a_node_that_waits_for_a_recovery_ends_when_interrupted(master):
    with moving(master) as (node, robot):
        robot.ask("push panda_link7 0 0 -220 60")
        assert node.says("reflex"), node.output
        with woken_at_last(robot):
            asked = master.run("/usr/bin/python3", "-c", ASK_RECOVERY, str(robot.process.pid))
            assert asked.returncode == 0, asked
            assert node.says("recovering") and node.says("the robot is lost"), node.output
            assert node.interrupt() < IN_TIME


@contextmanager
def woken_at_last(robot):
    try:
        yield
    finally:
        os.kill(robot.process.pid, signal.SIGCONT)


@contextmanager
def one_with_robot(master, pace="patient", through=()):
    with simulated("panda", OTHER, pace, "--no-hand") as robot, one(master, *through) as node:
        assert node.says("is ready"), node.output
        yield node, robot


@contextmanager
def moving(master, through=()):
    """A node with a controller that holds the arm."""
    master.set(ONE + "/robot_ip", OTHER)
    for name, parameters in configured("default_controllers.yaml", arm_id="panda").items():
        master.set("/" + name, parameters)
    with one_with_robot(master, "lockstep", through) as (node, robot):
        spawn = ["rosrun", "controller_manager", "controller_manager", "spawn"]
        spawned = master.run(*spawn, "effort_joint_trajectory_controller")
        assert "Started" in spawned.stdout, f"{spawned}\n{node.output}"
        yield node, robot
