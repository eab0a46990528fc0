#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Checks the four arms of several_arms.launch and prints a report as one line of JSON."""

import json
import sys
import time

import rosgraph
import rospy
import rospy_connections
import tf2_ros
from controller_manager_msgs.srv import (
    ListControllers,
    LoadController,
    SwitchController,
    SwitchControllerRequest,
)
from franka_msgs.msg import FrankaState
from franka_sim_mujoco.srv import SpawnRobot, SpawnRobotRequest, Step
from rosgraph_msgs.msg import Clock
from sensor_msgs.msg import JointState

CONTROLLER = "cartesian_impedance_example_controller"
ARMS = [f"arm_{i}" for i in range(4)]
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


def wait_until(condition, what):
    end = time.monotonic() + DEADLINE
    while not condition():
        assert time.monotonic() < end, f"{what} within {DEADLINE:g} s"
        time.sleep(0.1)


def service(name, kind):
    rospy.wait_for_service(name, DEADLINE)
    return rospy.ServiceProxy(name, kind)


def running(arm):
    listed = service(f"/{arm}/controller_manager/list_controllers", ListControllers)().controller
    return [one.name for one in listed if one.state == "running"]


def clock_rate():
    """Lower bound of the messages of /clock per wall second."""
    count = []
    begin = time.monotonic()
    subscriber = rospy.Subscriber("/clock", Clock, count.append)
    wait_until(lambda: time.monotonic() > begin + 2.0, "two seconds")
    subscriber.unregister()
    return len(count) / (time.monotonic() - begin)


def pace(step):
    """Lower bound of simulated seconds per wall second: the calls count as wall time."""
    begin = time.monotonic()
    first = step(0).time
    time.sleep(0.5)
    return (step(0).time - first).to_sec() / (time.monotonic() - begin)


def spawn_late():
    """Spawns a robot whose parameters announce a controller, which is never started."""
    rospy.set_param("/late/awaited_controllers", "late_controller")
    rospy.set_param(
        "/late/late_controller", {"type": "joint_state_controller/JointStateController", "publish_rate": 30}
    )
    order = SpawnRobotRequest(name="late", urdf=LATE, robot_namespace="/late")
    order.pose.orientation.w = 1
    answer = service("/gazebo/spawn_robot", SpawnRobot)(order)
    assert answer.success, answer.error


def start_late():
    manager = "/late/controller_manager/"
    assert service(manager + "load_controller", LoadController)("late_controller").ok
    request = SwitchControllerRequest(start_controllers=["late_controller"], strictness=2)
    assert service(manager + "switch_controller", SwitchController)(request).ok


def names_of_joints(arm):
    message = rospy.wait_for_message(f"/{arm}/joint_states", JointState, DEADLINE)
    assert len(message.name) == len(message.position) == len(message.velocity) == len(message.effort)
    return message.name


def stamps_of_joint_states(arm, count):
    stamps = []
    subscriber = rospy.Subscriber(
        f"/{arm}/joint_states", JointState, lambda message: stamps.append(message.header.stamp.to_nsec())
    )
    wait_until(lambda: len(stamps) > count, "joint states")
    subscriber.unregister()
    return stamps


def place_by_transforms(buffer, arm):
    """Position of the end effector of an arm without a hand, from tf."""
    names = (f"{arm}_link0", f"{arm}_link8", rospy.Time(0))
    wait_until(lambda: buffer.can_transform(*names), f"a transform of {arm}")
    place = buffer.lookup_transform(*names).transform.translation
    return [place.x, place.y, place.z]


def place_by_state(arm):
    state = rospy.wait_for_message(f"/{arm}/franka_state_controller/franka_states", FrankaState, DEADLINE)
    return list(state.O_T_EE[12:15])


def main():
    rospy_connections.init_node("several_arms_client")
    wait_until(lambda: all(CONTROLLER in running(arm) for arm in ARMS), "controllers of all arms")
    step = service("/gazebo/step", Step)
    system = rosgraph.Master(rospy.get_name()).getSystemState()
    report = {
        "running": {arm: running(arm) for arm in ARMS},
        "nodes": sorted({node for part in system for _, nodes in part for node in nodes}),
        "follow_clock": dict(system[1])["/clock"],
        "clock_rate": clock_rate(),
        "joints": {arm: names_of_joints(arm) for arm in ARMS},
        "stamps": stamps_of_joint_states("arm_1", 30),
    }
    buffer = tf2_ros.Buffer()
    tf2_ros.TransformListener(buffer)
    report["places"] = {arm: [place_by_transforms(buffer, arm), place_by_state(arm)] for arm in ARMS[1:]}
    spawn_late()
    report["pace_while_one_starts"] = pace(step)
    start_late()
    wait_until(lambda: pace(step) > 1.5, "no faster than real time")
    print(json.dumps(report))


if __name__ == "__main__":
    sys.exit(main())
