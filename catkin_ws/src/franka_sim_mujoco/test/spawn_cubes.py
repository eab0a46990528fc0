#!/usr/bin/env python3
# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""Spawns a table and a pile of cubes on it, as many scripts for Gazebo do: layers of so many by so many."""

import sys

import rospy
from gazebo_msgs.srv import GetModelState, SpawnModel
from geometry_msgs.msg import Point, Pose, Quaternion

TOP = 0.4  # of the table [m]
SIDE = 0.04  # of a cube [m]
GAP = 0.002  # between neighbors, and below each at first [m]

TABLE = """<?xml version="1.0"?>
<sdf version="1.4">
  <model name="table">
    <static>true</static>
    <link name="link">
      <collision name="collision">
        <pose>0 0 0.2 0 0 0</pose>
        <geometry><box><size>1.0 1.0 0.4</size></box></geometry>
      </collision>
      <visual name="visual">
        <pose>0 0 0.2 0 0 0</pose>
        <geometry><box><size>1.0 1.0 0.4</size></box></geometry>
      </visual>
    </link>
  </model>
</sdf>"""

CUBE = """<?xml version="1.0"?>
<sdf version="1.4">
  <model name="cube">
    <link name="link">
      <inertial>
        <mass>0.05</mass>
        <inertia><ixx>1.3e-5</ixx><iyy>1.3e-5</iyy><izz>1.3e-5</izz></inertia>
      </inertial>
      <collision name="collision">
        <geometry><box><size>0.04 0.04 0.04</size></box></geometry>
      </collision>
      <visual name="visual">
        <geometry><box><size>0.04 0.04 0.04</size></box></geometry>
        <material>
          <script>
            <uri>file://media/materials/scripts/gazebo.material</uri>
            <name>Gazebo/Blue</name>
          </script>
        </material>
      </visual>
    </link>
  </model>
</sdf>"""


if __name__ == "__main__":
    rospy.init_node("spawn_cubes")
    rospy.wait_for_service("/gazebo/spawn_sdf_model")
    rospy.wait_for_service("/gazebo/get_model_state")
    spawn_model = rospy.ServiceProxy("/gazebo/spawn_sdf_model", SpawnModel)
    get_model_state = rospy.ServiceProxy("/gazebo/get_model_state", GetModelState)
    orientation = Quaternion(0, 0, 0, 1)

    spawn_model("table", TABLE, "", Pose(Point(0, 0, 0), orientation), "world")
    number = 0
    for layer, count in enumerate(int(word) for word in rospy.myargv(sys.argv)[1:]):
        for i in range(count * count):
            x = (SIDE + GAP) * (i % count - (count - 1) / 2)
            y = (SIDE + GAP) * (i // count - (count - 1) / 2)
            z = TOP + SIDE / 2 + layer * SIDE + GAP * (layer + 1)
            name = f"cube_{number}"
            spawn_model(name, CUBE, "", Pose(Point(x, y, z), orientation), "world")
            if not get_model_state(name, "world").success:
                sys.exit(f"{name} was not spawned")
            number += 1
    print(f"{number} cubes were spawned")
