# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The manual's pick and place with its own command lines in a shell; in the long form with rviz on a screen.

Where the manual lets the user drag rviz's marker, the marker's feedback is published as rviz does it.
"""

import math
import re
import subprocess
import time
from contextlib import nullcontext
from pathlib import Path

import pytest
import rospy
from franka_gripper.msg import (
    GraspActionResult,
    HomingActionResult,
    MoveActionResult,
    StopActionResult,
)
from franka_msgs.msg import ErrorRecoveryActionResult, FrankaState
from franka_sim_mujoco.geometry import pose_of
from franka_sim_mujoco.pick_and_place import Arm, Gripper, PickAndPlace, Scene, TaskError
from franka_sim_mujoco.session import ShellSession
from franka_sim_mujoco.srv import SetRealTimeFactor
from ros_client import call, join
from screen import picture_of, virtual_screen, with_rviz
from visualization_msgs.msg import InteractiveMarkerFeedback
from waiting import wait_for

LAUNCH = """roslaunch franka_gazebo panda.launch x:=-0.5 \\
  world:=$(rospack find franka_gazebo)/world/stone.sdf \\
  controller:=cartesian_impedance_example_controller \\
  rviz:=true
"""
WITHOUT_WINDOWS = LAUNCH.replace("rviz:=true", "rviz:=false headless:=true interactive_marker:=true")
SUCCEEDED = 3
PATIENCE = 120.0  # wall seconds for any wait
WINDOW_WIDTH = 1200  # of the simulation and of rviz
STONE_WIDTH = 0.032  # [m] between the fingers

ALLOWED = "no such package media_export"  # an error of Debian's rviz, which searches for an optional package

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
RVIZ_PERIOD = 1 / 60  # [s] between rviz's messages while its marker is dragged

pytestmark = pytest.mark.own_process


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
        output, _ = process.communicate(timeout=PATIENCE)
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
        wait_for(lambda: len(results) > known, f"The result of: {line}", PATIENCE)
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

    answers = {"press": shell.run(PRESS)}
    wait_for(lambda: arm.state.robot_mode == FrankaState.ROBOT_MODE_USER_STOPPED, "The stop")
    answers["release"] = shell.run(RELEASE)
    wait_for(lambda: arm.state.robot_mode == FrankaState.ROBOT_MODE_IDLE, "The end of the stop")
    elsewhere = arm.state.q[0] + JOINT_STEP
    answers["configure"] = shell.run(CONFIGURE.format(elsewhere))
    wait_for(lambda: abs(arm.state.q[0] - elsewhere) < 0.1 * JOINT_STEP, "Joint 1 where it was put")
    shell.begin(RECOVER)
    wait_for(lambda: arm.state.robot_mode == FrankaState.ROBOT_MODE_MOVE and recoveries, "The recovery")
    return {"answers": answers, "recovery": recoveries[-1].status.status}


def wait_for_rviz(session, picture: Path) -> None:
    """Waits until rviz, beside the simulation's window, shows more than an empty scene."""

    def is_drawn():
        session.check()
        return picture_of("- RViz", picture, WINDOW_WIDTH) > 500

    wait_for(is_drawn, "The robot in rviz", PATIENCE, 0.5)


def started(folder: Path, with_rviz: bool) -> ShellSession:
    """The launch, once rviz shows the robot."""
    session = ShellSession(LAUNCH if with_rviz else WITHOUT_WINDOWS, log=folder / "launch.log").__enter__()
    try:
        session.wait_for_master()
        if with_rviz:
            wait_for_rviz(session, folder / "rviz.png")
        return session
    except BaseException:
        session.stop()
        raise


@pytest.fixture(scope="module")
def seen(tmp_path_factory, long_run) -> dict:
    """What is seen while the manual's commands are typed."""
    folder, shell = tmp_path_factory.mktemp("manual"), Shell()
    with virtual_screen("2400x900x24") if long_run else nullcontext():
        session = with_rviz(lambda: started(folder, long_run), folder / "launch.log")
        try:
            join(session.environment["ROS_MASTER_URI"])
            call("/gazebo/set_real_time_factor", SetRealTimeFactor, 1.0 if long_run else 8.0)
            arm = DraggedArm("panda", shell)
            seen = Observed(arm, TypedGripper(shell), Scene()).all_steps()
            seen["stops"] = stops(arm, shell)
            shell.end()
            if long_run:
                wait_for_rviz(session, folder / "rviz.png")
                seen["rviz"] = session.run("rosnode", "info", "/rviz").stdout
            session.check()
            seen["log"] = session.log.read_text(errors="replace")
            return seen
        finally:
            print(session.tail(80))
            shell.close()
            rospy.signal_shutdown("the test has ended")
            session.stop()


def test_the_fingers_open(seen):
    assert seen["open"]["gap"] == pytest.approx(0.08, abs=2e-3)


def test_the_stone_is_held_and_lifted(seen):
    lifted = seen["lifted"]
    assert lifted["gap"] == pytest.approx(STONE_WIDTH, abs=1e-3)
    assert lifted["force"] > 5.0  # 2.5 N from each side, and friction
    assert lifted["stone"][2] - seen["begin"]["stone"][2] > 0.1
    assert seen["above the red tray"]["stone"][1] > 0.15


def test_the_stone_stands_on_the_red_pad(seen):
    assert seen["let go"]["force"] == 0.0
    assert seen["placed"]["in_tray"] and seen["placed"]["distance"] < 0.02


def test_the_user_stop_disconnects_until_recovery(seen):
    assert all("success: True" in answers for answers in seen["stops"]["answers"].values())
    assert seen["stops"]["recovery"] == SUCCEEDED


@pytest.mark.long_form("rviz on a screen")
def test_rviz_shows_the_robot(seen):
    assert "/equilibrium_pose_marker/update" in seen["rviz"] and " * /tf [" in seen["rviz"]


def test_the_log_has_no_errors(seen):
    errors = re.findall(r".*(?:\[(?:ERROR|FATAL)\]|\[rospack\] Error|Traceback).*", seen["log"])
    assert [line for line in errors if ALLOWED not in line] == []


def test_the_launch_file_lists_its_arguments():
    line = "roslaunch franka_gazebo panda.launch --ros-args"
    result = subprocess.run(["bash", "-c", line], text=True, capture_output=True, timeout=60)
    assert result.returncode == 0, result.stderr
    for name in ("arm_id", "controller", "initial_joint_positions", "use_gripper", "world", "x", "yaw"):
        assert re.search(rf"^ +{name} \(default", result.stdout, re.M), f"{name} in {result.stdout}"
