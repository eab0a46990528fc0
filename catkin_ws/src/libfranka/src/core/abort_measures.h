// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/abort_diagnosis.h>
#include <franka_core/motion_limits.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace franka_core {

/// A commanded or measured value, and its limit.
struct Excess {
  std::string what;   ///< "joint 3", "the translation"
  const char* unit;   ///< of the quantity whose derivative it is: "m", "rad", "Nm"
  double value{0.0};  ///< [unit/s], [unit/s^2] or [unit/s^3]
  double limit{0.0};
  std::uint64_t age{0};  ///< before the last record of the log [ms]

  /// Of value and limit; infinite if the limit is 0.
  double ratio() const;
};

/// The quantities that a robot limits, as far as the log of a motion shows them: of each quantity
/// the value that is farthest beyond its limit. Empty if the log does not show the quantity.
///
/// Commands are compared with the state that they answer: backward differences over 1 ms. `order`
/// is 1 for velocities, 2 for accelerations, 3 for jerks.
class AbortMeasures {
 public:
  /// @param log owned by the caller @param version of the robot's protocol
  AbortMeasures(const std::vector<AbortRecord>& log, unsigned version)
      : log_(log), limits_(motionLimitsOfProtocol(version)) {}

  const MotionLimits& limits() const { return limits_; }

  std::optional<Excess> commandedJoints(int order) const;
  std::optional<Excess> commandedTwist(int order) const;
  /// The lowest derivative of the commanded elbow (joint 3) that is beyond its limit.
  std::optional<Excess> commandedElbow(int& order) const;
  std::optional<Excess> commandedTorques() const;
  /// For joints that follow Cartesian commands by inverse kinematics. States show accepted steps;
  /// the refused one is extrapolated by their last derivative.
  std::optional<Excess> solvedJoints(int order) const;
  std::optional<Excess> measuredJoints() const;
  /// Positions of the joints of solvedJoints after the refused step [rad].
  std::optional<std::array<double, 7>> solvedPositions() const;

 private:
  /// The limit of a joint's derivative at q [rad], in the direction of `value`.
  double jointLimit(int order, std::size_t joint, double q, double value) const;

  const std::vector<AbortRecord>& log_;
  const MotionLimits limits_;
};

/// Whether a motion generator's command is in use: unused values are zero.
template <std::size_t kSize>
bool isUsed(const std::array<double, kSize>& values) {
  for (const double value : values) {
    if (value != 0.0) {
      return true;
    }
  }
  return false;
}

/// "joint 1" for 0.
std::string jointName(std::size_t i);

}  // namespace franka_core
