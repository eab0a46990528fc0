// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/ros.h>
#include <tinyxml.h>
#include <transmission_interface/transmission_info.h>

#include <string>
#include <vector>

namespace transmission_interface {

/// Reads the `<transmission>` elements of a URDF. Without state. Thread-safe. Not real-time safe.
class TransmissionParser {
 public:
  /// Appends the transmissions of a robot description. Invalid ones are logged and skipped.
  /// @param urdf_string the XML text itself
  /// @returns false if the text is not XML; a robot without transmissions is valid.
  static bool parse(const std::string& urdf_string, std::vector<TransmissionInfo>& transmissions);

 protected:
  /// The joints of one `<transmission>` element.
  /// @returns false without a valid one, or if one has no name attribute.
  static bool parseJoints(TiXmlElement* trans_it, std::vector<JointInfo>& joints);

  /// The actuators of one `<transmission>` element.
  /// @returns false without a valid one, or if one has no name attribute.
  static bool parseActuators(TiXmlElement* trans_it, std::vector<ActuatorInfo>& actuators);
};

}  // namespace transmission_interface
