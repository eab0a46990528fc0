// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <transmission_interface/requisite_provider.h>

namespace transmission_interface {

/// Provides JointStateInterface: states of joints, mapped from those of the actuators. Joints have
/// an absolute position or a torque sensor if all actuators have one and the transmission can map
/// it.
class JointStateInterfaceProvider : public RequisiteProvider {
 public:
  bool updateJointInterfaces(const TransmissionInfo& transmission_info,
                             hardware_interface::RobotHW* robot_hw,
                             JointInterfaces& joint_interfaces,
                             RawJointDataMap& raw_joint_data_map) override;

 protected:
  bool getJointStateData(const TransmissionInfo& transmission_info,
                         const RawJointDataMap& raw_joint_data_map,
                         JointData& jnt_state_data) override;
  bool getJointCommandData(const TransmissionInfo& /*transmission_info*/,
                           const RawJointDataMap& /*raw_joint_data_map*/,
                           JointData& /*jnt_cmd_data*/) override {
    return true;
  }
  bool getActuatorStateData(const TransmissionInfo& transmission_info,
                            hardware_interface::RobotHW* robot_hw,
                            ActuatorData& act_state_data) override;
  bool getActuatorCommandData(const TransmissionInfo& /*transmission_info*/,
                              hardware_interface::RobotHW* /*robot_hw*/,
                              ActuatorData& /*act_cmd_data*/) override {
    return true;
  }
  bool registerTransmission(TransmissionLoaderData& loader_data,
                            TransmissionHandleData& handle_data) override;
};

}  // namespace transmission_interface
