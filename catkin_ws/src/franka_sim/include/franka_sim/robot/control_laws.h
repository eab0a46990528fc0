// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/configuration.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/state_estimator.h>
#include <franka_sim/robot/torque_blend.h>

#include <array>

namespace franka_sim {

/// How the torque of one tick continues the torque of the previous tick.
enum class LawSwitch {
  kNone,
  kBlend,     ///< the law changes, but the torque has no step
  kFromZero,  ///< the next law starts at zero: its torque acts at once
};

/// The impedance of a guided arm along the axes that are not free.
struct GuidingTask {
  std::array<bool, 6> free{{true, true, true, true, true, true}};  ///< x, y, z, R, P, Y of K
  bool elbow_free{true};
  std::array<double, 16> O_T_EE{};  ///< the pose in which guiding began
  std::array<double, 7> q{};
};

/// The task of the control laws in a tick.
struct ControlTask {
  franka_core::RobotMode mode{franka_core::RobotMode::kIdle};
  franka_core::ControllerMode controller{franka_core::ControllerMode::kOther};  ///< in Move
  std::array<double, 7> tau{};  ///< torques of an external controller [Nm]
  GuidingTask guiding;
  LawSwitch law_switch{LawSwitch::kNone};
};

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
