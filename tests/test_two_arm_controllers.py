# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The two-arm examples by their launch files, each on two simulated robots."""

import numpy as np
import pytest
import rospy
from franka_msgs.msg import FrankaState
from geometry_msgs.msg import PoseStamped
from pyfranka.remote import Remote
from ros_client import launched
from visualization_msgs.msg import InteractiveMarkerFeedback
from waiting import wait_for

LEFT_FROM_RIGHT = np.array([0.0, 1.0, 0.0])  # [m] base of the left arm in the right one's: dual_panda_example
DRAG, STEPS, DRAG_PERIOD = np.array([0.03, 0.0, 0.04]), 20, 0.1  # [m], [s]
LIMIT = 60.0  # wall seconds for any wait
LEADER = "127.0.7.13"


@pytest.fixture(
    params=[
        "panda",
        pytest.param("fr3", marks=pytest.mark.long_form("FR3s follow the same launch files")),
    ]
)
def robot(request):
    return request.param


def launched_pair(launch, robot, *arguments, log):
    launch = ["franka_example_controllers", launch, "sim:=true", "rviz:=false", "rqt:=false", *arguments]
    # Under friction, soft arms rest millimeters off their target.
    return launched(*launch, f"robot_type:={robot}", "realism:=ideal", log=log)


class Arms:
    """Stores the last states of two arms, and every pair of states with the same time."""

    def __init__(self, namespace, names):
        self.last, self.pairs, self.names = {}, [], names
        for name in names:
            topic = f"{namespace}/{name}_state_controller/franka_states"
            rospy.Subscriber(topic, FrankaState, self._take, callback_args=name)

    def _take(self, state, name):
        self.last[name] = state
        states = [self.last.get(name) for name in self.names]
        if all(states) and states[0].header.stamp == states[1].header.stamp:
            self.pairs.append(states)

    def moving(self):
        modes = [self.last[name].robot_mode for name in self.names if name in self.last]
        return modes == [FrankaState.ROBOT_MODE_MOVE] * 2

    def wait(self, seconds):
        """Waits for a duration of the robots' time, because a busy machine may be slower."""
        first = self.names[0]
        end = self.last[first].time + seconds
        wait_for(lambda: self.last[first].time >= end, f"The end of {seconds} s", LIMIT)

    def speed(self):
        return max(abs(v) for name in self.names for v in self.last[name].dq)


def relative(states):
    """Pose of the left end effector in the right one's."""
    right, left = (np.array(state.O_T_EE).reshape(4, 4).T for state in states)
    left = left.copy()
    left[:3, 3] += LEFT_FROM_RIGHT
    return np.linalg.inv(right) @ left


@pytest.mark.own_process
def test_two_arms_hold_their_relative_pose_while_the_marker_is_dragged(robot, tmp_path):
    addresses = f"robot_ips:={{{robot}_1/robot_ip: 127.0.7.11, {robot}_2/robot_ip: 127.0.7.12}}"
    launch = "dual_arm_cartesian_impedance_example_controller.launch"
    with launched_pair(launch, robot, addresses, log=tmp_path / "launch.log"):
        namespace, right, left = f"/{robot}_dual", f"{robot}_1", f"{robot}_2"
        frames = []
        controller = namespace + "/dual_arm_cartesian_impedance_example_controller"
        rospy.Subscriber(controller + "/centering_frame", PoseStamped, frames.append)
        hand = rospy.Publisher(
            namespace + "/target_pose_marker/feedback", InteractiveMarkerFeedback, queue_size=10
        )
        arms = Arms(namespace, [right, left])
        wait_for(
            lambda: arms.moving() and frames and hand.get_num_connections(), "The controller's start", LIMIT
        )
        wait_for(lambda: arms.speed() < 1e-3, "Rest", LIMIT)
        begin, first = frames[-1].pose, relative([arms.last[name] for name in arms.names])
        start = np.array([begin.position.x, begin.position.y, begin.position.z])
        arms.pairs.clear()
        for step in range(1, STEPS + 1):
            feedback = InteractiveMarkerFeedback(client_id="test", marker_name="target_pose")
            feedback.header.frame_id = left + "_link0"
            feedback.event_type = InteractiveMarkerFeedback.POSE_UPDATE
            x, y, z = start + DRAG * step / STEPS
            feedback.pose.position.x, feedback.pose.position.y, feedback.pose.position.z = x, y, z
            feedback.pose.orientation = begin.orientation
            hand.publish(feedback)
            arms.wait(DRAG_PERIOD)

        def offset():
            at = frames[-1].pose.position
            return np.array([at.x, at.y, at.z]) - start

        wait_for(lambda: np.linalg.norm(offset() - DRAG) < 5e-3, "The motion to the marker", LIMIT)
        wait_for(lambda: arms.speed() < 1e-3, "Rest at the marker", LIMIT)
        changes = [relative(pair) - first for pair in list(arms.pairs)]
        assert arms.moving()
    assert len(changes) > 20
    assert max(np.linalg.norm(change[:3, 3]) for change in changes) < 1e-3  # [m]


@pytest.mark.own_process
@pytest.mark.long_form("its stiff law tolerates no late torques, which a busy machine has")
def test_the_follower_follows_a_pushed_leader(robot, tmp_path):
    """Patient robots wait for the loop, because the follower's stiff law tolerates no constant torques."""
    addresses = [f"leader_ip:={LEADER}", "follower_ip:=127.0.7.14"]
    launch = "teleop_joint_pd_example_controller.launch"
    with launched_pair(launch, robot, *addresses, log=tmp_path / "launch.log"):
        arms = Arms(f"/{robot}_teleop", ["leader", "follower"])
        wait_for(arms.moving, "The controller's start", LIMIT)

        def error():
            leader, follower = (np.array(arms.last[name].q) for name in arms.names)
            return float(np.abs(leader - follower).max())

        wait_for(lambda: error() < 0.01 and arms.speed() < 1e-2, "Alignment", LIMIT)
        begin = [np.array(arms.last[name].q) for name in arms.names]

        def moved():
            return [np.abs(np.array(arms.last[name].q) - q).max() for name, q in zip(arms.names, begin)]

        Remote(LEADER).push("leader_link7", (0, 12, 0), ticks=300)
        wait_for(lambda: moved()[0] > 0.05, "A motion of the pushed leader", LIMIT)  # [rad]
        wait_for(lambda: moved()[1] > 0.05, "A motion of the follower", LIMIT)
        wait_for(lambda: error() < 1e-3 and arms.speed() < 0.05, "The follower's arrival", LIMIT)
        assert arms.moving()
