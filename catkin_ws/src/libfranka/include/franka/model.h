// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

/// @file
/// The frames of the arm's kinematics.

namespace franka {

/// A frame on the arm, from the base to the tip.
enum class Frame {
  kJoint1,
  kJoint2,
  kJoint3,
  kJoint4,
  kJoint5,
  kJoint6,
  kJoint7,
  kFlange,
  kEndEffector,
  kStiffness
};

/// Steps to the next frame and returns the one before the step, for loops over all frames:
/// `for (Frame f = Frame::kJoint1; f <= Frame::kStiffness; f++)`. The value after kStiffness is no
/// frame.
Frame operator++(Frame& frame, int /* postfix */) noexcept;

}  // namespace franka
