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

/// Creates the transmissions of a robot description with their handles: those of the joints,
/// registered with the robot, and those that map between joints and actuators, registered with the
/// robot's transmissions. The robot must have registered its actuators before.
///
/// Types of transmissions are plugins of base TransmissionLoader, interfaces of joints are plugins
/// of base RequisiteProvider. The loader owns all results and must outlive their use. For start-up.
/// Called by one thread at a time. Not real-time safe.
class TransmissionInterfaceLoader {
 public:
  /// @param robot_hw, robot_transmissions must outlive the loader
  /// @throws std::invalid_argument if one of them is null
  /// @throws pluginlib::PluginlibException if plugins cannot be searched
  TransmissionInterfaceLoader(hardware_interface::RobotHW* robot_hw,
                              RobotTransmissions* robot_transmissions);

  /// Loads all transmissions of a robot description that TransmissionParser accepts. If one of them
  /// cannot be created, none is. One with an earlier name replaces that one, with a warning.
  /// @param urdf_string the XML text itself
  /// @returns false, with a sentence in the log, on errors and without transmissions.
  bool load(const std::string& urdf_string);
  bool load(const std::vector<TransmissionInfo>& transmission_info_vec);
  bool load(const TransmissionInfo& transmission_info);

  /// The results so far: values and interfaces of the joints, and the transmissions.
  TransmissionLoaderData* getData() { return &loader_data_; }

 private:
  /// A transmission ready for registration.
  struct Plan {
    TransmissionInfo info;
    TransmissionSharedPtr transmission;
    std::vector<RequisiteProviderPtr> providers;
  };

  bool makePlan(const TransmissionInfo& info, Plan& plan);
  TransmissionSharedPtr createTransmission(const TransmissionInfo& info);
  bool createProviders(const TransmissionInfo& info, std::vector<RequisiteProviderPtr>& providers);
  bool carryOut(const Plan& plan);

  // Declared before the objects whose code it loaded.
  pluginlib::ClassLoader<TransmissionLoader> transmission_class_loader_;
  pluginlib::ClassLoader<RequisiteProvider> req_provider_loader_;
  hardware_interface::RobotHW* robot_hw_ptr_;
  RobotTransmissions* robot_transmissions_ptr_;
  std::set<std::string> loaded_;
  TransmissionLoaderData loader_data_;
};

}  // namespace transmission_interface
