// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <string>
#include <vector>

namespace transmission_interface {

/// A joint of a transmission, from the URDF.
struct JointInfo {
  std::string name_;                              ///< of the joint
  std::vector<std::string> hardware_interfaces_;  ///< at least one
  std::string role_;                              ///< empty if not in the URDF
  std::string xml_element_;                       ///< the whole `<joint>` element
};

/// An actuator of a transmission, from the URDF.
struct ActuatorInfo {
  std::string name_;                              ///< of the actuator
  std::vector<std::string> hardware_interfaces_;  ///< may be empty
  std::string xml_element_;                       ///< the whole `<actuator>` element
};

/// A transmission, from the URDF.
struct TransmissionInfo {
  std::string name_;                     ///< of the transmission
  std::string type_;                     ///< plugin class
  std::vector<JointInfo> joints_;        ///< at least one
  std::vector<ActuatorInfo> actuators_;  ///< at least one
};

}  // namespace transmission_interface
