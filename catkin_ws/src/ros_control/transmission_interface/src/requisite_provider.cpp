// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <ros/console.h>
#include <transmission_interface/requisite_provider.h>

namespace transmission_interface {

bool RequisiteProvider::findsActuators(const TransmissionInfo& transmission_info,
                                       hardware_interface::RobotHW* robot_hw) {
  ActuatorData states, commands;
  return getActuatorStateData(transmission_info, robot_hw, states) &&
         getActuatorCommandData(transmission_info, robot_hw, commands);
}

bool RequisiteProvider::loadTransmissionMaps(const TransmissionInfo& transmission_info,
                                             TransmissionLoaderData& loader_data,
                                             TransmissionSharedPtr transmission) {
  TransmissionHandleData data;
  data.name = transmission_info.name_;
  data.transmission = transmission;
  try {
    return getActuatorStateData(transmission_info, loader_data.robot_hw, data.act_state_data) &&
           getActuatorCommandData(transmission_info, loader_data.robot_hw, data.act_cmd_data) &&
           getJointStateData(transmission_info, loader_data.raw_joint_data_map,
                             data.jnt_state_data) &&
           getJointCommandData(transmission_info, loader_data.raw_joint_data_map,
                               data.jnt_cmd_data) &&
           registerTransmission(loader_data, data);
  } catch (const TransmissionInterfaceException& error) {
    ROS_ERROR_STREAM("Failed to load transmission '" << transmission_info.name_ << "'. "
                                                     << error.what());
    return false;
  }
}

}  // namespace transmission_interface
