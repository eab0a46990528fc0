// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <tinyxml.h>
#include <transmission_interface/transmission.h>
#include <transmission_interface/transmission_info.h>

#include <memory>
#include <string>

namespace transmission_interface {

/// Base of the plugins that make a transmission of one type from its description. Loaders keep no
/// state; they run at start-up and log what they cannot use.
class TransmissionLoader {
 public:
  virtual ~TransmissionLoader() = default;

  /// @returns nullptr, with a sentence in the log, if the description is not usable.
  virtual TransmissionSharedPtr load(const TransmissionInfo& transmission_info) = 0;

 protected:
  enum ParseStatus {
    SUCCESS,
    NO_DATA,  ///< the element is missing
    BAD_TYPE  ///< its text is not what it should be
  };

  /// Whether the transmission has that many actuators; if not, a sentence.
  static bool checkActuatorDimension(const TransmissionInfo& transmission_info,
                                     const unsigned int expected_dim);
  /// Whether the transmission has that many joints; if not, a sentence.
  static bool checkJointDimension(const TransmissionInfo& transmission_info,
                                  const unsigned int expected_dim);

  /// The root element of an XML text; an element without a name if it is no XML.
  static TiXmlElement loadXmlElement(const std::string& element_str);

  // Each of these reads one child of the element of a joint or actuator. Where it is missing, there
  // is a sentence if `required` says so; where it is bad, in any case. The value then is untouched.

  /// <mechanicalReduction>: a finite number
  static ParseStatus getActuatorReduction(const TiXmlElement& parent_el,
                                          const std::string& actuator_name,
                                          const std::string& transmission_name, bool required,
                                          double& reduction);
  /// <mechanicalReduction>: a finite number
  static ParseStatus getJointReduction(const TiXmlElement& parent_el, const std::string& joint_name,
                                       const std::string& transmission_name, bool required,
                                       double& reduction);
  /// <offset>: a finite number [rad] or [m]
  static ParseStatus getJointOffset(const TiXmlElement& parent_el, const std::string& joint_name,
                                    const std::string& transmission_name, bool required,
                                    double& offset);
  /// <role>: a word
  static ParseStatus getActuatorRole(const TiXmlElement& parent_el,
                                     const std::string& actuator_name,
                                     const std::string& transmission_name, bool required,
                                     std::string& role);
  /// <role>: a word
  static ParseStatus getJointRole(const TiXmlElement& parent_el, const std::string& joint_name,
                                  const std::string& transmission_name, bool required,
                                  std::string& role);
};

typedef std::shared_ptr<TransmissionLoader> TransmissionLoaderSharedPtr;

}  // namespace transmission_interface
