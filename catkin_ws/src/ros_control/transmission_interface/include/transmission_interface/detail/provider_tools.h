// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/hardware_interface.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/internal/interface_manager.h>
#include <hardware_interface/robot_hw.h>
#include <ros/console.h>
#include <transmission_interface/requisite_provider.h>

#include <algorithm>
#include <string>
#include <vector>

namespace transmission_interface {
namespace internal {

/// The manager's interface of this type; if it has none, `own` is registered.
template <class Interface>
Interface& provided(hardware_interface::InterfaceManager& manager, Interface& own) {
  Interface* known = manager.get<Interface>();
  if (known != nullptr) {
    return *known;
  }
  manager.registerInterface(&own);
  return own;
}

/// Updates a manager's list of the handles in `own`.
template <class Interface>
void refresh(hardware_interface::InterfaceManager& manager, Interface& own) {
  if (manager.get<Interface>() == &own) {
    manager.registerInterface(&own);
  }
}

template <class Interface>
bool hasResource(const std::string& name, const Interface& interface) {
  const std::vector<std::string> names = interface.getNames();
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// The robot's handles of a transmission's actuators, in their order. @returns false, with a
/// sentence, if the robot lacks the interface or an actuator.
template <class Interface>
bool getActuatorHandles(const TransmissionInfo& info, hardware_interface::RobotHW& robot,
                        std::vector<typename Interface::ResourceHandleType>& handles) {
  Interface* interface = robot.get<Interface>();
  if (interface == nullptr) {
    ROS_ERROR_STREAM("Transmission '"
                     << info.name_ << "' needs actuators, but the robot has no interface of type '"
                     << hardware_interface::internal::demangledTypeName<Interface>() << "'.");
    return false;
  }
  for (const ActuatorInfo& actuator : info.actuators_) {
    try {
      handles.push_back(interface->getHandle(actuator.name_));
    } catch (const hardware_interface::HardwareInterfaceException& error) {
      ROS_ERROR_STREAM("Transmission '" << info.name_ << "' needs the actuator '" << actuator.name_
                                        << "', which the robot does not have. " << error.what());
      return false;
    }
  }
  return true;
}

/// Registers one map of a transmission, unless another interface of the same joints already did.
/// The map of another transmission of that name is replaced. @throws TransmissionInterfaceException
/// for data that do not match the transmission.
template <class Interface>
void addMap(RobotTransmissions& transmissions, Interface& own, const std::string& name,
            Transmission* transmission, const ActuatorData& actuators, const JointData& joints) {
  Interface& interface = provided(transmissions, own);
  if (!hasResource(name, interface) || !interface.getHandle(name).maps(transmission)) {
    interface.registerHandle(
        typename Interface::ResourceHandleType(name, transmission, actuators, joints));
    refresh(transmissions, own);
  }
}

}  // namespace internal
}  // namespace transmission_interface
