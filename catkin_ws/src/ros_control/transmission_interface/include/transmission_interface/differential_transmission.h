// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/pair_transmission.h>

#include <vector>

namespace transmission_interface {

/// Two actuators on two joints: equal rotation moves the first joint, opposite rotation the second.
/// With the actuators' reductions ar and the joints' jr:
///
///     joint effort   1: jr1 (ar1 a1 + ar2 a2)         2: jr2 (ar1 a1 - ar2 a2)
///     joint velocity 1: (a1/ar1 + a2/ar2) / (2 jr1)   2: (a1/ar1 - a2/ar2) / (2 jr2)
///     joint position as velocity, plus the joint's offset
class DifferentialTransmission : public internal::PairTransmission {
 public:
  /// @param actuator_reduction, joint_reduction two ratios each, none zero
  /// @param joint_offset joint positions for actuator positions of zero
  /// @throws TransmissionInterfaceException for sizes other than two and reductions of zero.
  DifferentialTransmission(const std::vector<double>& actuator_reduction,
                           const std::vector<double>& joint_reduction,
                           const std::vector<double>& joint_offset = std::vector<double>(2, 0.0))
      : DifferentialTransmission(actuator_reduction, joint_reduction, false, joint_offset) {}

  /// @param ignore_transmission_for_absolute_encoders true for absolute encoders on the joints'
  /// side: their values pass unchanged, the first actuator's to the second joint and the second's
  /// to the first, as in the original
  DifferentialTransmission(const std::vector<double>& actuator_reduction,
                           const std::vector<double>& joint_reduction,
                           bool ignore_transmission_for_absolute_encoders,
                           const std::vector<double>& joint_offset = std::vector<double>(2, 0.0))
      : PairTransmission("differential", actuator_reduction, joint_reduction, joint_offset),
        ignore_transmission_for_absolute_encoders_(ignore_transmission_for_absolute_encoders) {}

  void actuatorToJointEffort(const ActuatorData& act_data, JointData& jnt_data) override {
    set(jnt_data.effort, jointEffort(get(act_data.effort)));
  }
  void actuatorToJointVelocity(const ActuatorData& act_data, JointData& jnt_data) override {
    set(jnt_data.velocity, jointMotion(get(act_data.velocity)));
  }
  void actuatorToJointPosition(const ActuatorData& act_data, JointData& jnt_data) override {
    set(jnt_data.position, withOffset(jointMotion(get(act_data.position))));
  }
  void actuatorToJointAbsolutePosition(const ActuatorData& act_data, JointData& jnt_data) override {
    const Pair act = get(act_data.absolute_position);
    set(jnt_data.absolute_position, ignore_transmission_for_absolute_encoders_
                                        ? Pair{act.second, act.first}
                                        : withOffset(jointMotion(act)));
  }
  void actuatorToJointTorqueSensor(const ActuatorData& act_data, JointData& jnt_data) override {
    set(jnt_data.torque_sensor, jointEffort(get(act_data.torque_sensor)));
  }

  void jointToActuatorEffort(const JointData& jnt_data, ActuatorData& act_data) override {
    const Pair jnt = get(jnt_data.effort);
    const double common = jnt.first / jnt_reduction_[0];
    const double difference = jnt.second / jnt_reduction_[1];
    set(act_data.effort, {(common + difference) / (2.0 * act_reduction_[0]),
                          (common - difference) / (2.0 * act_reduction_[1])});
  }
  void jointToActuatorVelocity(const JointData& jnt_data, ActuatorData& act_data) override {
    set(act_data.velocity, actuatorMotion(get(jnt_data.velocity)));
  }
  void jointToActuatorPosition(const JointData& jnt_data, ActuatorData& act_data) override {
    set(act_data.position, actuatorMotion(withoutOffset(get(jnt_data.position))));
  }

  bool hasActuatorToJointAbsolutePosition() const override { return true; }
  bool hasActuatorToJointTorqueSensor() const override { return true; }

 private:
  Pair jointEffort(const Pair& act) const {
    const double first = act.first * act_reduction_[0];
    const double second = act.second * act_reduction_[1];
    return {jnt_reduction_[0] * (first + second), jnt_reduction_[1] * (first - second)};
  }
  Pair jointMotion(const Pair& act) const {
    const double first = act.first / act_reduction_[0];
    const double second = act.second / act_reduction_[1];
    return {(first + second) / (2.0 * jnt_reduction_[0]),
            (first - second) / (2.0 * jnt_reduction_[1])};
  }
  Pair actuatorMotion(const Pair& jnt) const {
    const double common = jnt.first * jnt_reduction_[0];
    const double difference = jnt.second * jnt_reduction_[1];
    return {(common + difference) * act_reduction_[0], (common - difference) * act_reduction_[1]};
  }

  bool ignore_transmission_for_absolute_encoders_;
};

}  // namespace transmission_interface
