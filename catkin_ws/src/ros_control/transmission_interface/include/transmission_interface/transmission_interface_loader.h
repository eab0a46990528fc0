// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/robot_hw.h>
#include <transmission_interface/requisite_provider.h>
#include <transmission_interface/robot_transmissions.h>
#include <transmission_interface/transmission_info.h>
#include <transmission_interface/transmission_loader.h>

#include <memory>
#include <pluginlib/class_loader.hpp>
#include <set>
#include <string>
#include <vector>

namespace transmission_interface {

/// Makes the transmissions of a robot description and all that belongs to them: handles of the
/// joints, registered with the robot, and handles that map between joints and actuators, registered
/// with the robot's transmissions. The robot must have registered its actuators before.
///
/// Types of transmissions are plugins of base TransmissionLoader, interfaces of joints are plugins
/// of base RequisiteProvider. Everything made belongs to the loader, which therefore must live as
/// long as it is used. For start-up: not thread-safe, not for the control loop.
class TransmissionInterfaceLoader {
 public:
  /// @param robot_hw, robot_transmissions must outlive the loader
  /// @throws std::invalid_argument when one of them is null
  /// @throws pluginlib::PluginlibException when plugins cannot be searched for
  TransmissionInterfaceLoader(hardware_interface::RobotHW* robot_hw,
                              RobotTransmissions* robot_transmissions);

  /// Loads all transmissions of a robot description that TransmissionParser accepts. If one of them
  /// cannot be made, none is. One whose name was loaded before replaces that one, with a warning.
  /// @param urdf_string the XML text itself
  /// @returns false, with a sentence in the log, on errors and when there is no transmission.
  bool load(const std::string& urdf_string);
  bool load(const std::vector<TransmissionInfo>& transmission_info_vec);
  bool load(const TransmissionInfo& transmission_info);

  /// What has been made up to now: values and interfaces of the joints, and the transmissions.
  TransmissionLoaderData* getData() { return &loader_data_; }

 private:
  /// A transmission that can be registered.
  struct Plan {
    TransmissionInfo info;
    TransmissionSharedPtr transmission;
    std::vector<RequisiteProviderPtr> providers;
  };

  bool makePlan(const TransmissionInfo& info, Plan& plan);
  TransmissionSharedPtr createTransmission(const TransmissionInfo& info);
  bool createProviders(const TransmissionInfo& info, std::vector<RequisiteProviderPtr>& providers);
  bool carryOut(const Plan& plan);

  // Before all that they made the code of.
  pluginlib::ClassLoader<TransmissionLoader> transmission_class_loader_;
  pluginlib::ClassLoader<RequisiteProvider> req_provider_loader_;
  hardware_interface::RobotHW* robot_hw_ptr_;
  RobotTransmissions* robot_transmissions_ptr_;
  std::set<std::string> loaded_;
  TransmissionLoaderData loader_data_;
};

}  // namespace transmission_interface
