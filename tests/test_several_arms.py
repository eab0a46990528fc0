# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Two arms in one simulation that is faster than real time: they start, and add no processes."""

import time
from pathlib import Path

import pytest
import rosgraph
import rospy
import tf2_ros
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.srv import SpawnRobot, SpawnRobotRequest, Step
from ros_client import Controllers, call, latest, launched
from sensor_msgs.msg import JointState
from waiting import wait_for

HERE = Path(__file__).resolve().parent

CONTROLLER = "cartesian_impedance_example_controller"
ARMS = [f"arm_{i}" for i in range(2)]
DEADLINE = 120.0  # wall seconds, for a machine with much else to do
# A robot of one joint, whose controller no launch file starts.
LATE = """
<robot name="late">
  <link name="world"/>
  <link name="late_cart">
    <inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  </link>
  <joint name="late_drive" type="prismatic">
    <parent link="world"/><child link="late_cart"/><origin xyz="-3 0 1"/><axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" effort="100" velocity="1"/>
  </joint>
  <transmission name="late_transmission">
    <type>transmission_interface/SimpleTransmission</type>
    <joint name="late_drive">
      <hardwareInterface>hardware_interface/EffortJointInterface</hardwareInterface>
    </joint>
    <actuator name="late_motor"><mechanicalReduction>1</mechanicalReduction></actuator>
  </transmission>
  <gazebo><plugin name="control" filename="libgazebo_ros_control.so"/></gazebo>
</robot>
"""


pytestmark = pytest.mark.own_process


@pytest.fixture(scope="module", autouse=True)
def simulation(tmp_path_factory):
    log = tmp_path_factory.mktemp("several_arms") / "launch.log"
    with launched(str(HERE / "data" / "several_arms.launch"), log=log):
        for arm in ARMS:
            wait_for(lambda arm=arm: CONTROLLER in running(arm), f"The controller of {arm}", DEADLINE)
        yield


def running(arm):
    return Controllers(f"/{arm}").running()


def system():
    """Publishers, subscribers and services, each with their nodes."""
    return rosgraph.Master(rospy.get_name()).getSystemState()


def test_an_arm_adds_no_processes_but_its_spawners():
    spawners = ("_model_spawner", "_controller_spawner", "_gripper_spawner")
    nodes = {node for part in system() for _, nodes in part for node in nodes}
    own = [node for node in nodes if node.startswith("/arm_")]
    assert own
    assert all(node.endswith(spawners) for node in own), own


def test_joint_states_hold_arm_and_hand_in_kinematic_order():
    for arm in ARMS:
        message = latest(f"/{arm}/joint_states", JointState, DEADLINE)
        fingers = [f"{arm}_finger_joint{i}" for i in (1, 2)] if arm == "arm_0" else []
        assert message.name == [f"{arm}_joint{i}" for i in range(1, 8)] + fingers
        assert len(message.name) == len(message.position) == len(message.velocity) == len(message.effort)


def test_late_subscribers_get_the_transforms_of_every_arm():
    buffer = tf2_ros.Buffer()
    listener = tf2_ros.TransformListener(buffer)
    for arm in ARMS[1:]:  # without a hand
        names = (f"{arm}_link0", f"{arm}_link8", rospy.Time(0))
        wait_for(lambda names=names: buffer.can_transform(*names), f"A transform of {arm}", DEADLINE)
        place = buffer.lookup_transform(*names).transform.translation
        state = latest(f"/{arm}/franka_state_controller/franka_states", FrankaState, DEADLINE)
        assert [place.x, place.y, place.z] == pytest.approx(state.O_T_EE[12:15], abs=0.01), arm
    listener.unregister()


@pytest.mark.realtime("the pace of a simulation while a robot starts, and after it")
def test_time_is_real_time_while_a_robot_starts():
    """A robot whose parameters announce a controller, which is started later."""

    def pace():
        """Lower bound of simulated seconds per wall second: the calls count as wall time."""
        step = rospy.ServiceProxy("/gazebo/step", Step)
        begin = time.monotonic()
        first = step(0).time
        time.sleep(0.5)
        return (step(0).time - first).to_sec() / (time.monotonic() - begin)

    rospy.set_param("/late/awaited_controllers", "late_controller")
    rospy.set_param(
        "/late/late_controller", {"type": "joint_state_controller/JointStateController", "publish_rate": 30}
    )
    order = SpawnRobotRequest(name="late", urdf=LATE, robot_namespace="/late")
    order.pose.orientation.w = 1
    answer = call("/gazebo/spawn_robot", SpawnRobot, order)
    assert answer.success, answer.error
    # The host catches up at most 50 ms of delay, here within half a second.
    assert pace() <= 1.11
    late = Controllers("/late")
    late.load("late_controller")
    late.start("late_controller")
    wait_for(lambda: pace() > 1.5, "A pace faster than real time", DEADLINE)
