// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/console.h>
#include <transmission_interface/differential_transmission_loader.h>
#include <transmission_interface/four_bar_linkage_transmission_loader.h>
#include <transmission_interface/simple_transmission_loader.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

namespace transmission_interface {

namespace {

/// Creates a transmission; an exception of its constructor is logged.
template <class T, class... Args>
TransmissionSharedPtr make(const TransmissionInfo& info, const Args&... args) {
  try {
    return std::make_shared<T>(args...);
  } catch (const TransmissionInterfaceException& error) {
    ROS_ERROR_STREAM("Failed to construct transmission '" << info.name_ << "' of type '"
                                                          << info.type_ << "'. " << error.what());
    return nullptr;
  }
}

}  // namespace

TransmissionSharedPtr SimpleTransmissionLoader::load(const TransmissionInfo& transmission_info) {
  const TransmissionInfo& info = transmission_info;
  if (!checkActuatorDimension(info, 1) || !checkJointDimension(info, 1)) {
    return nullptr;
  }
  const ActuatorInfo& actuator = info.actuators_.front();
  const JointInfo& joint = info.joints_.front();
  double reduction = 0.0;
  double offset = 0.0;
  if (getActuatorReduction(loadXmlElement(actuator.xml_element_), actuator.name_, info.name_, true,
                           reduction) != SUCCESS ||
      getJointOffset(loadXmlElement(joint.xml_element_), joint.name_, info.name_, false, offset) ==
          BAD_TYPE) {
    return nullptr;
  }
  return make<SimpleTransmission>(info, reduction, offset);
}

TransmissionSharedPtr DifferentialTransmissionLoader::load(
    const TransmissionInfo& transmission_info) {
  Config config;
  if (!readConfig(transmission_info, config)) {
    return nullptr;
  }
  return make<DifferentialTransmission>(transmission_info, config.actuator_reduction,
                                        config.joint_reduction, config.ignores_absolute_encoders,
                                        config.joint_offset);
}

TransmissionSharedPtr FourBarLinkageTransmissionLoader::load(
    const TransmissionInfo& transmission_info) {
  Config config;
  if (!readConfig(transmission_info, config)) {
    return nullptr;
  }
  return make<FourBarLinkageTransmission>(transmission_info, config.actuator_reduction,
                                          config.joint_reduction, config.joint_offset);
}

}  // namespace transmission_interface

PLUGINLIB_EXPORT_CLASS(transmission_interface::SimpleTransmissionLoader,
                       transmission_interface::TransmissionLoader)
PLUGINLIB_EXPORT_CLASS(transmission_interface::DifferentialTransmissionLoader,
                       transmission_interface::TransmissionLoader)
PLUGINLIB_EXPORT_CLASS(transmission_interface::FourBarLinkageTransmissionLoader,
                       transmission_interface::TransmissionLoader)
