// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <optional>

namespace franka_sim {

/// Readings of the arm's sensors at the end of a tick of 1 ms.
struct ArmMeasurement {
  std::array<double, 7> q{};   ///< [rad]
  std::array<double, 7> dq{};  ///< [rad/s]
  /// Link-side torque, mean over the last tick [Nm], of the motors or the closed brakes
  /// (decision 2).
  std::array<double, 7> tau_J{};
};

/// The joints' properties that no URDF carries (decision 1), joints 1 to 7.
struct JointPhysics {
  std::array<double, 7> rotor_inertia{{0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};  ///< [kg m^2]
  std::array<double, 7> coulomb_friction{};                                  ///< [Nm]
  std::array<double, 7> damping{};                                           ///< [Nm s/rad]
  struct Stops {
    std::array<double, 7> lower, upper;  ///< [rad]
  };
  std::optional<Stops> stops;  ///< (decision 8); without them the URDF's limits are the stops
};

/// A seven-joint arm as its control unit sees it. Implemented by physics/, faked by tests. Called
/// from the thread that steps the world; no function allocates or throws.
class ArmPlant {
 public:
  virtual ~ArmPlant() = default;
  /// Sensors at the end of the last tick. Right after a reset tau_J is the applied torque.
  virtual ArmMeasurement measure() const noexcept = 0;
  /// Motor torques held over the coming tick [Nm].
  virtual void applyTorques(const std::array<double, 7>& tau) noexcept = 0;
  /// Closed brakes lock the joints where they are, whatever torque is applied.
  virtual void setBrakes(bool closed) noexcept = 0;
};

/// Readings of the two fingers' sensors at the end of a tick.
struct HandMeasurement {
  std::array<double, 2> q{};   ///< finger positions from closed [m], width = q[0] + q[1]
  std::array<double, 2> dq{};  ///< [m/s]
};

/// The two fingers of a hand. Same thread and rules as ArmPlant.
class HandPlant {
 public:
  virtual ~HandPlant() = default;
  virtual HandMeasurement measure() const noexcept = 0;
  /// Force on each finger over the coming tick, positive opens [N].
  virtual void applyForces(const std::array<double, 2>& force) noexcept = 0;
};

}  // namespace franka_sim
