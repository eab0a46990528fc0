// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <controller_interface/controller_base.h>
#include <hardware_interface/interface_resources.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/robot_hw.h>
#include <ros/console.h>

#include <initializer_list>
#include <sstream>
#include <string>
#include <vector>

namespace controller_interface {
namespace internal {

// Calls for each type of a pack stand in the list of an std::initializer_list, which is evaluated
// from left to right: C++14 has no fold expressions.

/// All elements in one string, each between prefix and suffix, with a delimiter between them.
template <class T>
std::string enumerateElements(const T& elements, const std::string& delimiter,
                              const std::string& prefix, const std::string& suffix) {
  std::ostringstream out;
  bool first = true;
  for (const auto& element : elements) {
    out << (first ? "" : delimiter) << prefix << element << suffix;
    first = false;
  }
  return out.str();
}

/// Whether the robot has the interface T; if not, logs the robot's interfaces.
template <class T>
bool hasInterface(hardware_interface::RobotHW* robot_hw) {
  if (robot_hw->get<T>() != nullptr) {
    return true;
  }
  ROS_ERROR_STREAM("This controller requires a hardware interface of type '"
                   << hardware_interface::internal::demangledTypeName<T>()
                   << "', but is not exposed by the robot. Available interfaces in robot:\n"
                   << enumerateElements(robot_hw->getNames(), "\n", "- '", "'"));
  return false;
}

/// Whether the robot has all interfaces; only the first missing one is logged.
template <typename... T>
bool hasInterfaces(hardware_interface::RobotHW* robot_hw) {
  bool all = true;
  static_cast<void>(std::initializer_list<bool>{(all = all && hasInterface<T>(robot_hw))...});
  return all;
}

template <class T>
void clearClaimsOf(hardware_interface::RobotHW* robot_hw) {
  T* hw = robot_hw->get<T>();
  if (hw != nullptr) {
    hw->clearClaims();
  }
}

/// Clears the claims of the robot's interfaces among these.
template <typename... T>
void clearClaims(hardware_interface::RobotHW* robot_hw) {
  static_cast<void>(std::initializer_list<int>{(clearClaimsOf<T>(robot_hw), 0)...});
}

template <class T>
void extractInterface(hardware_interface::RobotHW* robot_hw_in,
                      hardware_interface::RobotHW* robot_hw_out) {
  T* hw = robot_hw_in->get<T>();
  if (hw != nullptr) {
    robot_hw_out->registerInterface(hw);
  }
}

/// Registers those interfaces that the first robot has with the second one.
template <typename... T>
void extractInterfaceResources(hardware_interface::RobotHW* robot_hw_in,
                               hardware_interface::RobotHW* robot_hw_out) {
  static_cast<void>(
      std::initializer_list<int>{(extractInterface<T>(robot_hw_in, robot_hw_out), 0)...});
}

template <class T>
void appendClaims(hardware_interface::RobotHW* robot_hw,
                  ControllerBase::ClaimedResources& claimed_resources) {
  T* hw = robot_hw->get<T>();
  if (hw != nullptr) {
    claimed_resources.emplace_back(hardware_interface::internal::demangledTypeName<T>(),
                                   hw->getClaims());
  }
}

/// The claims on the robot's interfaces among these, in the order of the template arguments;
/// interfaces without claims are listed too.
template <typename... T>
void populateClaimedResources(hardware_interface::RobotHW* robot_hw,
                              ControllerBase::ClaimedResources& claimed_resources) {
  claimed_resources.clear();
  static_cast<void>(
      std::initializer_list<int>{(appendClaims<T>(robot_hw, claimed_resources), 0)...});
}

}  // namespace internal
}  // namespace controller_interface
