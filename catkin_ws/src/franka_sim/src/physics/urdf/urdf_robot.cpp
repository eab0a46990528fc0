// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/urdf/urdf_robot.h"

namespace franka_sim::physics {

int UrdfRobot::link(const std::string& link_name) const noexcept {
  for (std::size_t i = 0; i < links.size(); ++i) {
    if (links[i].name == link_name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

int UrdfRobot::joint(const std::string& joint_name) const noexcept {
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (joints[i].name == joint_name) {
      return static_cast<int>(i);
    }
  }
  return -1;
}

}  // namespace franka_sim::physics
