// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <gtest/gtest.h>
#include <ros/node_handle.h>

#include <string>
#include <vector>

namespace ros_test {

using Names = std::vector<std::string>;

/// Names of an arm's joints, or of the first of them.
inline Names jointNames(const std::string& arm_id, int count = 7) {
  Names names;
  for (int i = 1; i <= count; ++i) {
    names.push_back(arm_id + "_joint" + std::to_string(i));
  }
  return names;
}

/// Base of the tests of an arm's controller, which is used without a controller manager. Each test
/// has a namespace of its own.
class ArmControllerTest : public testing::Test {
 protected:
  ArmControllerTest() : node("~" + nextName()) {}

  void setParameters(const std::string& arm_id) {
    node.setParam("arm_id", arm_id);
    node.setParam("joint_names", jointNames(arm_id));
  }

  ros::NodeHandle node;  ///< of the controller

 private:
  static std::string nextName() {
    static int number = 0;
    return "controller_" + std::to_string(++number);
  }
};

}  // namespace ros_test
