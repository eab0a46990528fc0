// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/abort_diagnosis.h>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace franka_core {

/// A value that was commanded or measured, and what is allowed.
struct Excess {
  std::string what;   ///< "joint 3", "the translation"
  const char* unit;   ///< of the quantity whose derivative it is: "m", "rad", "Nm"
  double value{0.0};  ///< [unit/s], [unit/s^2] or [unit/s^3]
  double limit{0.0};
  std::uint64_t time{0};  ///< [ms]

  /// Of value and limit; infinite where nothing is allowed.
  double ratio() const;
};

/// The quantities that a robot watches, as far as the log of a motion shows them: of each the one
/// that is farthest beyond its limit. Nothing where the log does not show the quantity.
///
/// Commands are compared with the state they answered: backward differences over 1 ms. `order` is
/// 1 for velocities, 2 for accelerations, 3 for jerks.
class AbortMeasures {
 public:
  /// @param log kept by the caller @param version of the robot's protocol
  AbortMeasures(const std::vector<AbortRecord>& log, unsigned version);

  std::optional<Excess> commandedJoints(int order) const;
  std::optional<Excess> commandedTwist(int order) const;
  /// The lowest derivative of the commanded elbow (joint 3) that is beyond its limit.
  std::optional<Excess> commandedElbow(int& order) const;
  std::optional<Excess> commandedTorques() const;
  /// Of the joints that follow from Cartesian commands by inverse kinematics. States show what the
  /// robot accepted; the step that it refused is what their last derivative leads to.
  std::optional<Excess> solvedJoints(int order) const;
  std::optional<Excess> measuredJoints() const;
  /// Where the joints of solvedJoints would have been after the refused step [rad].
  std::optional<std::array<double, 7>> solvedPositions() const;

 private:
  double velocityLimit(std::size_t joint, double q, double direction) const;

  const std::vector<AbortRecord>& log_;
  unsigned version_;
};

/// Whether a motion generator's command is in use: what a motion does not use stays zero.
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
