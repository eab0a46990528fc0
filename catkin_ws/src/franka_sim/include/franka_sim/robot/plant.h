// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/tick.h>

#include <array>
#include <limits>
#include <optional>

namespace franka_sim {

using franka_core::kTick;

/// Cutoff of the control unit's own signal filters [Hz] (decisions 2, 3).
constexpr double kSignalCutoff = 100.0;

/// Readings of the arm's sensors at the end of a tick of 1 ms.
struct ArmMeasurement {
  std::array<double, 7> q{};   ///< [rad]
  std::array<double, 7> dq{};  ///< [rad/s]
  /// Link-side torque, mean over the last tick [Nm], of the motors or the closed brakes
  /// (decision 2).
  std::array<double, 7> tau_J{};
  /// Physics steps of a simulated arm in the last tick, for its external torque (decision 3).
  int substeps{1};
};

/// Friction torque of a joint at the velocity dq [rad/s] (decision 1); it acts against the motion.
///
///   link side:   amplitude (s(slope (dq + offset)) - s(slope offset)) + viscous dq,
///                s(x) = 1 / (1 + exp(-x))
///   motor side:  damping dq + coulomb sign(dq); at rest it holds the joint like a stiff spring
///
/// The torque sensor lies between the two: tau_J contains the friction of the link side only.
struct JointFriction {
  double amplitude{0};  ///< [Nm]
  double slope{0};      ///< [s/rad]
  double offset{0};     ///< [rad/s]
  double viscous{0};    ///< [Nm s/rad]
  double coulomb{0};    ///< [Nm]
  double damping{0};    ///< [Nm s/rad]

  /// Whether there is any friction.
  bool acts() const noexcept {
    return amplitude != 0.0 || coulomb != 0.0 || viscous != 0.0 || damping != 0.0;
  }
};

/// The joints' properties that no URDF carries (decision 1), joints 1 to 7.
struct JointPhysics {
  /// Apparent inertia of the motor side behind the torque loop [kg m^2].
  std::array<double, 7> rotor_inertia{{0.1, 0.1, 0.1, 0.1, 0.1, 0.1, 0.1}};
  std::array<JointFriction, 7> friction{};  ///< of each joint
  /// The mechanical ends of the joints.
  struct Stops {
    std::array<double, 7> lower, upper;  ///< [rad]
  };
  std::optional<Stops> stops;  ///< (decision 8); without them the URDF's limits are the stops
};

/// A seven-joint arm as its control unit sees it. Implemented by physics/, faked by tests. Called
/// by the thread that steps the world. No function throws. Real-time safe.
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

/// The two fingers of a hand. Called by the same thread as ArmPlant. No function throws.
/// Real-time safe.
class HandPlant {
 public:
  virtual ~HandPlant() = default;
  /// The present state of the fingers.
  virtual HandMeasurement measure() const noexcept = 0;
  /// Force on each finger over the coming tick, positive opens [N].
  virtual void applyForces(const std::array<double, 2>& force) noexcept = 0;
};

/// Of a single joint.
struct JointMeasurement {
  double position{0}, velocity{0}, effort{0};  ///< [rad|m, rad/s|m/s, Nm|N]
};

/// What a drive that follows positions can do. Numbers that are not above 0 limit nothing.
struct DriveLimits {
  double effort{std::numeric_limits<double>::infinity()};  ///< [Nm|N]
  /// With a maximum effort only: of a joint that lags behind [rad/s|m/s]. The position's own
  /// velocity is not limited.
  double velocity{std::numeric_limits<double>::infinity()};
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
  /// Moves the joint to a position [rad] or [m] and holds it there (time constant 2 ms, critically
  /// damped: it lags a steady motion by 4 ms). Where that needs more than the maximum effort, the
  /// joint yields, and returns when it can.
  /// @returns false if it does nothing: the position is not finite, or the joint follows another
  /// one (mimic) and cannot be held
  virtual bool follow(double position, const DriveLimits& limits) noexcept = 0;
  /// The same with any effort that is needed.
  bool follow(double position) noexcept { return follow(position, DriveLimits()); }
};

}  // namespace franka_sim
