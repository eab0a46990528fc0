# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Causes reflexes and user stops while a controller runs; prints a report as JSON.

Run by test_recovery.py with the interpreter that ROS uses. Arguments: the arm, the address of the simulated
robot, how many reflexes.
"""

import json
import sys
import time

import actionlib
import rospy
import rospy_connections
from actionlib_msgs.msg import GoalStatus
from controller_manager_msgs.srv import ListControllers, SwitchController
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal, FrankaState
from geometry_msgs.msg import PoseStamped
from pyfranka.remote import Remote
from std_msgs.msg import Bool, String

CONTROLLER = "cartesian_impedance_example_controller"
PATIENCE = 15.0  # limit for immediate reactions [s]
PUSH = (0, 0, -220), 60  # far beyond the thresholds [N, ms]


class Robot:
    """The node's topics, services and actions."""

    def __init__(self):
        self.state = None
        self.has_error = None
        self.aborts = []
        rospy.Subscriber("/franka_state_controller/franka_states", FrankaState, self._store, queue_size=1)
        rospy.Subscriber("/franka_control/has_error", Bool, lambda m: setattr(self, "has_error", m.data))
        rospy.Subscriber("/franka_control/abort", String, lambda m: self.aborts.append(m.data))
        self._target = rospy.Publisher(f"/{CONTROLLER}/equilibrium_pose", PoseStamped, queue_size=1)
        self._recovery = actionlib.ActionClient("/franka_control/error_recovery", ErrorRecoveryAction)
        if not self._recovery.wait_for_server(rospy.Duration(30.0)):
            raise RuntimeError("no error_recovery")
        self._list = rospy.ServiceProxy("/controller_manager/list_controllers", ListControllers)

    def _store(self, state):
        self.state = state

    def waits(self, condition):
        """Time until a condition held [s], or None."""
        begin = time.monotonic()
        while time.monotonic() - begin < PATIENCE:
            if self.state is not None and condition():
                return time.monotonic() - begin
            time.sleep(0.005)
        return None

    def shows(self, mode):
        return self.waits(lambda: self.state.robot_mode == mode) is not None

    def send_recovery(self):
        return self._recovery.send_goal(ErrorRecoveryGoal())

    def result_of(self, goal):
        """[status, text] of a requested recovery."""
        if self.waits(lambda: goal.get_comm_state() == actionlib.CommState.DONE) is None:
            return [None, "no answer"]
        return [goal.get_terminal_state(), goal.get_goal_status_text()]

    def recover(self):
        return self.result_of(self.send_recovery())

    def runs(self):
        return {c.name: c.state for c in self._list().controller}.get(CONTROLLER)

    def follows(self):
        """Whether the end effector reaches the controller's target: 3 cm up or down."""
        target = PoseStamped()
        target.header.frame_id = f"{sys.argv[1]}_link0"
        x, y, z = self.state.O_T_EE[12:15]
        up = 0.03 if z < 0.5 else -0.03
        target.pose.position.x, target.pose.position.y, target.pose.position.z = x, y, z + up
        target.pose.orientation.x = 1.0
        self._target.publish(target)
        return self.waits(lambda: abs(self.state.O_T_EE[14] - z) > 0.01) is not None


def reflexes(robot, operator, count):
    outcomes = []
    for _ in range(count):
        robot.aborts.clear()
        operator.push(f"{sys.argv[1]}_link7", *PUSH)
        outcome = {"reflex": robot.shows(FrankaState.ROBOT_MODE_REFLEX)}
        outcome["has_error"] = robot.waits(lambda: robot.has_error) is not None
        outcome["reported"] = robot.waits(lambda: bool(robot.aborts)) is not None and robot.aborts[0]
        outcome["recovery"] = robot.recover()
        outcome["moves"] = robot.shows(FrankaState.ROBOT_MODE_MOVE)
        outcome["error_gone"] = robot.waits(lambda: not robot.has_error) is not None
        outcome["controller"] = robot.runs()
        outcome["follows"] = robot.follows()
        outcomes.append(outcome)
    return outcomes


def user_stop(robot, operator):
    operator.user_stop(True)
    report = {"stopped": robot.shows(FrankaState.ROBOT_MODE_USER_STOPPED)}
    report["has_error"] = robot.waits(lambda: robot.has_error) is not None
    report["recovery_while_pressed"] = robot.recover()
    report["still_stopped"] = robot.state.robot_mode == FrankaState.ROBOT_MODE_USER_STOPPED
    operator.user_stop(False)
    report["moves"] = robot.shows(FrankaState.ROBOT_MODE_MOVE)
    report["follows"] = robot.follows()
    return report


def main():
    rospy_connections.init_node("recovery_client", anonymous=True)
    robot, operator = Robot(), Remote(sys.argv[2])
    switch = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)
    started = switch(start_controllers=[CONTROLLER], strictness=2, timeout=10.0).ok
    report = {"started": started, "moves": robot.shows(FrankaState.ROBOT_MODE_MOVE)}
    report["early"] = robot.recover()
    report["goes_on"] = robot.follows()
    report["reflexes"] = reflexes(robot, operator, int(sys.argv[3]))
    operator.push(f"{sys.argv[1]}_link7", *PUSH)
    robot.shows(FrankaState.ROBOT_MODE_REFLEX)
    robot.waits(lambda: robot.has_error)
    both = [robot.send_recovery(), robot.send_recovery()]
    report["twice"] = [robot.result_of(goal) for goal in both]
    report["follows_after_both"] = robot.shows(FrankaState.ROBOT_MODE_MOVE) and robot.follows()
    report["user_stop"] = user_stop(robot, operator)
    report["stopped"] = switch(stop_controllers=[CONTROLLER], strictness=2, timeout=10.0).ok
    report["idle"] = robot.shows(FrankaState.ROBOT_MODE_IDLE)
    operator.push(f"{sys.argv[1]}_link7", *PUSH)
    report["hit_at_rest"] = robot.shows(FrankaState.ROBOT_MODE_REFLEX)
    report["recovered_at_rest"] = [robot.recover()[0], robot.shows(FrankaState.ROBOT_MODE_IDLE)]
    report["succeeded"] = GoalStatus.SUCCEEDED
    print(json.dumps(report))


if __name__ == "__main__":
    main()
