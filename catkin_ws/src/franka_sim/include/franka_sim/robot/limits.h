// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/motion_limits.h>
#include <franka_core/robot_error.h>
#include <franka_core/robot_state.h>

#include <array>
#include <bitset>
#include <cstddef>

namespace franka_sim {

/// The errors of one tick. Every rule that is violated adds its own (decision 47). Real-time safe.
class ErrorSet {
 public:
  ErrorSet() noexcept = default;
  // NOLINTNEXTLINE(google-explicit-constructor): one error is a set of one
  ErrorSet(franka_core::RobotError error) noexcept { add(error); }

  void add(franka_core::RobotError error) noexcept { addIf(true, error); }
  void add(const ErrorSet& others) noexcept { flags_ |= others.flags_; }
  /// Adds the error if a rule is violated.
  void addIf(bool violated, franka_core::RobotError error) noexcept {
    flags_[franka_core::indexOf(error)] = violated || flags_[franka_core::indexOf(error)];
  }
  /// Sets the flags of these errors in the order of the wire; the others stay.
  void addTo(std::array<bool, franka_core::kErrorCount>& flags) const noexcept {
    if (flags_.any()) {
      for (std::size_t i = 0; i < flags.size(); i++) {
        flags[i] = flags[i] || flags_[i];
      }
    }
  }

  explicit operator bool() const noexcept { return flags_.any(); }
  friend bool operator==(const ErrorSet& a, const ErrorSet& b) noexcept {
    return a.flags_ == b.flags_;
  }

 private:
  std::bitset<franka_core::kErrorCount> flags_;
};

using franka_core::MotionLimits;
using franka_core::motionLimitsOfProtocol;

/// Limits of the measured arm, in every mode with motor control (decision 14). The motion
/// generators check the commands; these limits are at least 5 % wider, so that an arm which follows
/// its commands well is not stopped.
/// @param O_dP_EE measured twist of EE in O [m/s, rad/s]
/// @returns the errors out of: tau_J_range_violation (|tau_J| above 1.2 times the motors' range),
/// joint_position_limits_violation (0.005 rad beyond), joint_velocity_violation (1.05 times),
/// cartesian velocity (1.05 times that of the translation), power_limit_violation (kPowerLimit).
/// Real-time safe.
ErrorSet measuredViolations(const franka_core::ArmLimits& limits,
                            const franka_core::RobotState& state,
                            const std::array<double, 6>& O_dP_EE) noexcept;

/// Sum of |tau_J dq| over the joints [W]. Chosen here: the data sheet gives a peak electrical power
/// of about 350 W, and the mechanical power cannot exceed it.
constexpr double kPowerLimit = 350.0;

/// Whether a joint is 0.005 rad or more beyond its limits, so that the user must move it back.
/// Real-time safe.
bool beyondJointLimits(const franka_core::ArmLimits& limits,
                       const std::array<double, 7>& q) noexcept;

}  // namespace franka_sim
