# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The manual's pick and place with its own command lines, typed into a shell; prints a report as JSON.

Where the manual lets the user drag rviz's marker, the marker's feedback is published as rviz does it.
Run by test_manual_commands.py with the interpreter that ROS uses. Argument: the real-time factor.
"""

import json
import math
import subprocess
import sys
import time

import rospy
import rospy_connections
from franka_gripper.msg import (
    GraspActionResult,
    HomingActionResult,
    MoveActionResult,
    StopActionResult,
)
from franka_msgs.msg import ErrorRecoveryActionResult, FrankaState
from franka_sim_mujoco.geometry import pose_of
from franka_sim_mujoco.pick_and_place import Arm, Gripper, PickAndPlace, Scene, TaskError, wait_until
from franka_sim_mujoco.srv import SetRealTimeFactor
from visualization_msgs.msg import InteractiveMarkerFeedback

NULLSPACE = """rosrun dynamic_reconfigure dynparam set \\
  /cartesian_impedance_example_controller/dynamic_reconfigure_compliance_param_node nullspace_stiffness 10"""
HOMING = "rostopic pub --once /franka_gripper/homing/goal franka_gripper/HomingActionGoal {}"
OPEN = """rostopic pub --once /franka_gripper/move/goal franka_gripper/MoveActionGoal "goal: {
width: 0.08, speed: 0.1 }\""""
GRASP = """rostopic pub --once /franka_gripper/grasp/goal franka_gripper/GraspActionGoal "goal: {
width: 0.03, epsilon: { inner: 0.005, outer: 0.005 }, speed: 0.1, force: 5.0 }\""""
STOP = "rostopic pub --once /franka_gripper/stop/goal franka_gripper/StopActionGoal {}"
PRESS = 'rosservice call /franka_control/set_user_stop "data: true"'
RELEASE = 'rosservice call /franka_control/set_user_stop "data: false"'
RECOVER = 'rostopic pub -1 /franka_control/error_recovery/goal franka_msgs/ErrorRecoveryActionGoal "{}"'
CONFIGURE = """rosservice call /set_franka_model_configuration "joint_names: [panda_joint1]
joint_positions: [{:.3f}]\""""

JOINT_STEP = 0.05  # [rad]
RVIZ_PERIOD = 1 / 30  # [s] between rviz's messages while its marker is dragged
LIMIT = 120.0  # wall seconds for any wait


class Shell:
    """Types lines; does not wait for a line that keeps running (rostopic pub, after its message)."""

    def __init__(self):
        self._lines = []

    def begin(self, line: str) -> None:
        pipes = {"stdout": subprocess.PIPE, "stderr": subprocess.STDOUT, "stdin": subprocess.DEVNULL}
        self._lines.append((line, subprocess.Popen(["bash", "-c", line], text=True, **pipes)))

    def run(self, line: str) -> str:
        self.begin(line)
        return self._end(*self._lines.pop())

    def end(self) -> None:
        while self._lines:
            self._end(*self._lines.pop(0))

    def close(self) -> None:
        for _, process in self._lines:
            process.kill()

    @staticmethod
    def _end(line: str, process: subprocess.Popen) -> str:
        output, _ = process.communicate(timeout=LIMIT)
        if process.returncode != 0:
            raise TaskError(f"{line} ended with status {process.returncode}:\n{output}")
        return output


class DraggedArm(Arm):
    """An arm whose target is the dragged marker."""

    def __init__(self, arm_id: str, shell: Shell):
        super().__init__(arm_id)
        self._shell, self._last_sent = shell, 0.0
        topic = "equilibrium_pose_marker/feedback"
        self._publisher = rospy.Publisher(topic, InteractiveMarkerFeedback, queue_size=1)

    def configure(self, **_) -> None:
        self._shell.run(NULLSPACE)

    def set_load(self, *_) -> None:
        """Does nothing: the manual sets no load."""

    def _lead(self, target) -> None:
        if time.monotonic() - self._last_sent < RVIZ_PERIOD:
            return
        self._last_sent = time.monotonic()
        feedback = InteractiveMarkerFeedback(client_id="/rviz", marker_name="equilibrium_pose")
        feedback.header.frame_id = f"{self.arm_id}_link0"
        feedback.event_type = InteractiveMarkerFeedback.POSE_UPDATE
        feedback.pose = pose_of(target)
        self._publisher.publish(feedback)


class TypedGripper(Gripper):
    """A gripper whose goals are typed, with the manual's widths, speeds and forces."""

    RESULTS = {
        "homing": HomingActionResult,
        "move": MoveActionResult,
        "grasp": GraspActionResult,
        "stop": StopActionResult,
    }

    def __init__(self, shell: Shell):
        super().__init__()
        self._shell, self._results = shell, {name: [] for name in self.RESULTS}
        for name, kind in self.RESULTS.items():
            rospy.Subscriber(f"franka_gripper/{name}/result", kind, self._results[name].append)

    def homing(self) -> None:
        self._type("homing", HOMING)

    def move(self, *_, **__) -> None:
        self._type("move", OPEN)

    def grasp(self, *_, **__) -> None:
        self._type("grasp", GRASP)

    def stop(self) -> None:
        self._type("stop", STOP)

    def _type(self, name: str, line: str) -> None:
        results = self._results[name]
        known = len(results)
        self._shell.begin(line)
        wait_until(lambda: len(results) > known, f"the result of: {line}", math.inf, LIMIT)
        if not results[-1].result.success:
            raise TaskError(f"{line} failed: {results[-1].result.error or results[-1].status.text}")


