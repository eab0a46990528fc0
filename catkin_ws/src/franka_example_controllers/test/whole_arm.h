// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_hw/franka_cartesian_command_interface.h>
#include <franka_hw/franka_model_interface.h>
#include <franka_hw/franka_state_interface.h>
#include <franka_hw/model_base.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>

#include <array>
#include <string>
#include <vector>

namespace franka_example_controllers {

/// A model with distinguishable results: numbers counted up from 100, 200, ...
class CountingModel : public franka_hw::ModelBase {
 public:
  using Q = std::array<double, 7>;
  using Pose = std::array<double, 16>;

  Pose pose(franka::Frame frame, const Q& q, const Pose&, const Pose&) const override {
    return count<16>(100.0 + 1000.0 * static_cast<int>(frame) + q[0]);
  }
  std::array<double, 42> bodyJacobian(franka::Frame, const Q&, const Pose&,
                                      const Pose&) const override {
    return count<42>(200.0);
  }
  std::array<double, 42> zeroJacobian(franka::Frame, const Q&, const Pose&,
                                      const Pose&) const override {
    return count<42>(300.0);
  }
  std::array<double, 49> mass(const Q&, const std::array<double, 9>&, double,
                              const std::array<double, 3>&) const override {
    return count<49>(400.0);
  }
  std::array<double, 7> coriolis(const Q&, const Q&, const std::array<double, 9>&, double,
                                 const std::array<double, 3>&) const override {
    return count<7>(500.0);
  }
  std::array<double, 7> gravity(const Q&, double, const std::array<double, 3>&,
                                const std::array<double, 3>& gravity_earth) const override {
    return count<7>(600.0 + gravity_earth[2]);
  }

 private:
  template <std::size_t size>
  static std::array<double, size> count(double from) {
    std::array<double, size> values;
    for (std::size_t i = 0; i < size; ++i) {
      values[i] = from + static_cast<double>(i);
    }
    return values;
  }
};

/// An arm `panda` with every interface of a Franka arm, which executes commands at once.
class WholeArm : public hardware_interface::RobotHW {
 public:
  WholeArm() {
    states_.registerHandle(franka_hw::FrankaStateHandle("panda_robot", state));
    models_.registerHandle(franka_hw::FrankaModelHandle("panda_model", model_, state));
    const franka_hw::FrankaStateHandle of_arm = states_.getHandle("panda_robot");
    poses_.registerHandle(franka_hw::FrankaCartesianPoseHandle(of_arm, pose, elbow));
    twists_.registerHandle(franka_hw::FrankaCartesianVelocityHandle(of_arm, twist, elbow));
    for (std::size_t i = 0; i < 7; ++i) {
      joint_names.push_back("panda_joint" + std::to_string(i + 1));
      const hardware_interface::JointStateHandle joint(joint_names[i], &state.q[i], &state.dq[i],
                                                       &state.tau_J[i]);
      efforts_.registerHandle(hardware_interface::JointHandle(joint, &effort[i]));
      positions_.registerHandle(hardware_interface::JointHandle(joint, &position[i]));
      velocities_.registerHandle(hardware_interface::JointHandle(joint, &velocity[i]));
    }
    registerInterface(&states_);
    registerInterface(&models_);
    registerInterface(&efforts_);
    registerInterface(&positions_);
    registerInterface(&velocities_);
    registerInterface(&poses_);
    registerInterface(&twists_);
    state.q_d = {{0.0, -0.7, 0.1, -2.3, 0.2, 1.5, 0.7}};
    state.q = state.q_d;
    state.O_T_EE_d = {{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0.3, 0.0, 0.5, 1}};
    state.O_T_EE = state.O_T_EE_d;
  }

  franka::RobotState state;
  std::array<double, 7> effort{}, position{}, velocity{};
  std::array<double, 16> pose{};
  std::array<double, 6> twist{};
  std::array<double, 2> elbow{};
  std::vector<std::string> joint_names;

 private:
  CountingModel model_;
  franka_hw::FrankaStateInterface states_;
  franka_hw::FrankaModelInterface models_;
  hardware_interface::EffortJointInterface efforts_;
  hardware_interface::PositionJointInterface positions_;
  hardware_interface::VelocityJointInterface velocities_;
  franka_hw::FrankaPoseCartesianInterface poses_;
  franka_hw::FrankaVelocityCartesianInterface twists_;
};

}  // namespace franka_example_controllers
