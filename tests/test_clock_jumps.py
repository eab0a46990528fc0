# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The nodes of the launch files continue when /clock, which the test publishes, jumps back and forward."""

import threading
from collections import Counter
from pathlib import Path
from xml.etree import ElementTree

import pytest
import rosgraph
import rospy
from actionlib_msgs.msg import GoalStatus
from franka_gripper.msg import StopAction, StopGoal
from franka_msgs.msg import ErrorRecoveryAction, ErrorRecoveryGoal
from pyfranka.franka_sim import FrankaSim
from pyfranka.sim import KINDS
from ros_client import Action, launched
from rosgraph_msgs.msg import Clock
from waiting import holds

SOURCE = Path(__file__).resolve().parent.parent / "catkin_ws" / "src"
ADDRESSES = [f"127.0.75.{i}" for i in range(1, 7)]
EXAMPLES = "$(find franka_example_controllers)/launch"
# Six robots: one under franka_control_node, two under the combined node, one that is only displayed, and two
# whose hands are teleoperated.
LAUNCH = f"""<launch>
  <param name="/use_sim_time" value="true"/>
  <arg name="sim" value="true"/><arg name="rviz" value="false"/><arg name="rqt" value="false"/>
  <arg name="robot_ip" value="{ADDRESSES[0]}"/>
  <arg name="robot_ips" value="{{panda_1/robot_ip: {ADDRESSES[1]}, panda_2/robot_ip: {ADDRESSES[2]}}}"/>
  <include file="{EXAMPLES}/cartesian_impedance_example_controller.launch" pass_all_args="true"/>
  <include file="{EXAMPLES}/dual_arm_cartesian_impedance_example_controller.launch" pass_all_args="true"/>
  <group ns="displayed">
    <include file="$(find franka_visualization)/launch/franka_visualization.launch">
      <arg name="robot_ip" value="{ADDRESSES[3]}"/><arg name="robot" value="fr3"/>
      <arg name="rviz" value="false"/>
    </include>
  </group>
  <include file="{EXAMPLES}/teleop_gripper.launch">
    <arg name="leader_ip" value="{ADDRESSES[4]}"/><arg name="follower_ip" value="{ADDRESSES[5]}"/>
    <arg name="connect_timeout" value="60"/><arg name="gripper_homed" value="true"/>
  </include>
</launch>"""
# Programs of launch files that are not part of it.
OTHERS = {
    "franka_sim_mujoco_node": "publishes the clock itself",
    "spawn_robot": "uses wall time, because that simulation may be paused",
    "franka_desk": "is not a node",
    "parameter_sliders": "uses wall time, and needs a screen",
    "move_to_start.py": "ends after its motion",
}
# Topics of the nodes that start last.
SLOWEST = {
    "/cartesian_impedance_example_controller/equilibrium_pose",
    "/panda_dual/dual_arm_cartesian_impedance_example_controller/centering_frame_target_pose",
    "/displayed/joint_states",
    "/panda_teleop/panda_2/franka_gripper/joint_states",
}
STEP = 0.01  # [s] of the clock
ENOUGH = 5  # messages that show that a topic is alive, more than one queue holds
LIMIT = 40.0  # simulated time for them [s]
JUMPS = (-900.0, 5000.0)  # [s] nearly to 0, and beyond all that was

pytestmark = pytest.mark.own_process


class SimulatedClock:
    """Publishes /clock, step by step, in a thread."""

    def __init__(self):
        self.time, self.passed = 1000.0, 0.0  # [s] `passed` is without the jumps
        self._publisher = rospy.Publisher("/clock", Clock, queue_size=1)
        self._ended = threading.Event()
        self._thread = threading.Thread(target=self._run, daemon=True)
        self._thread.start()

    def jump(self, seconds: float) -> None:
        self.time += seconds

    def end(self) -> None:
        self._ended.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._ended.wait(STEP):
            self.time += STEP
            self.passed += STEP
            self._publisher.publish(Clock(rospy.Time.from_sec(self.time)))


class Topics:
    """Counts the messages on all topics of the launch."""

    def __init__(self):
        self._master = rosgraph.Master(rospy.get_name())
        self._subscribers = {}
        self.counts = Counter()

    def subscribe(self) -> None:
        """To topics that are new."""
        for topic, publishers in self._master.getSystemState()[0]:
            other = topic in ("/clock", "/rosout", "/rosout_agg") or rospy.get_name() in publishers
            if not other and topic not in self._subscribers:
                self._subscribers[topic] = rospy.Subscriber(topic, rospy.AnyMsg, self._count, topic)

    def alive(self) -> set[str]:
        return {topic for topic, count in self.counts.items() if count >= ENOUGH}

    def nodes(self) -> set[str]:
        kinds = self._master.getSystemState()
        return {node for kind in kinds for _, nodes in kind for node in nodes}

    def _count(self, _message, topic: str) -> None:
        self.counts[topic] += 1


def programs() -> set[str]:
    """Types of all nodes of launch files that are of this workspace."""
    packages = {path.parent.name for path in SOURCE.glob("**/package.xml")}
    files = [ElementTree.parse(path) for path in SOURCE.glob("*/launch/**/*.launch")]
    nodes = [node for file in files for node in file.iter("node")]
    return {node.get("type") for node in nodes if node.get("pkg") in packages}


def commands(session) -> str:
    """Command lines of a launch's processes."""
    files = (Path(f"/proc/{pid}/cmdline") for pid in session.processes())
    return "\n".join(file.read_bytes().replace(b"\0", b" ").decode() for file in files if file.exists())


def streams_of(topics, clock) -> set[str]:
    """The topics with messages, once the slowest nodes have started and no topic was added for a while."""
    streams, since = set(), clock.passed

    def complete():
        nonlocal streams, since
        topics.subscribe()
        if streams != topics.alive():
            streams, since = topics.alive(), clock.passed
        return streams >= SLOWEST and clock.passed - since > 5.0

    assert holds(complete, 240.0, 0.1), topics.counts
    return streams


def check_actions(actions, when: str) -> None:
    for action, goal in actions:
        assert action.run(goal)[0] == GoalStatus.SUCCEEDED, f"{type(goal).__name__} {when}"


def test_streams_nodes_and_actions_continue_after_jumps(tmp_path):
    (tmp_path / "all.launch").write_text(LAUNCH)
    robots = [KINDS["fr3"](address=address, base=(0, 2 * i, 0)) for i, address in enumerate(ADDRESSES[3:])]
    with (
        FrankaSim(*robots, pace="realtime"),
        launched(str(tmp_path / "all.launch"), log=tmp_path / "log.txt") as session,
    ):
        clock, topics = SimulatedClock(), Topics()
        actions = [(Action("/franka_gripper/stop", StopAction), StopGoal())] + [
            (Action(name, ErrorRecoveryAction), ErrorRecoveryGoal())
            for name in ("/franka_control/error_recovery", "/panda_dual/error_recovery")
        ]
        check_actions(actions, "before the jumps")
        streams, nodes = streams_of(topics, clock), topics.nodes()
        running = commands(session)
        assert {kind for kind in programs() if f"/{kind}" not in running} == set(OTHERS)
        for jump in JUMPS:
            clock.jump(jump)
            topics.counts.clear()
            end = clock.passed + LIMIT
            holds(lambda end=end: streams <= topics.alive() or clock.passed > end, 2 * LIMIT)
            assert streams <= topics.alive(), f"silent after {jump} s: {sorted(streams - topics.alive())}"
            check_actions(actions, f"after {jump} s")
            assert nodes <= topics.nodes()
        clock.end()
