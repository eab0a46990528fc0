// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <combined_robot_hw/combined_robot_hw.h>

#include <memory>
#include <string>
#include <vector>

#include "test_robot.h"

namespace combined_robot_hw_test {

/// Combines robots created by a test.
class Combined : public combined_robot_hw::CombinedRobotHW {
 public:
  using CombinedRobotHW::filterControllerList;
  Robot& add(const std::vector<std::string>& joints) {
    const auto robot = std::make_shared<Robot>(joints);
    robot_hw_list_.push_back(robot);
    registerInterfaceManager(robot.get());
    return *robot;
  }
  hardware_interface::RobotHWSharedPtr member(std::size_t i) { return robot_hw_list_[i]; }
};

}  // namespace combined_robot_hw_test
