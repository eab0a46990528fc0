// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/fixed_pointer.h>

#include <array>

#include "robot/configuration.h"
#include "robot/estimator/estimate.h"
#include "robot/laws/control_task.h"
#include "robot/laws/torque_blend.h"

namespace franka_sim {

/// From command to torque: external torque, joint impedance, Cartesian impedance, hold, guiding;
/// saturation, gravity compensation.
///
///     tau_motor = saturate(blend(saturate(law)) + braking) + saturate(gravity)
///
/// braking: (M + B) ddq_d of an arm that brakes outside of a motion. Gravity includes the
/// configured load. Friction is not compensated: the published values were identified behind the
/// robot's own compensation, so they are what it leaves (decision 1). Called by one thread.
/// Real-time safe.
class ControlLaws {
 public:
  /// @param configuration outlives the laws.
  explicit ControlLaws(const Configuration& configuration) noexcept
      : configuration_(&configuration) {}

  /// The motor torques of the next tick [Nm]. @param estimate of the measured state
  const std::array<double, 7>& torques(const ControlTask& task,
                                       const franka_core::RobotState& state,
                                       const Estimate& estimate) noexcept;
  /// Zero torques: the brakes are closed, or there has been no measurement yet.
  const std::array<double, 7>& rest() noexcept;
  void restart() noexcept { blend_.restart(); }

  /// Torques of the last tick [Nm]: of the law, saturated, without gravity; and of the motors.
  const std::array<double, 7>& law() const noexcept { return law_; }
  const std::array<double, 7>& motorTorques() const noexcept { return motor_torques_; }

 private:
  std::array<double, 7> law(const ControlTask& task, const franka_core::RobotState& state,
                            const Estimate& estimate) const noexcept;

  FixedPointer<const Configuration> configuration_;
  TorqueBlend blend_;
  std::array<double, 7> law_{};
  std::array<double, 7> motor_torques_{};
};

}  // namespace franka_sim
