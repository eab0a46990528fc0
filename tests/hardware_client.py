# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Uses franka_control_node and franka_gripper_node like a user; prints a report as JSON.

Run by test_hardware.py with the interpreter that ROS uses.
"""

import json
import sys
import time

import actionlib
import rospy
import rospy_connections
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal
from controller_manager_msgs.srv import ListControllers, SwitchController
from franka_gripper.msg import MoveAction, MoveGoal
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from franka_msgs.srv import SetJointImpedance, SetLoad
from sensor_msgs.msg import JointState
from std_srvs.srv import Trigger
from trajectory_msgs.msg import JointTrajectoryPoint

NO_INERTIA = [0.0] * 9


def state(timeout=10.0):
    return rospy.wait_for_message("/franka_state_controller/franka_states", FrankaState, timeout)


def controllers():
    listed = rospy.ServiceProxy("/controller_manager/list_controllers", ListControllers)()
    return {controller.name: controller.state for controller in listed.controller}


def wait_running(name, timeout=30.0):
    deadline = time.monotonic() + timeout
    while time.monotonic() < deadline:
        if controllers().get(name) == "running":
            return True
        time.sleep(0.1)
    return False


def action(name, kind, goal, timeout=30.0):
    client = actionlib.SimpleActionClient(name, kind)
    if not client.wait_for_server(rospy.Duration(timeout)):
        return "no server"
    client.send_goal(goal)
    if not client.wait_for_result(rospy.Duration(timeout)):
        return "no result"
    return [client.get_state(), client.get_goal_status_text(), getattr(client.get_result(), "error", "")]


def move_arm(controller, joints, by, seconds):
    """Moves all joints by the same angle; returns the action's result and the largest error."""
    begin = state()
    goal = FollowJointTrajectoryGoal()
    goal.trajectory.joint_names = joints
    target = [q + by for q in begin.q]
    goal.trajectory.points = [
        JointTrajectoryPoint(positions=target, velocities=[0.0] * 7, time_from_start=rospy.Duration(seconds))
    ]
    ended = action(f"/{controller}/follow_joint_trajectory", FollowJointTrajectoryAction, goal)
    time.sleep(0.5)
    return ended, max(abs(a - b) for a, b in zip(state().q, target))


def switch(start, stop):
    return rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)(
        start_controllers=start, stop_controllers=stop, strictness=2, timeout=10.0
    ).ok


def main():
    rospy_connections.init_node("hardware_client", anonymous=True)
    arm = sys.argv[1]
    joints = [f"{arm}_joint{i}" for i in range(1, 8)]
    report = {"state_controller": wait_running("franka_state_controller")}
    report["mode_idle"] = state().robot_mode
    set_load = rospy.ServiceProxy("/franka_control/set_load", SetLoad)
    answer = set_load(mass=0.5, F_x_center_load=[0, 0, 0.05], load_inertia=NO_INERTIA)
    report["set_load"] = [answer.success, answer.error]
    answer = set_load(mass=-1.0, F_x_center_load=[0, 0, 0], load_inertia=NO_INERTIA)
    report["bad_load"] = [answer.success, answer.error]
    time.sleep(0.3)
    report["m_load"] = state().m_load
    set_load(mass=0.0, F_x_center_load=[0, 0, 0], load_inertia=NO_INERTIA)

    for controller in ("effort_joint_trajectory_controller", "position_joint_trajectory_controller"):
        report[controller] = {"running": wait_running(controller, 1.0) or switch([controller], [])}
        ended, error = move_arm(controller, joints, 0.1, 2.0)
        report[controller].update(ended=ended, error=error, mode=state().robot_mode)
        answer = rospy.ServiceProxy("/franka_control/set_joint_impedance", SetJointImpedance)([1000.0] * 7)
        report[controller]["setter"] = [answer.success, answer.error]
        report[controller]["disconnect"] = rospy.ServiceProxy("/franka_control/disconnect", Trigger)().message
        report[controller]["stopped"] = switch([], [controller])

    ended = action("/franka_control/error_recovery", ErrorRecoveryAction, ErrorRecoveryGoal())
    report["recovery"] = ended
    report["gripper_move"] = action("/franka_gripper/move", MoveAction, MoveGoal(width=0.05, speed=0.1))
    fingers = rospy.wait_for_message("/franka_gripper/joint_states", JointState, 5.0)
    report["fingers"] = list(fingers.position)
    report["gripper_bad"] = action("/franka_gripper/move", MoveAction, MoveGoal(width=0.5, speed=0.1))
    report["disconnect"] = rospy.ServiceProxy("/franka_control/disconnect", Trigger)().success
    report["connect"] = rospy.ServiceProxy("/franka_control/connect", Trigger)().success
    report["twice"] = rospy.ServiceProxy("/franka_control/connect", Trigger)().message
    report["after"] = state().robot_mode
    print(json.dumps(report))


if __name__ == "__main__":
    main()
