// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>

/// @file
/// The only name of the protocol's own headers that programs for libfranka 0.11 and later use: the
/// controller of a motion that the program drives itself.

namespace research_interface {
namespace robot {

/// The command that starts a motion.
struct Move {
  /// The controller of the motion.
  enum class ControllerMode : uint32_t {
    kJointImpedance,      ///< springs between q and q_d, in the robot
    kCartesianImpedance,  ///< springs between O_T_EE and O_T_EE_d, in the robot
    kExternalController   ///< the torques of the program
  };
};

}  // namespace robot
}  // namespace research_interface
