// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/detail/pair_transmission.h>

#include <vector>

namespace transmission_interface {

/// Two actuators on two joints by a four-bar linkage: the first actuator rotates the first joint,
/// the second rotates the second joint relative to the robot's body. With the actuators' reductions
/// ar and the joints' jr:
///
///     joint effort   1: jr1 ar1 a1          2: jr2 (ar2 a2 - jr1 ar1 a1)
///     joint velocity 1: a1 / (jr1 ar1)      2: (a2/ar2 - a1/(jr1 ar1)) / jr2
///     joint position as velocity, plus the joint's offset
///
/// These are the original's formulas, with which robots are tuned. Those of effort do not conserve
/// power: the transpose of the velocities' map would give jr1 ar1 a1 + ar2 a2 and jr2 ar2 a2.
class FourBarLinkageTransmission : public internal::PairTransmission {
 public:
  /// @param actuator_reduction, joint_reduction two ratios each, none zero
  /// @param joint_offset joint positions for actuator positions of zero
  /// @throws TransmissionInterfaceException for sizes other than two and reductions of zero.
  FourBarLinkageTransmission(const std::vector<double>& actuator_reduction,
                             const std::vector<double>& joint_reduction,
                             const std::vector<double>& joint_offset = std::vector<double>(2, 0.0))
      : PairTransmission("four-bar linkage", actuator_reduction, joint_reduction, joint_offset) {}

  void actuatorToJointEffort(const ActuatorData& act_data, JointData& jnt_data) override {
    const Pair act = get(act_data.effort);
    const double first = jnt_reduction_[0] * act.first * act_reduction_[0];
    set(jnt_data.effort, {first, jnt_reduction_[1] * (act.second * act_reduction_[1] - first)});
  }
  void actuatorToJointVelocity(const ActuatorData& act_data, JointData& jnt_data) override {
    set(jnt_data.velocity, jointMotion(get(act_data.velocity)));
  }
  void actuatorToJointPosition(const ActuatorData& act_data, JointData& jnt_data) override {
    set(jnt_data.position, withOffset(jointMotion(get(act_data.position))));
  }

  void jointToActuatorEffort(const JointData& jnt_data, ActuatorData& act_data) override {
    const Pair jnt = get(jnt_data.effort);
    set(act_data.effort, {jnt.first / (act_reduction_[0] * jnt_reduction_[0]),
                          (jnt.first + jnt.second / jnt_reduction_[1]) / act_reduction_[1]});
  }
  void jointToActuatorVelocity(const JointData& jnt_data, ActuatorData& act_data) override {
    set(act_data.velocity, actuatorMotion(get(jnt_data.velocity)));
  }
  void jointToActuatorPosition(const JointData& jnt_data, ActuatorData& act_data) override {
    set(act_data.position, actuatorMotion(withoutOffset(get(jnt_data.position))));
  }

 private:
  Pair jointMotion(const Pair& act) const {
    const double first = act.first / (jnt_reduction_[0] * act_reduction_[0]);
    return {first, (act.second / act_reduction_[1] - first) / jnt_reduction_[1]};
  }
  Pair actuatorMotion(const Pair& jnt) const {
    return {jnt.first * jnt_reduction_[0] * act_reduction_[0],
            (jnt.first + jnt.second * jnt_reduction_[1]) * act_reduction_[1]};
  }
};

}  // namespace transmission_interface
