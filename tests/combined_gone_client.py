# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Two arms on franka_combined_control_node whose robots are killed in turn; prints a report as JSON.

Run by test_combined_gone.py with ROS's interpreter. Arguments: the kind of the robots, and the arms with
their addresses and processes, as panda_1=127.0.0.1=4711. The second arm reconnects automatically.
"""

import json
import os
import signal
import sys
import time
from contextlib import ExitStack
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parent / "support"))

import rospy  # noqa: E402
import rospy_connections  # noqa: E402
from combined_client import CONTROLLER, NODE, Arm, all_move, move, recovery, waits  # noqa: E402
from controller_manager_msgs.srv import ListControllers, LoadController, SwitchController  # noqa: E402
from diagnosis import Diagnosis  # noqa: E402
from franka_msgs.msg import FrankaState  # noqa: E402
from franka_msgs.srv import SetLoad  # noqa: E402
from pyfranka.franka_sim import FrankaSim, SimRobot  # noqa: E402
from std_msgs.msg import String  # noqa: E402
from std_srvs.srv import Trigger  # noqa: E402

ALONE = "trajectory_controller_alone"


class Node:
    def __init__(self):
        self._switch = rospy.ServiceProxy(f"{NODE}/controller_manager/switch_controller", SwitchController)
        self._list = rospy.ServiceProxy(f"{NODE}/controller_manager/list_controllers", ListControllers)
        self.diagnosis = Diagnosis(NODE[1:])

    def switch(self, start=(), stop=()):
        return self._switch(
            start_controllers=list(start), stop_controllers=list(stop), strictness=2, timeout=15.0
        ).ok

    def lists(self):
        return CONTROLLER in [controller.name for controller in self._list().controller]

    def call(self, name):
        answer = rospy.ServiceProxy(f"{NODE}/{name}", Trigger)()
        return [answer.success, answer.message]

    def offers(self, arm):
        """Services of an arm, out of those that this test uses."""
        expected = ("connect", "disconnect", "set_load")
        _, _, (_, _, services) = rospy.get_master().getSystemState()
        names = {name for name, _ in services}
        return [name for name in expected if f"{NODE}/{arm.name}/{name}" in names]


def kill(pid):
    os.kill(pid, signal.SIGKILL)


def loses(node, arm, other):
    """Reports of the node after the loss of the first robot."""
    report = {"noticed": waits(lambda: arm.has_error and other.mode == FrankaState.ROBOT_MODE_IDLE)}
    report["diagnosis"] = node.diagnosis.shows(arm.name, "Not connected to the robot")
    waits(lambda: other.has_error)
    at = list(other.state.q)
    begin = time.monotonic()
    answer = rospy.ServiceProxy(f"{NODE}/{other.name}/set_load", SetLoad)(load_inertia=[0.0] * 9)
    report["setter"] = [answer.success, answer.error]
    report["listed"] = node.lists()
    report["seconds"] = time.monotonic() - begin
    report["other"] = [other.mode, other.has_error]
    report["offered"] = [node.offers(other), node.offers(arm)]
    report["connect"] = node.call("connect")
    report["recovery"] = recovery(f"{NODE}/error_recovery")
    report["abort"] = rospy.wait_for_message(f"{NODE}/{arm.name}/abort", String, 15.0).data
    count = other.state.header.seq
    report["fresh"] = waits(lambda: other.state.header.seq > count + 5)
    report["stays"] = max(abs(a - b) for a, b in zip(at, other.state.q))
    report["diagnosis of the other"] = node.diagnosis.status_when(
        other.name, lambda _, v: v.get("Mode") == "Idle"
    )
    return report


def load_alone(other):
    """Loads a controller for the other arm only, configured like the one for both."""
    parameters = rospy.get_param(f"{NODE}/{CONTROLLER}")
    parameters["joints"] = [joint for joint in parameters["joints"] if joint.startswith(other.name)]
    rospy.set_param(f"{NODE}/{ALONE}", parameters)
    return rospy.ServiceProxy(f"{NODE}/controller_manager/load_controller", LoadController)(ALONE).ok


def goes_on_alone(node, arm, other):
    report = {"refused": node.call(f"{arm.name}/disconnect")}
    node.switch(stop=[CONTROLLER])
    report["given_up"] = node.call(f"{arm.name}/disconnect")
    report["error_gone"] = waits(lambda: not other.has_error and not arm.has_error)
    report["both"] = node.switch([CONTROLLER])
    report["started"] = load_alone(other) and node.switch([ALONE])
    report["moves"] = all_move([other])
    report["error"] = move([other], 0.1, ALONE)
    return report


def is_taken_again(node, arm, other):
    report = {"connect": node.call(f"{arm.name}/connect")}
    waits(lambda: arm.mode == FrankaState.ROBOT_MODE_IDLE)
    report["undisturbed"] = other.mode == FrankaState.ROBOT_MODE_MOVE and not other.has_error
    report["both"] = node.switch([CONTROLLER], [ALONE])
    report["move"] = all_move([arm, other])
    report["error"] = move([arm, other], -0.05)
    return report


def comes_back_by_itself(node, arm, other):
    """After the second robot was killed and restarted."""
    report = {
        "back": node.diagnosis.status_when(arm.name, lambda _, v: v.get("Mode") == "Idle")[1] == arm.name
    }
    waits(lambda: "set_load" in node.offers(arm) and arm.mode == FrankaState.ROBOT_MODE_IDLE)
    time.sleep(1.0)  # in which no arm may move
    report["waits"] = arm.has_error and FrankaState.ROBOT_MODE_MOVE not in (arm.mode, other.mode)
    report["recovery"] = recovery(f"{NODE}/error_recovery")
    report["move"] = all_move([arm, other])
    report["error"] = move([arm, other], -0.05)
    return report


def main():
    rospy_connections.init_node("combined_gone_client", anonymous=True)
    kind, *named = sys.argv[1], *(argument.split("=") for argument in sys.argv[2:])
    arms = [Arm(name, address) for name, address, _ in named]
    (_, _, first_pid), (_, _, second_pid) = named
    node = Node()
    waits(lambda: all(arm.state for arm in arms))
    report = {"started": node.switch([CONTROLLER]), "moves": all_move(arms)}
    move(arms, 0.05)
    report["diagnosis"] = {arm.name: node.diagnosis.shows(arm.name, "Ready", Mode="Move") for arm in arms}
    report["diagnosis"]["Control loop"] = node.diagnosis.status_when("Control loop", lambda *_: True)
    first, second = arms
    with ExitStack() as started:

        def restart(address):
            robot = SimRobot(kind, address=address, hand="none")
            started.enter_context(FrankaSim(robot, pace="patient"))

        kill(int(first_pid))
        report["lost"] = loses(node, first, second)
        report["alone"] = goes_on_alone(node, first, second)
        restart(named[0][1])
        report["again"] = is_taken_again(node, first, second)
        kill(int(second_pid))
        noticed = waits(lambda: second.has_error and first.mode == FrankaState.ROBOT_MODE_IDLE)
        restart(named[1][1])
        report["by_itself"] = {"noticed": noticed, **comes_back_by_itself(node, second, first)}
        print(json.dumps(report))


if __name__ == "__main__":
    main()
