// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/control_types.h>
#include <ros/node_handle.h>
#include <urdf/model.h>

#include <array>
#include <atomic>
#include <optional>
#include <string>
#include <vector>

namespace franka_hw {

/// Decides whether controllers may command an arm. They may not if the arm's parameters contradict
/// its description or the connected robot (robot_mismatch.h), unless the parameter
/// `ignore_robot_mismatch` is true (bool, default false; searched for from the namespace of the arm
/// upwards); nor if libfranka would not move the robot without real-time priority.
///
/// Threads: the one that connects calls robotConnected(), the one that switches controllers
/// allows(). Not real-time safe.
class CommandPermission {
 public:
  /// The parameters of the arm are referred to; they outlive this.
  /// @param robot_ip for messages @param realtime_config whether real-time priority is enforced
  CommandPermission(const std::string& arm_id, const std::string& robot_ip,
                    const std::array<std::string, 7>& joint_names, const urdf::Model& description,
                    const franka::RealtimeConfig& realtime_config);

  /// Checks the parameter, which is read again by every decision, so that the user can set it after
  /// a refusal and try again. @returns false, after logging the reason, if it is not true or false
  bool init(const ros::NodeHandle& nh);

  /// Sets the protocol version of the robot, and warns about controllers that would be refused.
  void robotConnected(unsigned protocol);

  /// Whether these controllers may command the robot. @returns false, after logging the reason, if
  /// not
  bool allows(const std::vector<std::string>& controllers) const;

 private:
  std::string refusal() const;
  std::string mismatch() const;
  bool ignoresMismatch() const;

  const std::string& arm_id_;
  const std::string& robot_ip_;
  const std::array<std::string, 7>& joint_names_;
  const urdf::Model& description_;
  const franka::RealtimeConfig& realtime_config_;
  std::atomic<unsigned> protocol_{0};
  std::optional<ros::NodeHandle> nh_;
  std::string mismatch_parameter_;  // resolved name of ignore_robot_mismatch
};

}  // namespace franka_hw
