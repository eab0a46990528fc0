# Copyright (c) 2026 the franka_ros for Debian authors
# SPDX-License-Identifier: Apache-2.0
"""The part of ROS 2's package index that xacro uses, for catkin packages."""
