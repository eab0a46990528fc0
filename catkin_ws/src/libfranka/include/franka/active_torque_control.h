// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/active_control.h>

#include <memory>

/// @file
/// Torque control driven by the program.

namespace franka {

/// A motion that is commanded by torques alone; started by Robot::startTorqueControl.
class ActiveTorqueControl : public ActiveControl {
 public:
  using ActiveControl::writeOnce;
  void writeOnce(const Torques& control_input) override;

 private:
  friend class Robot;
  explicit ActiveTorqueControl(std::unique_ptr<Motion> motion);
};

}  // namespace franka
