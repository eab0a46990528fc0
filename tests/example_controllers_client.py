# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Starts the example controllers in turn on franka_control_node; prints the robot's motions as JSON.

Run by test_example_controllers.py with the interpreter that ROS uses. Arguments: the arm, then controllers.
"""

import json
import sys
import time

import actionlib
import rospy
import rospy_connections
from control_msgs.msg import FollowJointTrajectoryAction, FollowJointTrajectoryGoal
from controller_manager_msgs.srv import LoadController, SwitchController, UnloadController
from franka_msgs.msg import FrankaState
from std_msgs.msg import String
from trajectory_msgs.msg import JointTrajectoryPoint

RUNS = 2.5  # [s]
STRICT = 2
RETURNS = "effort_joint_trajectory_controller"


def state():
    return rospy.wait_for_message("/franka_state_controller/franka_states", FrankaState, 5.0)


def main():
    rospy_connections.init_node("example_controllers_client", anonymous=True)
    arm, names = sys.argv[1], sys.argv[2:]
    switch = rospy.ServiceProxy("/controller_manager/switch_controller", SwitchController)
    load = rospy.ServiceProxy("/controller_manager/load_controller", LoadController)
    unload = rospy.ServiceProxy("/controller_manager/unload_controller", UnloadController)
    aborts = []
    rospy.Subscriber("/franka_control/abort", String, lambda message: aborts.append(message.data))
    client = actionlib.SimpleActionClient(f"/{RETURNS}/follow_joint_trajectory", FollowJointTrajectoryAction)
    home = state().q

    def go_home():
        started = switch(start_controllers=[RETURNS], strictness=STRICT, timeout=5.0).ok
        if not started or not client.wait_for_server(rospy.Duration(5.0)):
            raise RuntimeError(f"{RETURNS} does not run")
        goal = FollowJointTrajectoryGoal()
        goal.trajectory.joint_names = [f"{arm}_joint{i}" for i in range(1, 8)]
        goal.trajectory.points = [
            JointTrajectoryPoint(
                positions=list(home), velocities=[0.0] * 7, time_from_start=rospy.Duration(1.5)
            )
        ]
        client.send_goal(goal)
        # The client's callbacks may be late; only the arm's position counts.
        deadline = time.monotonic() + 10.0
        while time.monotonic() < deadline and max(abs(a - b) for a, b in zip(state().q, home)) > 0.02:
            time.sleep(0.1)
        if max(abs(a - b) for a, b in zip(state().q, home)) > 0.02:
            result = f"status {client.get_state()} {client.get_goal_status_text()} {client.get_result()}"
            print(f"The arm did not come home: {result}", file=sys.stderr, flush=True)
        switch(stop_controllers=[RETURNS], strictness=STRICT, timeout=5.0)

    report = {}
    for name in names:
        controller = name + "_example_controller"
        outcome = {"loaded": load(controller).ok}
        outcome["started"] = switch(start_controllers=[controller], strictness=STRICT, timeout=5.0).ok
        begin = state()
        time.sleep(RUNS)
        end = state()
        outcome["mode"] = end.robot_mode
        outcome["rate"] = end.control_command_success_rate
        outcome["moved"] = max(abs(a - b) for a, b in zip(begin.q, end.q))
        outcome["lifted"] = abs(begin.O_T_EE[14] - end.O_T_EE[14])
        outcome["stopped"] = switch(stop_controllers=[controller], strictness=STRICT, timeout=5.0).ok
        time.sleep(0.5)
        outcome["mode_after"] = state().robot_mode
        unload(controller)
        outcome["aborts"] = aborts[:]
        aborts.clear()
        go_home()
        report[name] = outcome
    print(json.dumps(report))


if __name__ == "__main__":
    main()
