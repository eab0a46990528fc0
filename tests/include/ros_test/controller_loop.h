// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_manager/controller_manager.h>
#include <gtest/gtest.h>
#include <ros/ros.h>
#include <ros_test/eventually.h>

#include <chrono>
#include <future>
#include <string>
#include <vector>

namespace ros_test {

/// Base of tests of a controller manager with a simulated robot. Time advances only by the test's
/// steps.
/// @tparam Robot a hardware_interface::RobotHW with `void move(double dt)`, called after each
/// update
template <class Robot>
class ControllerLoop {
 protected:
  /// @param name_space of the controllers
  explicit ControllerLoop(const std::string& name_space)
      : nh_(name_space), manager_(&robot_, nh_) {}

  void step() {
    time_ += period_;
    manager_.update(time_, period_);
    robot_.move(period_.toSec());
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      step();
    }
  }

  /// Steps until a condition holds, while callbacks get processor time.
  /// @param cycles between two checks; 0 if a message in transit decides, which the robot must not
  /// overtake
  template <class Condition>
  bool stepsUntil(Condition condition, int cycles = 1) {
    const auto after_cycles = [&] { return condition() || (steps(cycles), false); };
    return eventually(after_cycles, std::chrono::microseconds(20));
  }

  template <class Condition>
  void until(Condition condition, const std::string& what, int cycles = 1) {
    ASSERT_TRUE(stepsUntil(condition, cycles)) << "timed out waiting for " << what;
  }

  /// @returns whether the manager has switched
  bool doSwitch(const std::vector<std::string>& start, const std::vector<std::string>& stop) {
    std::future<bool> answer =
        std::async(std::launch::async, [&] { return manager_.switchController(start, stop, 2); });
    until([&] { return answer.wait_for(std::chrono::seconds(0)) == std::future_status::ready; },
          "the switch");
    return answer.get();
  }

  ros::NodeHandle nh_;
  Robot robot_;
  controller_manager::ControllerManager manager_;
  ros::Time time_{100.0};
  const ros::Duration period_{0.001};
};

}  // namespace ros_test