class Observed(PickAndPlace):
    """Records the observations that the manual describes."""

    def __init__(self, arm, gripper, scene):
        super().__init__(arm, gripper, scene, lambda _: None)
        self.seen = {}

    def finger_gap(self) -> float:
        hand = self.scene
        left, right = (hand.pose(finger)[:3, 3] for finger in self.arm.fingers)
        return math.dist(left, right)

    def grip_force(self) -> float:
        return self.scene.grip_force("stone", self.arm.fingers)

    def note(self, name: str) -> None:
        x, y, z = self.scene.pose("stone")[:3, 3]
        self.seen[name] = {"gap": self.finger_gap(), "force": self.grip_force(), "stone": [x, y, z]}

    def all_steps(self) -> dict:
        self.note("begin")
        self.prepare()
        self.note("open")
        self.pick()
        self.note("lifted")
        self.carry()
        self.note("above the red tray")
        self.place()
        self.note("let go")
        placed = self.placement()
        self.seen["placed"] = {"in_tray": placed.in_tray, "distance": placed.distance}
        return self.seen


def stops(arm: Arm, shell: Shell) -> dict:
    """The user stop; a joint is moved while the controller is disconnected; then recovery."""
    recoveries = []
    rospy.Subscriber("franka_control/error_recovery/result", ErrorRecoveryActionResult, recoveries.append)

    def until(condition, what):
        wait_until(condition, what, math.inf, LIMIT)

    said = {"press": shell.run(PRESS)}
    until(lambda: arm.state.robot_mode == FrankaState.ROBOT_MODE_USER_STOPPED, "the stop")
    said["release"] = shell.run(RELEASE)
    until(lambda: arm.state.robot_mode == FrankaState.ROBOT_MODE_IDLE, "the end of the stop")
    elsewhere = arm.state.q[0] + JOINT_STEP
    said["configure"] = shell.run(CONFIGURE.format(elsewhere))
    until(lambda: abs(arm.state.q[0] - elsewhere) < 0.1 * JOINT_STEP, "joint 1 where it was put")
    shell.begin(RECOVER)
    until(lambda: arm.state.robot_mode == FrankaState.ROBOT_MODE_MOVE and recoveries, "the recovery")
    return {"said": said, "recovery": recoveries[-1].status.status}


def main():
    rospy_connections.init_node("manual_commands")
    set_factor = rospy.ServiceProxy("/gazebo/set_real_time_factor", SetRealTimeFactor)
    set_factor.wait_for_service(LIMIT)
    set_factor(float(sys.argv[1]))
    shell = Shell()
    try:
        arm = DraggedArm("panda", shell)
        result = Observed(arm, TypedGripper(shell), Scene()).all_steps()
        result["stops"] = stops(arm, shell)
        shell.end()
    finally:
        shell.close()
    print(json.dumps(result))


if __name__ == "__main__":
    main()
