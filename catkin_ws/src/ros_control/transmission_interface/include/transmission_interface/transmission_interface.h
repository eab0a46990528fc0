// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/internal/resource_manager.h>
#include <transmission_interface/detail/transmission_handle.h>
#include <transmission_interface/transmission.h>
#include <transmission_interface/transmission_interface_exception.h>

#include <stdexcept>
#include <string>

namespace transmission_interface {

/// Maps positions, velocities and efforts of actuators to the joints; absolute positions and torque
/// sensors too if data exist and the transmission supports them.
class ActuatorToJointStateHandle : public TransmissionHandle {
 public:
  /// All handles: @throws TransmissionInterfaceException for missing or mismatching data.
  ActuatorToJointStateHandle(const std::string& name, Transmission* transmission,
                             const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.position, joint_data.position, "positions");
    require(actuator_data.velocity, joint_data.velocity, "velocities");
    require(actuator_data.effort, joint_data.effort, "efforts");
    maps_absolute_position_ = transmission->hasActuatorToJointAbsolutePosition() &&
                              !actuator_data.absolute_position.empty() &&
                              !joint_data.absolute_position.empty();
    maps_torque_sensor_ = transmission->hasActuatorToJointTorqueSensor() &&
                          !actuator_data.torque_sensor.empty() && !joint_data.torque_sensor.empty();
  }

  /// Maps the present values. Real-time safe.
  void propagate() {
    transmission_->actuatorToJointPosition(actuator_data_, joint_data_);
    transmission_->actuatorToJointVelocity(actuator_data_, joint_data_);
    transmission_->actuatorToJointEffort(actuator_data_, joint_data_);
    if (maps_absolute_position_) {
      transmission_->actuatorToJointAbsolutePosition(actuator_data_, joint_data_);
    }
    if (maps_torque_sensor_) {
      transmission_->actuatorToJointTorqueSensor(actuator_data_, joint_data_);
    }
  }

 private:
  bool maps_absolute_position_{false};
  bool maps_torque_sensor_{false};
};

/// Maps positions, velocities and efforts of joints to the actuators.
class JointToActuatorStateHandle : public TransmissionHandle {
 public:
  JointToActuatorStateHandle(const std::string& name, Transmission* transmission,
                             const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.position, joint_data.position, "positions");
    require(actuator_data.velocity, joint_data.velocity, "velocities");
    require(actuator_data.effort, joint_data.effort, "efforts");
  }

  /// Maps the present values. Real-time safe.
  void propagate() {
    transmission_->jointToActuatorPosition(joint_data_, actuator_data_);
    transmission_->jointToActuatorVelocity(joint_data_, actuator_data_);
    transmission_->jointToActuatorEffort(joint_data_, actuator_data_);
  }
};

/// Maps positions of actuators to the joints.
class ActuatorToJointPositionHandle : public TransmissionHandle {
 public:
  ActuatorToJointPositionHandle(const std::string& name, Transmission* transmission,
                                const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.position, joint_data.position, "positions");
  }

  /// Maps the present values. Real-time safe.
  void propagate() { transmission_->actuatorToJointPosition(actuator_data_, joint_data_); }
};

/// Maps velocities of actuators to the joints.
class ActuatorToJointVelocityHandle : public TransmissionHandle {
 public:
  ActuatorToJointVelocityHandle(const std::string& name, Transmission* transmission,
                                const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.velocity, joint_data.velocity, "velocities");
  }

  /// Maps the present values. Real-time safe.
  void propagate() { transmission_->actuatorToJointVelocity(actuator_data_, joint_data_); }
};

/// Maps efforts of actuators to the joints.
class ActuatorToJointEffortHandle : public TransmissionHandle {
 public:
  ActuatorToJointEffortHandle(const std::string& name, Transmission* transmission,
                              const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.effort, joint_data.effort, "efforts");
  }

  /// Maps the present values. Real-time safe.
  void propagate() { transmission_->actuatorToJointEffort(actuator_data_, joint_data_); }
};

/// Maps positions of joints to the actuators.
class JointToActuatorPositionHandle : public TransmissionHandle {
 public:
  JointToActuatorPositionHandle(const std::string& name, Transmission* transmission,
                                const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.position, joint_data.position, "positions");
  }

  /// Maps the present values. Real-time safe.
  void propagate() { transmission_->jointToActuatorPosition(joint_data_, actuator_data_); }
};

/// Maps velocities of joints to the actuators.
class JointToActuatorVelocityHandle : public TransmissionHandle {
 public:
  JointToActuatorVelocityHandle(const std::string& name, Transmission* transmission,
                                const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.velocity, joint_data.velocity, "velocities");
  }

  /// Maps the present values. Real-time safe.
  void propagate() { transmission_->jointToActuatorVelocity(joint_data_, actuator_data_); }
};

/// Maps efforts of joints to the actuators.
class JointToActuatorEffortHandle : public TransmissionHandle {
 public:
  JointToActuatorEffortHandle(const std::string& name, Transmission* transmission,
                              const ActuatorData& actuator_data, const JointData& joint_data)
      : TransmissionHandle(name, transmission, actuator_data, joint_data) {
    require(actuator_data.effort, joint_data.effort, "efforts");
  }

  /// Maps the present values. Real-time safe.
  void propagate() { transmission_->jointToActuatorEffort(joint_data_, actuator_data_); }
};

/// Handles of one kind for a robot's transmissions. Filled at start-up. Called by one thread at a
/// time.
/// @tparam HandleType one of the handles above
template <class HandleType>
class TransmissionInterface : public hardware_interface::ResourceManager<HandleType> {
 public:
  typedef HandleType ResourceHandleType;  ///< of its resources

  /// A copy of the named handle.
  /// @throws TransmissionInterfaceException for an unknown name.
  HandleType getHandle(const std::string& name) {
    try {
      return hardware_interface::ResourceManager<HandleType>::getHandle(name);
    } catch (const std::logic_error& error) {
      throw TransmissionInterfaceException(error.what());
    }
  }

  /// Maps all handles, in the order of their names. Real-time safe.
  void propagate() {
    for (auto& resource : this->resource_map_) {
      resource.second.propagate();
    }
  }
};

// A robot propagates the states of its actuators to the joints after it has read them, and the
// commands of its joints to the actuators before it writes them; a simulation does the opposite.
/// Maps states of actuators to the joints.
class ActuatorToJointStateInterface : public TransmissionInterface<ActuatorToJointStateHandle> {};
/// Maps positions of actuators to the joints.
class ActuatorToJointPositionInterface
    : public TransmissionInterface<ActuatorToJointPositionHandle> {};
/// Maps velocities of actuators to the joints.
class ActuatorToJointVelocityInterface
    : public TransmissionInterface<ActuatorToJointVelocityHandle> {};
/// Maps efforts of actuators to the joints.
class ActuatorToJointEffortInterface : public TransmissionInterface<ActuatorToJointEffortHandle> {};
/// Maps states of joints to the actuators.
class JointToActuatorStateInterface : public TransmissionInterface<JointToActuatorStateHandle> {};
/// Maps positions of joints to the actuators.
class JointToActuatorPositionInterface
    : public TransmissionInterface<JointToActuatorPositionHandle> {};
/// Maps velocities of joints to the actuators.
class JointToActuatorVelocityInterface
    : public TransmissionInterface<JointToActuatorVelocityHandle> {};
/// Maps efforts of joints to the actuators.
class JointToActuatorEffortInterface : public TransmissionInterface<JointToActuatorEffortHandle> {};

}  // namespace transmission_interface
