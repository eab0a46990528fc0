// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

struct JointMeasurement {
  double position{0}, velocity{0}, effort{0};  ///< [rad|m, rad/s|m/s, Nm|N]
};

/// The drive of a single joint of another device, such as a lift, a wheel or another gripper.
/// Called by the thread that steps the world. No function throws. Real-time safe.
class JointDrive {
 public:
  virtual ~JointDrive() = default;
  /// Position and velocity at the end of the last tick, and the mean effort of the drive [Nm|N].
  virtual JointMeasurement measure() const noexcept = 0;
  /// Ends follow(); the effort [Nm] or [N] acts until another one is given.
  virtual void applyEffort(double effort) noexcept = 0;
  /// Moves the joint to a position [rad] or [m] and holds it there with any effort needed (time
  /// constant 2 ms, critically damped: it lags a steady motion by 4 ms).
  virtual void follow(double position) noexcept = 0;
};

}  // namespace franka_sim
