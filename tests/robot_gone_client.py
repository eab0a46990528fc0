# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Observes the node while its robot is lost and returns; prints a report as JSON.

Run by test_robot_gone.py with ROS's interpreter. Arguments: the arm, the simulated robot's process
id, whether the node reconnects automatically, then the command that starts another robot.
"""

import json
import os
import signal
import subprocess
import sys
import time

import rospy
import rospy_connections
from controller_manager_msgs.srv import ListControllers, SwitchController
from franka_msgs.msg import FrankaState
from pyfranka.remote import Remote
from recovery_client import CONTROLLER, PUSH, Robot
from std_srvs.srv import Trigger

GONE = 10.0  # time of one silence of the robot [s]


def call(name):
    answer = rospy.ServiceProxy(f"/franka_control/{name}", Trigger)()
    return [answer.success, answer.message]


def node_answers():
    return len(rospy.ServiceProxy("/controller_manager/list_controllers", ListControllers)().controller) >= 2


def fresh_state(robot):
    """Whether new states arrive."""
    robot.state = None
    return robot.waits(lambda: True) is not None


def comes_back(robot, reconnects):
    """After the robot's return: connection, recovery, and the controller continues."""
    report = {"connect": None if reconnects else connect_patiently()}
    robot.waits(lambda: robot.state.robot_mode == FrankaState.ROBOT_MODE_IDLE and robot.has_error)
    deadline = time.monotonic() + 20.0
    recovered = robot.recover()
    while recovered[0] is None and time.monotonic() < deadline:
        recovered = robot.recover()
    report["recovery"] = recovered
    report["moves"] = robot.shows(FrankaState.ROBOT_MODE_MOVE)
    report["follows"] = robot.follows()
    return report


def refusal():
    """Answer of connect without a robot, once the node has noticed."""
    deadline = time.monotonic() + 20.0
    answer = call("connect")
    while "Already connected" in answer[1] and time.monotonic() < deadline:
        time.sleep(0.2)
        answer = call("connect")
    return answer


def connect_patiently():
    """Connects as soon as the robot accepts connections."""
    deadline = time.monotonic() + 20.0
    answer = call("connect")
    while not answer[0] and time.monotonic() < deadline:
        time.sleep(0.2)
        answer = call("connect")
    return answer


def main():
    rospy_connections.init_node("robot_gone_client", anonymous=True)
    pid, reconnects, command = int(sys.argv[2]), sys.argv[3] == "true", sys.argv[4:]
    address = command[command.index("--ip") + 1]
    robot = Robot()
    switch = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)
    report = {"started": switch(start_controllers=[CONTROLLER], strictness=2, timeout=10.0).ok}
    report["moves"] = robot.shows(FrankaState.ROBOT_MODE_MOVE)

    os.kill(pid, signal.SIGSTOP)
    report["silence_noticed"] = robot.waits(lambda: robot.has_error) is not None
    time.sleep(1.0 if reconnects else GONE)
    report["alive_without_robot"] = node_answers()
    os.kill(pid, signal.SIGCONT)
    report["after_silence"] = comes_back(robot, reconnects)

    Remote(address).push(f"{sys.argv[1]}_link7", *PUSH)
    robot.shows(FrankaState.ROBOT_MODE_REFLEX)
    os.kill(pid, signal.SIGSTOP)
    robot.send_recovery()
    time.sleep(0.5)
    os.kill(pid, signal.SIGKILL)
    report["death_noticed"] = robot.waits(lambda: robot.has_error) is not None
    report["alive_after_death"] = node_answers()
    if not reconnects:
        report["refused"] = refusal()
    other = subprocess.Popen(command)
    try:
        report["after_restart"] = comes_back(robot, reconnects)
        report["aborts"] = robot.aborts
        report["stopped"] = switch(stop_controllers=[CONTROLLER], strictness=2, timeout=10.0).ok
        report["idle"] = robot.shows(FrankaState.ROBOT_MODE_IDLE)
        report["disconnect"] = call("disconnect")
        report["connect_again"] = call("connect")
        report["fresh"] = fresh_state(robot)
        print(json.dumps(report))
    finally:
        other.kill()
        other.wait()


if __name__ == "__main__":
    main()
