// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>

#include <array>

namespace franka_sim {

/// How the torque of one tick continues the torque of the previous tick.
enum class LawSwitch {
  kNone,
  kBlend,     ///< the law changes, but the torque has no step
  kFromZero,  ///< the next law starts at zero: its torque acts at once
};

/// The impedance of a guided arm along the axes that are not free.
struct GuidingTask {
  std::array<bool, 6> free{{true, true, true, true, true, true}};  ///< x, y, z, R, P, Y of K
  bool elbow_free{true};
  std::array<double, 16> O_T_EE{};  ///< the pose in which guiding began
  std::array<double, 7> q{};
};

/// The task of the control laws in a tick.
struct ControlTask {
  franka_core::RobotMode mode{franka_core::RobotMode::kIdle};
  franka_core::ControllerMode controller{franka_core::ControllerMode::kOther};  ///< in Move
  std::array<double, 7> tau{};  ///< torques of an external controller [Nm]
  GuidingTask guiding;
  LawSwitch law_switch{LawSwitch::kNone};
};

}  // namespace franka_sim
