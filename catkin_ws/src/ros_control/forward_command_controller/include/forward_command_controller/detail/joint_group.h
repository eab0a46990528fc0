// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/joint_command_interface.h>
#include <realtime_tools/realtime_buffer.h>
#include <ros/console.h>
#include <ros/node_handle.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <string>
#include <vector>

namespace forward_command_controller {
namespace detail {

typedef realtime_tools::RealtimeBuffer<std::vector<double>> CommandBuffer;

/// Reads the parameter `joints`: at least one name, no duplicates. @return false, with an error in
/// the log, otherwise.
inline bool readJointNames(const ros::NodeHandle& node, std::vector<std::string>& names) {
  const char* const where = node.getNamespace().c_str();
  if (!node.getParam("joints", names)) {
    ROS_ERROR("Failed to getParam 'joints' (namespace: %s): it must be a list of joint names.",
              where);
    return false;
  }
  if (names.empty()) {
    ROS_ERROR("List of joint names is empty (namespace: %s).", where);
    return false;
  }
  if (std::set<std::string>(names.begin(), names.end()).size() != names.size()) {
    ROS_ERROR("A joint stands twice in the parameter 'joints' (namespace: %s).", where);
    return false;
  }
  return true;
}

/// Sizes all copies of the buffer, so that the control loop never allocates. Call before the buffer
/// is used.
inline void prepareBuffer(std::size_t joints, CommandBuffer& buffer) {
  constexpr int kCopies = 3;
  for (int i = 0; i < kCopies; ++i) {
    buffer.writeFromNonRT(std::vector<double>(joints, 0.0));
    buffer.readFromRT();
  }
}

/// Stores a command for all joints, or refuses it with an error and keeps the last one.
inline void acceptCommands(const std::vector<double>& data, const std::vector<std::string>& names,
                           CommandBuffer& buffer) {
  if (data.size() != names.size()) {
    ROS_ERROR_THROTTLE(
        1.0, "Dimension of command (%zu) does not match number of joints (%zu)! Not executing!",
        data.size(), names.size());
    return;
  }
  const auto bad = std::find_if(data.begin(), data.end(),
                                [](double command) { return !std::isfinite(command); });
  if (bad != data.end()) {
    ROS_ERROR_STREAM_THROTTLE(1.0, "The command for joint '"
                                       << names[static_cast<std::size_t>(bad - data.begin())]
                                       << "' is " << *bad
                                       << ", which is not a finite number. Not executing for any "
                                          "joint; the last command stays.");
    return;
  }
  buffer.writeFromNonRT(data);
}

}  // namespace detail
}  // namespace forward_command_controller
