// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstddef>
#include <memory>
#include <stdexcept>
#include <vector>

namespace transmission_interface {

/// Pointers to the values of a transmission's actuators. Each vector is empty or has one pointer
/// per actuator. Units: [rad] or [m], [rad/s] or [m/s], [Nm] or [N].
struct ActuatorData {
  std::vector<double*> position;           ///< [rad] or [m]
  std::vector<double*> velocity;           ///< [rad/s] or [m/s]
  std::vector<double*> effort;             ///< [Nm] or [N]
  std::vector<double*> absolute_position;  ///< [rad] or [m]; optional
  std::vector<double*> torque_sensor;      ///< [Nm]; optional
};

/// Pointers to the values of a transmission's joints, one per joint. Units as above.
struct JointData {
  std::vector<double*> position;           ///< [rad] or [m]
  std::vector<double*> velocity;           ///< [rad/s] or [m/s]
  std::vector<double*> effort;             ///< [Nm] or [N]
  std::vector<double*> absolute_position;  ///< [rad] or [m]; optional
  std::vector<double*> torque_sensor;      ///< [Nm]; optional
};

/// The mechanics between actuators and joints: maps each kind of value from one side to the other.
/// A map reads and writes only the vectors of its kind, which must have the transmission's size and
/// no null pointer (asserted). The maps do not change the transmission. Real-time safe.
class Transmission {
 public:
  virtual ~Transmission() = default;

  /// @name From the actuators to the joints
  /// @{
  virtual void actuatorToJointEffort(const ActuatorData& act_data, JointData& jnt_data) = 0;
  virtual void actuatorToJointVelocity(const ActuatorData& act_data, JointData& jnt_data) = 0;
  virtual void actuatorToJointPosition(const ActuatorData& act_data, JointData& jnt_data) = 0;
  /// @}

  /// @throws std::runtime_error unless hasActuatorToJointAbsolutePosition
  virtual void actuatorToJointAbsolutePosition(const ActuatorData& /*act_data*/,
                                               JointData& /*jnt_data*/) {
    throw std::runtime_error("transmission does not support actuator to joint absolute position");
  }
  /// @throws std::runtime_error unless hasActuatorToJointTorqueSensor
  virtual void actuatorToJointTorqueSensor(const ActuatorData& /*act_data*/,
                                           JointData& /*jnt_data*/) {
    throw std::runtime_error("transmission does not support actuator to joint torque sensor");
  }

  /// @name From the joints to the actuators
  /// @{
  virtual void jointToActuatorEffort(const JointData& jnt_data, ActuatorData& act_data) = 0;
  virtual void jointToActuatorVelocity(const JointData& jnt_data, ActuatorData& act_data) = 0;
  virtual void jointToActuatorPosition(const JointData& jnt_data, ActuatorData& act_data) = 0;
  /// @}

  /// @name How many there are
  /// @{
  virtual std::size_t numActuators() const = 0;
  virtual std::size_t numJoints() const = 0;
  /// @}

  /// @name Which sensors it maps
  /// @{
  virtual bool hasActuatorToJointAbsolutePosition() const { return false; }
  virtual bool hasActuatorToJointTorqueSensor() const { return false; }
  /// @}
};

typedef std::shared_ptr<Transmission> TransmissionSharedPtr;

}  // namespace transmission_interface
