# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Several arms on franka_combined_control_node, one of which hits something; prints a report as JSON.

Run by test_combined.py with ROS's interpreter. Arguments: the arms with their addresses, as
panda_1=127.0.0.1.
"""

import json
import sys
import time

import actionlib
import rospy
import rospy_connections
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal
from controller_manager_msgs.srv import SwitchController
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from pyfranka.remote import Remote
from recovery_client import PUSH
from std_msgs.msg import Bool
from trajectory_msgs.msg import JointTrajectoryPoint

NODE = "/combined_panda"
CONTROLLER = "effort_joint_trajectory_controller"
PATIENCE = 15.0  # limit for immediate reactions [s]


class Arm:
    def __init__(self, name, address):
        self.name, self.operator = name, Remote(address)
        self.state, self.has_error = None, None
        states = f"{NODE}/{name}_state_controller/franka_states"
        rospy.Subscriber(states, FrankaState, lambda m: setattr(self, "state", m), queue_size=1)
        rospy.Subscriber(f"{NODE}/{name}/has_error", Bool, lambda m: setattr(self, "has_error", m.data))
        self.recovery = f"{NODE}/{name}/error_recovery"

    @property
    def mode(self):
        return self.state.robot_mode if self.state else None


def waits(condition, patience=PATIENCE):
    deadline = time.monotonic() + patience
    while time.monotonic() < deadline:
        if condition():
            return True
        time.sleep(0.005)
    return False


def recover(name):
    """State of a finished recovery."""
    return recovery(name)[0]


def recovery(name):
    """The same, and its message."""
    client = actionlib.ActionClient(name, ErrorRecoveryAction)
    if not client.wait_for_server(rospy.Duration(PATIENCE)):
        return ["no server", ""]
    goal = client.send_goal(ErrorRecoveryGoal())
    waits(lambda: goal.get_comm_state() == actionlib.CommState.DONE)
    return [goal.get_terminal_state(), goal.get_goal_status_text()]


def move(arms, by, controller=CONTROLLER):
    """Moves all joints of these arms by the same angle; returns the largest error [rad]."""
    targets = {f"{arm.name}_joint{i + 1}": arm.state.q[i] + by for arm in arms for i in range(7)}
    goal = FollowJointTrajectoryGoal()
    goal.trajectory.joint_names = list(targets)
    goal.trajectory.points = [
        JointTrajectoryPoint(
            positions=list(targets.values()),
            velocities=[0.0] * len(targets),
            time_from_start=rospy.Duration(2.0),
        )
    ]
    client = actionlib.ActionClient(
        f"{NODE}/{controller}/follow_joint_trajectory", FollowJointTrajectoryAction
    )
    if not client.wait_for_server(rospy.Duration(PATIENCE)):
        return None
    handle = client.send_goal(goal)
    waits(lambda: handle.get_comm_state() == actionlib.CommState.DONE)
    time.sleep(0.5)
    errors = [abs(arm.state.q[i] - targets[f"{arm.name}_joint{i + 1}"]) for arm in arms for i in range(7)]
    return max(errors)


def all_move(arms):
    return waits(lambda: all(arm.mode == FrankaState.ROBOT_MODE_MOVE for arm in arms))


def hit(arm, others):
    """Pushes one arm until its reflex; the others must not change."""
    arm.operator.push(f"{arm.name}_link7", *PUSH)
    outcome = {"reflex": waits(lambda: arm.mode == FrankaState.ROBOT_MODE_REFLEX and arm.has_error)}
    time.sleep(1.0)
    outcome["others"] = [[other.mode, other.has_error] for other in others]
    outcome["others_at"] = [list(other.state.q) for other in others]
    return outcome


def main():
    rospy_connections.init_node("combined_client", anonymous=True)
    arms = [Arm(*argument.split("=")) for argument in sys.argv[1:]]
    report = {"states": waits(lambda: all(arm.state for arm in arms))}
    switch = rospy.ServiceProxy(f"{NODE}/controller_manager/switch_controller", SwitchController)
    report["started"] = switch(start_controllers=[CONTROLLER], strictness=2, timeout=10.0).ok
    report["moves"] = all_move(arms)
    report["error"] = move(arms, 0.1)

    report["early"] = [recover(name) for name in (arms[0].recovery, f"{NODE}/error_recovery")]
    report["goes_on"] = all(arm.mode == FrankaState.ROBOT_MODE_MOVE for arm in arms)
    report["hit"] = hit(arms[0], arms[1:])
    report["recovered"] = recover(arms[0].recovery)
    report["moves_again"] = all_move(arms)
    report["others_at"] = [list(other.state.q) for other in arms[1:]]
    report["error_again"] = move(arms, -0.05)

    for arm in arms:
        arm.operator.push(f"{arm.name}_link7", *PUSH)
    report["all_hit"] = waits(lambda: all(arm.has_error for arm in arms))
    report["all_recovered"] = recover(f"{NODE}/error_recovery")
    report["all_move"] = all_move(arms)
    report["error_at_last"] = move(arms, -0.05)
    report["stopped"] = switch(stop_controllers=[CONTROLLER], strictness=2, timeout=10.0).ok
    report["idle"] = waits(lambda: all(arm.mode == FrankaState.ROBOT_MODE_IDLE for arm in arms))
    print(json.dumps(report))


if __name__ == "__main__":
    main()
