// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/transmission.h>
#include <transmission_interface/transmission_interface_exception.h>

#include <cassert>
#include <cstddef>
#include <vector>

namespace transmission_interface {

/// One actuator, one joint and a gear of ratio n between them, which may be negative:
///
///     joint effort = n * actuator effort
///     joint velocity = actuator velocity / n
///     joint position = actuator position / n + offset
class SimpleTransmission : public Transmission {
 public:
  /// @param reduction n, turns of the actuator per turn of the joint
  /// @param joint_offset joint position for the actuator position zero [rad] or [m]
  /// @throws TransmissionInterfaceException if the reduction is zero.
  SimpleTransmission(const double reduction, const double joint_offset = 0.0)
      : reduction_(reduction), joint_offset_(joint_offset) {
    if (reduction == 0.0) {
      throw TransmissionInterfaceException("Transmission reduction ratio cannot be zero.");
    }
  }

  void actuatorToJointEffort(const ActuatorData& act_data, JointData& jnt_data) override {
    only(jnt_data.effort) = only(act_data.effort) * reduction_;
  }
  void actuatorToJointVelocity(const ActuatorData& act_data, JointData& jnt_data) override {
    only(jnt_data.velocity) = only(act_data.velocity) / reduction_;
  }
  void actuatorToJointPosition(const ActuatorData& act_data, JointData& jnt_data) override {
    only(jnt_data.position) = only(act_data.position) / reduction_ + joint_offset_;
  }
  void actuatorToJointAbsolutePosition(const ActuatorData& act_data, JointData& jnt_data) override {
    only(jnt_data.absolute_position) =
        only(act_data.absolute_position) / reduction_ + joint_offset_;
  }
  void actuatorToJointTorqueSensor(const ActuatorData& act_data, JointData& jnt_data) override {
    only(jnt_data.torque_sensor) = only(act_data.torque_sensor) * reduction_;
  }

  void jointToActuatorEffort(const JointData& jnt_data, ActuatorData& act_data) override {
    only(act_data.effort) = only(jnt_data.effort) / reduction_;
  }
  void jointToActuatorVelocity(const JointData& jnt_data, ActuatorData& act_data) override {
    only(act_data.velocity) = only(jnt_data.velocity) * reduction_;
  }
  void jointToActuatorPosition(const JointData& jnt_data, ActuatorData& act_data) override {
    only(act_data.position) = (only(jnt_data.position) - joint_offset_) * reduction_;
  }

  std::size_t numActuators() const override { return 1; }
  std::size_t numJoints() const override { return 1; }
  bool hasActuatorToJointAbsolutePosition() const override { return true; }
  bool hasActuatorToJointTorqueSensor() const override { return true; }

  /// Turns of the actuator for one of the joint.
  double getActuatorReduction() const { return reduction_; }
  /// Position of the joint where that of the actuator is zero [rad] or [m].
  double getJointOffset() const { return joint_offset_; }

 private:
  static double& only(const std::vector<double*>& values) {
    assert(values.size() == 1 && values[0] != nullptr);
    return *values[0];
  }

  double reduction_;
  double joint_offset_;
};

}  // namespace transmission_interface
