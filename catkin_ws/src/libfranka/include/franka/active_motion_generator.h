// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control.h>

#include <memory>

/// @file
/// Motion generators driven by the program.

namespace franka {

/// A motion that is commanded by joint or Cartesian values; started by
/// Robot::startJointPositionControl and similar functions. Torques must be given if and only if the
/// motion was started with the external controller.
/// @tparam MotionGeneratorType JointPositions, JointVelocities, CartesianPose or
/// CartesianVelocities.
template <typename MotionGeneratorType>
class ActiveMotionGenerator : public ActiveControl {
 public:
  using ActiveControl::writeOnce;
  void writeOnce(const MotionGeneratorType& motion_generator_input,
                 const std::optional<const Torques>& control_input) override;
  void writeOnce(const MotionGeneratorType& motion_generator_input) override;

 private:
  friend class Robot;
  explicit ActiveMotionGenerator(std::unique_ptr<Motion> motion);
};

extern template class ActiveMotionGenerator<JointPositions>;
extern template class ActiveMotionGenerator<JointVelocities>;
extern template class ActiveMotionGenerator<CartesianPose>;
extern template class ActiveMotionGenerator<CartesianVelocities>;

}  // namespace franka
