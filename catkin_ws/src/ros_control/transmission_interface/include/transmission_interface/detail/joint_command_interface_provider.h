// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/actuator_command_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <transmission_interface/detail/provider_tools.h>
#include <transmission_interface/joint_state_interface_provider.h>

#include <string>
#include <vector>

namespace transmission_interface {
namespace internal {

// Differences between the kinds of commands.

struct PositionCommand {
  typedef hardware_interface::PositionJointInterface JointInterface;
  typedef hardware_interface::PositionActuatorInterface ActuatorInterface;
  static constexpr auto kRaw = &RawJointData::position_cmd;
  static constexpr auto kJoints = &JointData::position;
  static constexpr auto kActuators = &ActuatorData::position;
  static constexpr auto kInterface = &JointInterfaces::position_joint_interface;
  static constexpr auto kForward = &ForwardTransmissionInterfaces::jnt_to_act_pos_cmd;
  static constexpr auto kInverse = &InverseTransmissionInterfaces::act_to_jnt_pos_cmd;
};

struct VelocityCommand {
  typedef hardware_interface::VelocityJointInterface JointInterface;
  typedef hardware_interface::VelocityActuatorInterface ActuatorInterface;
  static constexpr auto kRaw = &RawJointData::velocity_cmd;
  static constexpr auto kJoints = &JointData::velocity;
  static constexpr auto kActuators = &ActuatorData::velocity;
  static constexpr auto kInterface = &JointInterfaces::velocity_joint_interface;
  static constexpr auto kForward = &ForwardTransmissionInterfaces::jnt_to_act_vel_cmd;
  static constexpr auto kInverse = &InverseTransmissionInterfaces::act_to_jnt_vel_cmd;
};

struct EffortCommand {
  typedef hardware_interface::EffortJointInterface JointInterface;
  typedef hardware_interface::EffortActuatorInterface ActuatorInterface;
  static constexpr auto kRaw = &RawJointData::effort_cmd;
  static constexpr auto kJoints = &JointData::effort;
  static constexpr auto kActuators = &ActuatorData::effort;
  static constexpr auto kInterface = &JointInterfaces::effort_joint_interface;
  static constexpr auto kForward = &ForwardTransmissionInterfaces::jnt_to_act_eff_cmd;
  static constexpr auto kInverse = &InverseTransmissionInterfaces::act_to_jnt_eff_cmd;
};

/// Provides an interface of joint commands, mapped to the actuators, and the joints' states.
template <class Command>
class JointCommandInterfaceProvider : public JointStateInterfaceProvider {
 public:
  bool updateJointInterfaces(const TransmissionInfo& transmission_info,
                             hardware_interface::RobotHW* robot_hw,
                             JointInterfaces& joint_interfaces,
                             RawJointDataMap& raw_joint_data_map) override {
    if (!JointStateInterfaceProvider::updateJointInterfaces(transmission_info, robot_hw,
                                                            joint_interfaces, raw_joint_data_map)) {
      return false;
    }
    auto* states = robot_hw->get<hardware_interface::JointStateInterface>();
    auto& own = joint_interfaces.*Command::kInterface;
    auto& commands = provided(*robot_hw, own);
    for (const JointInfo& joint : transmission_info.joints_) {
      if (!hasResource(joint.name_, commands)) {
        commands.registerHandle(hardware_interface::JointHandle(
            states->getHandle(joint.name_), &(raw_joint_data_map[joint.name_].*Command::kRaw)));
      }
    }
    refresh(*robot_hw, own);
    return true;
  }

 protected:
  bool getJointCommandData(const TransmissionInfo& transmission_info,
                           const RawJointDataMap& raw_joint_data_map,
                           JointData& jnt_cmd_data) override {
    for (const JointInfo& joint : transmission_info.joints_) {
      const double& command = raw_joint_data_map.at(joint.name_).*Command::kRaw;
      // The map is const for its structure, not for its values.
      (jnt_cmd_data.*Command::kJoints).push_back(const_cast<double*>(&command));
    }
    return true;
  }

  bool getActuatorCommandData(const TransmissionInfo& transmission_info,
                              hardware_interface::RobotHW* robot_hw,
                              ActuatorData& act_cmd_data) override {
    std::vector<hardware_interface::ActuatorHandle> handles;
    if (!getActuatorHandles<typename Command::ActuatorInterface>(transmission_info, *robot_hw,
                                                                 handles)) {
      return false;
    }
    for (hardware_interface::ActuatorHandle& handle : handles) {
      (act_cmd_data.*Command::kActuators).push_back(handle.getCommandPtr());
    }
    return true;
  }

  bool registerTransmission(TransmissionLoaderData& loader_data,
                            TransmissionHandleData& handle_data) override {
    if (!JointStateInterfaceProvider::registerTransmission(loader_data, handle_data)) {
      return false;
    }
    addMap(*loader_data.robot_transmissions,
           loader_data.forward_transmission_interfaces.*Command::kForward, handle_data.name,
           handle_data.transmission.get(), handle_data.act_cmd_data, handle_data.jnt_cmd_data);
    return true;
  }
};

/// Also registers the maps of the opposite direction.
template <class Command>
class BiDirectionalInterfaceProvider : public JointCommandInterfaceProvider<Command> {
 protected:
  using typename RequisiteProvider::TransmissionHandleData;

  bool registerTransmission(TransmissionLoaderData& loader_data,
                            TransmissionHandleData& handle_data) override {
    if (!JointCommandInterfaceProvider<Command>::registerTransmission(loader_data, handle_data)) {
      return false;
    }
    InverseTransmissionInterfaces& inverse = loader_data.inverse_transmission_interfaces;
    addMap(*loader_data.robot_transmissions, inverse.jnt_to_act_state, handle_data.name,
           handle_data.transmission.get(), handle_data.act_state_data, handle_data.jnt_state_data);
    addMap(*loader_data.robot_transmissions, inverse.*Command::kInverse, handle_data.name,
           handle_data.transmission.get(), handle_data.act_cmd_data, handle_data.jnt_cmd_data);
    return true;
  }
};

}  // namespace internal
}  // namespace transmission_interface
