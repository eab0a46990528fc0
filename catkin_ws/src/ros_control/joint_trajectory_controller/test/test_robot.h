// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/command_effect_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>
#include <hardware_interface/robot_hw.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <list>
#include <string>

namespace closed_loop {

constexpr std::size_t kJoints = 3;

/// A URDF with a revolute, a prismatic and a continuous joint.
inline std::string urdf() {
  std::string text = "<robot name='test'><link name='l0'/>";
  const std::array<const char*, kJoints> types{"revolute", "prismatic", "continuous"};
  for (std::size_t i = 0; i < kJoints; ++i) {
    const std::string child = "l" + std::to_string(i + 1);
    text += "<link name='" + child + "'/><joint name='j" + std::to_string(i) + "' type='" +
            types[i] + "'><parent link='l" + std::to_string(i) + "'/><child link='" + child +
            "'/><axis xyz='0 0 1'/><limit lower='-9' upper='9' effort='9' velocity='9'/></joint>";
  }
  return text + "</robot>";
}

/// Joints of inertia 1 [kg m^2] that follow the interface of the running controller as exactly as
/// possible; `frozen_` ones do not move.
class TestRobot : public hardware_interface::RobotHW {
 public:
  TestRobot() {
    for (std::size_t i = 0; i < kJoints; ++i) {
      const hardware_interface::JointStateHandle state("j" + std::to_string(i), &position_[i],
                                                       &velocity_[i], &effort_[i]);
      typedef hardware_interface::JointHandle Handle;
      position_interface_.registerHandle(Handle(state, &position_command_[i]));
      velocity_interface_.registerHandle(Handle(state, &velocity_command_[i]));
      effort_interface_.registerHandle(Handle(state, &effort_command_[i]));
      posvel_interface_.registerHandle(hardware_interface::PosVelJointHandle(
          state, &position_command_[i], &velocity_command_[i]));
      posvelacc_interface_.registerHandle(hardware_interface::PosVelAccJointHandle(
          state, &position_command_[i], &velocity_command_[i], &acceleration_command_[i]));
      effect_interface_.registerHandle(hardware_interface::CommandEffectHandle(
          "j" + std::to_string(i), [this] { return stopped_ ? "The robot is stopped." : ""; }));
    }
    registerInterface(&position_interface_);
    registerInterface(&velocity_interface_);
    registerInterface(&effort_interface_);
    registerInterface(&posvel_interface_);
    registerInterface(&posvelacc_interface_);
    registerInterface(&effect_interface_);
  }

  void doSwitch(const std::list<hardware_interface::ControllerInfo>& start,
                const std::list<hardware_interface::ControllerInfo>& /*stop*/) override {
    for (const hardware_interface::ControllerInfo& controller : start) {
      const std::string& interface = controller.claimed_resources.at(0).hardware_interface;
      by_velocity_ = interface == "hardware_interface::VelocityJointInterface";
      by_effort_ = interface == "hardware_interface::EffortJointInterface";
    }
  }

  void move(double dt) {
    for (std::size_t i = 0; i < kJoints; ++i) {
      const double before = position_[i];
      if (frozen_) {
        velocity_[i] = 0.0;
      } else if (by_effort_) {
        velocity_[i] += effort_command_[i] * dt;
        position_[i] += velocity_[i] * dt;
      } else if (by_velocity_) {
        velocity_[i] = velocity_command_[i];
        position_[i] += velocity_[i] * dt;
      } else {
        position_[i] = position_command_[i];
        velocity_[i] = (position_[i] - before) / dt;
      }
      largest_step_ = std::max(largest_step_, std::abs(position_[i] - before));
    }
  }

  typedef std::array<double, kJoints> Values;
  Values position_{{0.1, -0.2, 0.3}};
  Values velocity_{};
  Values effort_{};
  Values position_command_{position_};
  Values velocity_command_{};
  Values acceleration_command_{};
  Values effort_command_{};
  bool frozen_{false};
  std::atomic<bool> stopped_{false};  ///< what commands of the joints say
  double largest_step_{0.0};          ///< of any joint within one cycle

 private:
  bool by_velocity_{false};
  bool by_effort_{false};
  hardware_interface::PositionJointInterface position_interface_;
  hardware_interface::VelocityJointInterface velocity_interface_;
  hardware_interface::EffortJointInterface effort_interface_;
  hardware_interface::PosVelJointInterface posvel_interface_;
  hardware_interface::PosVelAccJointInterface posvelacc_interface_;
  hardware_interface::CommandEffectInterface effect_interface_;
};

}  // namespace closed_loop
