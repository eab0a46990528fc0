// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// @file
/// The one name of the protocol's own headers that programs written for libfranka 0.11 and later
/// spell out: the controller of a motion that they drive themselves.

namespace research_interface {
namespace robot {

/// The command that starts a motion.
struct Move {
  /// What turns the motion into torques.
  enum class ControllerMode : uint32_t {
    kJointImpedance,      ///< springs between q and q_d, in the robot
    kCartesianImpedance,  ///< springs between O_T_EE and O_T_EE_d, in the robot
    kExternalController   ///< the torques of the program
  };
};

}  // namespace robot
}  // namespace research_interface
