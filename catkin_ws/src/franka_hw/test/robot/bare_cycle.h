// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include "support.h"

namespace franka_hw_test {

/// A FrankaHW whose control cycle is called directly, without waiting for a robot: only the
/// computation of a millisecond is left. A torque controller runs.
class BareCycle : public franka_hw::FrankaHW {
 public:
  BareCycle() : manager_(initialized(), arm_.nh) {
    loader_ = Loop::makeLoader();
    manager_.registerControllerLoader(loader_);
    const std::string name = Loop::describe(arm_.nh, arm_.arm_id, "JT");
    if (!manager_.loadController(name)) {
      throw std::runtime_error("no controller");
    }
    // The switch finishes only while cycles run.
    std::atomic_bool done{false};
    std::thread requests([&] {
      manager_.switchController({name}, {}, 2, false, 60.0);
      done = true;
    });
    eventually([&] {
      manager_.update(time_, ros::Duration(0.001));
      return done.load();
    });
    requests.join();
    working_ = [this](const franka::RobotState&, franka::Duration step) {
      time_ += ros::Duration(step.toSec());
      const ros::Duration period(step.toSec());
      manager_.update(time_, period);
      checkJointLimits();
      enforceLimits(period);
      return true;
    };
    empty_ = [](const franka::RobotState&, franka::Duration) { return true; };
  }

  bool running() const { return controllerActive(); }
  /// Read, update of one controller, joint warnings, limits, write, NaN guard.
  double cycle() {
    return controlCallback(effort_joint_command_libfranka_, std::cref(working_), state_, kStep)
        .tau_J[0];
  }
  /// The same without controllers and limits.
  double emptyCycle() {
    return controlCallback(effort_joint_command_libfranka_, std::cref(empty_), state_, kStep)
        .tau_J[0];
  }

 private:
  franka_hw::FrankaHW* initialized() {
    if (!init(arm_.nh, arm_.robot_nh)) {
      throw std::runtime_error("no robot");
    }
    state_ = robot_state_libfranka_;
    return this;
  }

  const franka::Duration kStep{1};
  FakeArm arm_{"fr3"};
  franka::RobotState state_;
  ros::Time time_{1000.0};
  controller_manager::ControllerLoaderInterfaceSharedPtr loader_;
  controller_manager::ControllerManager manager_;
  Callback working_, empty_;
};

}  // namespace franka_hw_test
