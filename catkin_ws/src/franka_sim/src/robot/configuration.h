// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/unit_request.h>

#include <array>

namespace franka_sim {

/// The configuration of a control unit: its initial parameters with the changes by requests. Called
/// by one thread. Real-time safe. Exception: the constructor.
class Configuration {
 public:
  /// @throws std::invalid_argument that names the invalid parameter.
  explicit Configuration(const ControlUnitParameters& parameters);

  /// The parameters of the constructor.
  const ControlUnitParameters& parameters() const noexcept { return parameters_; }
  /// Payload of end effector and load together.
  const franka_core::Payload& payload() const noexcept { return payload_; }
  /// Stiffness of joint impedance control [Nm/rad].
  const std::array<double, 7>& jointStiffness() const noexcept { return joint_stiffness_; }
  /// Whether collisions and violated limits stop the robot.
  bool hasReflexes() const noexcept { return franka_sim::hasReflexes(parameters_.rules); }

  /// Each function applies a request, or refuses it (kInvalidArgumentRejected) and changes nothing:
  /// frames that are not rigid or beyond 10 m, loads that no arm can hold (payloadFault),
  /// thresholds that are not finite or negative, stiffnesses out of range
  /// (control_unit_parameters.h), versions other than 3 to 10. A lower threshold may lie above the
  /// upper one: with reflexes there are then no contacts.
  Status apply(const franka_core::fci::SetNEToEERequest& request) noexcept;
  Status apply(const franka_core::fci::SetEEToKRequest& request) noexcept;
  Status apply(const franka_core::fci::SetLoadRequest& request) noexcept;
  Status apply(const franka_core::fci::SetCollisionBehaviorRequest& request) noexcept;
  Status apply(const franka_core::fci::SetJointImpedanceRequest& request) noexcept;
  Status apply(const franka_core::fci::SetCartesianImpedanceRequest& request) noexcept;
  Status apply(const SetProtocolVersion& request) noexcept;
  Status apply(const SetEndEffector& request) noexcept;

  /// Writes frames, payloads and gravity into the state.
  void writeTo(franka_core::RobotState& state) const noexcept;

 private:
  ControlUnitParameters parameters_;
  franka_core::Payload payload_;
  std::array<double, 7> joint_stiffness_;
};

}  // namespace franka_sim
