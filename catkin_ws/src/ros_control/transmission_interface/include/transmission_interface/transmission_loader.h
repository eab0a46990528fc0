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

/// Base of the plugins that create a transmission of one type from its description. Loaders have no
/// state; they run at start-up and log errors.
class TransmissionLoader {
 public:
  virtual ~TransmissionLoader() = default;

  /// @returns nullptr, with a sentence in the log, if the description is invalid.
  virtual TransmissionSharedPtr load(const TransmissionInfo& transmission_info) = 0;

 protected:
  enum ParseStatus {
    SUCCESS,
    NO_DATA,  ///< the element is missing
    BAD_TYPE  ///< its text is invalid
  };

  /// Whether the transmission has that number of actuators; if not, logs a sentence.
  static bool checkActuatorDimension(const TransmissionInfo& transmission_info,
                                     const unsigned int expected_dim);
  /// Whether the transmission has that number of joints; if not, logs a sentence.
  static bool checkJointDimension(const TransmissionInfo& transmission_info,
                                  const unsigned int expected_dim);

  /// The root element of an XML text; an element without a name if it is not XML.
  static TiXmlElement loadXmlElement(const std::string& element_str);

  // Each of these reads one child of a joint's or actuator's element. A missing one is logged if
  // `required`; an invalid one always. The value is then unchanged.

  /// `<mechanicalReduction>`: a finite number
  static ParseStatus getActuatorReduction(const TiXmlElement& parent_el,
                                          const std::string& actuator_name,
                                          const std::string& transmission_name, bool required,
                                          double& reduction);
  /// `<mechanicalReduction>`: a finite number
  static ParseStatus getJointReduction(const TiXmlElement& parent_el, const std::string& joint_name,
                                       const std::string& transmission_name, bool required,
                                       double& reduction);
  /// `<offset>`: a finite number [rad] or [m]
  static ParseStatus getJointOffset(const TiXmlElement& parent_el, const std::string& joint_name,
                                    const std::string& transmission_name, bool required,
                                    double& offset);
  /// `<role>`: a word
  static ParseStatus getActuatorRole(const TiXmlElement& parent_el,
                                     const std::string& actuator_name,
                                     const std::string& transmission_name, bool required,
                                     std::string& role);
  /// `<role>`: a word
  static ParseStatus getJointRole(const TiXmlElement& parent_el, const std::string& joint_name,
                                  const std::string& transmission_name, bool required,
                                  std::string& role);
};

typedef std::shared_ptr<TransmissionLoader> TransmissionLoaderSharedPtr;

}  // namespace transmission_interface
