// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <transmission_interface/robot_transmissions.h>
#include <transmission_interface/transmission.h>
#include <transmission_interface/transmission_info.h>
#include <transmission_interface/transmission_interface.h>

#include <limits>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace transmission_interface {

/// The values of one joint; NaN until written. Units: [rad] or [m], [rad/s] or [m/s], [Nm] or [N].
struct RawJointData {
  double position{std::numeric_limits<double>::quiet_NaN()};           ///< [rad] or [m]
  double velocity{std::numeric_limits<double>::quiet_NaN()};           ///< [rad/s] or [m/s]
  double effort{std::numeric_limits<double>::quiet_NaN()};             ///< [Nm] or [N]
  double position_cmd{std::numeric_limits<double>::quiet_NaN()};       ///< [rad] or [m]
  double velocity_cmd{std::numeric_limits<double>::quiet_NaN()};       ///< [rad/s] or [m/s]
  double effort_cmd{std::numeric_limits<double>::quiet_NaN()};         ///< [Nm] or [N]
  double absolute_position{std::numeric_limits<double>::quiet_NaN()};  ///< [rad] or [m]
  double torque_sensor{std::numeric_limits<double>::quiet_NaN()};      ///< [Nm]
  bool hasAbsolutePosition{false};  ///< whether it has this sensor
  bool hasTorqueSensor{false};      ///< whether it has this sensor
};

/// Data of joints by their names.
typedef std::map<std::string, RawJointData> RawJointDataMap;

/// Interfaces of joints, for robots without one of that type.
struct JointInterfaces {
  hardware_interface::JointStateInterface joint_state_interface;        ///< states
  hardware_interface::PositionJointInterface position_joint_interface;  ///< position commands
  hardware_interface::VelocityJointInterface velocity_joint_interface;  ///< velocity commands
  hardware_interface::EffortJointInterface effort_joint_interface;      ///< effort commands
};

/// From actuator states to joints, and from joint commands to actuators.
struct ForwardTransmissionInterfaces {
  ActuatorToJointStateInterface act_to_jnt_state;       ///< states
  JointToActuatorPositionInterface jnt_to_act_pos_cmd;  ///< positions
  JointToActuatorVelocityInterface jnt_to_act_vel_cmd;  ///< velocities
  JointToActuatorEffortInterface jnt_to_act_eff_cmd;    ///< efforts
};

/// The opposite, for simulations that move joints instead of actuators.
struct InverseTransmissionInterfaces {
  JointToActuatorStateInterface jnt_to_act_state;       ///< states
  ActuatorToJointPositionInterface act_to_jnt_pos_cmd;  ///< positions
  ActuatorToJointVelocityInterface act_to_jnt_vel_cmd;  ///< velocities
  ActuatorToJointEffortInterface act_to_jnt_eff_cmd;    ///< efforts
};

/// All results of a TransmissionInterfaceLoader. Addresses are stable.
struct TransmissionLoaderData {
  hardware_interface::RobotHW* robot_hw{nullptr};                 ///< whose resources are used
  RobotTransmissions* robot_transmissions{nullptr};               ///< by their interfaces
  JointInterfaces joint_interfaces;                               ///< of the joints
  RawJointDataMap raw_joint_data_map;                             ///< of the joints
  ForwardTransmissionInterfaces forward_transmission_interfaces;  ///< of the actuators
  InverseTransmissionInterfaces inverse_transmission_interfaces;  ///< of the joints
  /// In the order of loading, once for each interface of its joints.
  std::vector<TransmissionSharedPtr> transmission_data;
};

/// Base of the plugins that provide one interface of the joints: the joints' handles, and the maps
/// between these and the actuators. A provider has no state; it runs at start-up, and logs errors.
class RequisiteProvider {
 public:
  virtual ~RequisiteProvider() = default;

  /// Registers handles for the joints of a transmission with the robot.
  /// @param[in,out] raw_joint_data_map gets the values of the handles
  /// @returns false, with a sentence, on failure.
  virtual bool updateJointInterfaces(const TransmissionInfo& transmission_info,
                                     hardware_interface::RobotHW* robot_hw,
                                     JointInterfaces& joint_interfaces,
                                     RawJointDataMap& raw_joint_data_map) = 0;

  /// Registers the maps of a transmission. Call it after updateJointInterfaces.
  /// @returns false, with a sentence, on failure.
  bool loadTransmissionMaps(const TransmissionInfo& transmission_info,
                            TransmissionLoaderData& loader_data,
                            TransmissionSharedPtr transmission);

  /// Whether the robot has all actuators that the provider needs; if not, logs a sentence. Changes
  /// nothing.
  bool findsActuators(const TransmissionInfo& transmission_info,
                      hardware_interface::RobotHW* robot_hw);

 protected:
  /// Content of a handle on a transmission.
  struct TransmissionHandleData {
    std::string name;
    ActuatorData act_state_data;
    ActuatorData act_cmd_data;
    JointData jnt_state_data;
    JointData jnt_cmd_data;
    TransmissionSharedPtr transmission;
  };

  virtual bool getJointStateData(const TransmissionInfo& transmission_info,
                                 const RawJointDataMap& raw_joint_data_map,
                                 JointData& jnt_state_data) = 0;
  virtual bool getJointCommandData(const TransmissionInfo& transmission_info,
                                   const RawJointDataMap& raw_joint_data_map,
                                   JointData& jnt_cmd_data) = 0;
  virtual bool getActuatorStateData(const TransmissionInfo& transmission_info,
                                    hardware_interface::RobotHW* robot_hw,
                                    ActuatorData& act_state_data) = 0;
  virtual bool getActuatorCommandData(const TransmissionInfo& transmission_info,
                                      hardware_interface::RobotHW* robot_hw,
                                      ActuatorData& act_cmd_data) = 0;
  /// @throws TransmissionInterfaceException for data that do not match the transmission.
  virtual bool registerTransmission(TransmissionLoaderData& loader_data,
                                    TransmissionHandleData& handle_data) = 0;
};

typedef std::shared_ptr<RequisiteProvider> RequisiteProviderPtr;

}  // namespace transmission_interface
