// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <hardware_interface/actuator_state_interface.h>
#include <transmission_interface/detail/provider_tools.h>
#include <transmission_interface/joint_state_interface_provider.h>

namespace transmission_interface {

using hardware_interface::ActuatorStateHandle;
using hardware_interface::ActuatorStateInterface;
using hardware_interface::JointStateHandle;
using hardware_interface::JointStateInterface;

namespace {

JointStateHandle makeHandle(const std::string& name, const RawJointData& raw) {
  if (raw.hasAbsolutePosition && raw.hasTorqueSensor) {
    return JointStateHandle(name, &raw.position, &raw.velocity, &raw.effort, &raw.absolute_position,
                            &raw.torque_sensor);
  }
  if (raw.hasAbsolutePosition) {
    return JointStateHandle(name, &raw.position, &raw.velocity, &raw.effort,
                            &raw.absolute_position);
  }
  if (raw.hasTorqueSensor) {
    return JointStateHandle(name, &raw.position, &raw.velocity, &raw.effort, &raw.torque_sensor,
                            true);
  }
  return JointStateHandle(name, &raw.position, &raw.velocity, &raw.effort);
}

// Transmissions use writable pointers in either direction. Handles and the map of raw data are
// const for their structure, not for their values.
double* writable(const double* value) { return const_cast<double*>(value); }

}  // namespace

bool JointStateInterfaceProvider::updateJointInterfaces(const TransmissionInfo& transmission_info,
                                                        hardware_interface::RobotHW* robot_hw,
                                                        JointInterfaces& joint_interfaces,
                                                        RawJointDataMap& raw_joint_data_map) {
  JointStateInterface& states =
      internal::provided(*robot_hw, joint_interfaces.joint_state_interface);
  for (const JointInfo& joint : transmission_info.joints_) {
    const RawJointData& raw = raw_joint_data_map[joint.name_];
    if (!internal::hasResource(joint.name_, states)) {
      states.registerHandle(makeHandle(joint.name_, raw));
    }
  }
  internal::refresh(*robot_hw, joint_interfaces.joint_state_interface);
  return true;
}

bool JointStateInterfaceProvider::getJointStateData(const TransmissionInfo& transmission_info,
                                                    const RawJointDataMap& raw_joint_data_map,
                                                    JointData& jnt_state_data) {
  for (const JointInfo& joint : transmission_info.joints_) {
    const RawJointData& raw = raw_joint_data_map.at(joint.name_);
    jnt_state_data.position.push_back(writable(&raw.position));
    jnt_state_data.velocity.push_back(writable(&raw.velocity));
    jnt_state_data.effort.push_back(writable(&raw.effort));
    if (raw.hasAbsolutePosition) {
      jnt_state_data.absolute_position.push_back(writable(&raw.absolute_position));
    }
    if (raw.hasTorqueSensor) {
      jnt_state_data.torque_sensor.push_back(writable(&raw.torque_sensor));
    }
  }
  return true;
}

bool JointStateInterfaceProvider::getActuatorStateData(const TransmissionInfo& transmission_info,
                                                       hardware_interface::RobotHW* robot_hw,
                                                       ActuatorData& act_state_data) {
  std::vector<ActuatorStateHandle> handles;
  if (!internal::getActuatorHandles<ActuatorStateInterface>(transmission_info, *robot_hw,
                                                            handles)) {
    return false;
  }
  bool all_absolute = true;
  bool all_torque = true;
  for (const ActuatorStateHandle& handle : handles) {
    act_state_data.position.push_back(writable(handle.getPositionPtr()));
    act_state_data.velocity.push_back(writable(handle.getVelocityPtr()));
    act_state_data.effort.push_back(writable(handle.getEffortPtr()));
    all_absolute = all_absolute && handle.hasAbsolutePosition();
    all_torque = all_torque && handle.hasTorqueSensor();
  }
  for (const ActuatorStateHandle& handle : handles) {
    if (all_absolute) {
      act_state_data.absolute_position.push_back(writable(handle.getAbsolutePositionPtr()));
    }
    if (all_torque) {
      act_state_data.torque_sensor.push_back(writable(handle.getTorqueSensorPtr()));
    }
  }
  return true;
}

bool JointStateInterfaceProvider::registerTransmission(TransmissionLoaderData& loader_data,
                                                       TransmissionHandleData& handle_data) {
  internal::addMap(*loader_data.robot_transmissions,
                   loader_data.forward_transmission_interfaces.act_to_jnt_state, handle_data.name,
                   handle_data.transmission.get(), handle_data.act_state_data,
                   handle_data.jnt_state_data);
  return true;
}

}  // namespace transmission_interface
