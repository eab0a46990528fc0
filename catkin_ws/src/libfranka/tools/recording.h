// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>

namespace franka_info {

/// Options of a recording.
struct RecordingOptions {
  std::string address, file;
  double seconds{30.0};
  bool moves{false};  ///< swings every joint about its present position; otherwise only listens
};

/// Writes states of a robot as CSV, every 5 ms of the robot's time: time; q, dq, tau_J, tau_J_d,
/// tau_ext_hat_filtered, dq_d, ddq_d, gravity (of the robot's own model) of joints 1 to 7; and the
/// torques of an unknown load in the desired motion, 7 for each of: a mass of 1 kg at the flange, a
/// moment of 1 kg m along x, y, z of the flange. fit_robot reads it.
/// @throws franka::Exception, or std::runtime_error if the file cannot be written
void record(const RecordingOptions& options);

}  // namespace franka_info
