// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "command_permission.h"

#include <franka/control_tools.h>
#include <franka_hw/robot_mismatch.h>
#include <ros/console.h>

#include <thread>

namespace franka_hw {

namespace {

/// Why libfranka would not move a robot from this computer with real-time priority, as one
/// sentence; empty if it would.
std::string realtimeRefusal() {
  std::string reason =
      "the running kernel has no real-time support (Debian: package linux-image-rt-amd64).";
  if (franka::hasRealtimeKernel()) {
    // Tried in a separate thread, so that the caller's priority does not change.
    bool possible = false;
    std::thread([&] {
      possible = franka::setCurrentThreadToHighestSchedulerPriority(&reason);
    }).join();
    if (possible) {
      return "";
    }
  }
  return reason +
         " Start with realtime_config:=ignore (parameter realtime_config) to move the robot "
         "without real-time priority.";
}

}  // namespace

CommandPermission::CommandPermission(const std::string& arm_id, const std::string& robot_ip,
                                     const std::array<std::string, 7>& joint_names,
                                     const urdf::Model& description,
                                     const franka::RealtimeConfig& realtime_config)
    : arm_id_(arm_id),
      robot_ip_(robot_ip),
      joint_names_(joint_names),
      description_(description),
      realtime_config_(realtime_config) {}

bool CommandPermission::init(const ros::NodeHandle& nh) {
  nh_ = nh;
  mismatch_parameter_ = nh.resolveName("ignore_robot_mismatch");
  // In a combined node, one parameter in the node's namespace may serve all arms.
  std::string name;
  bool ignore = false;
  if (nh.searchParam("ignore_robot_mismatch", name) && !nh.getParam(name, ignore)) {
    ROS_ERROR_STREAM("FrankaHW: the parameter '" << name << "' is not true or false.");
    return false;
  }
  return true;
}

void CommandPermission::robotConnected(unsigned protocol) {
  protocol_ = protocol;
  const std::string contradiction = mismatch();
  if (!contradiction.empty() && ignoresMismatch()) {
    ROS_WARN_STREAM("FrankaHW: controllers may command '"
                    << arm_id_ << "' at " << robot_ip_
                    << ", because ignore_robot_mismatch is true, but " << contradiction);
  }
  const std::string reason = refusal();
  if (!reason.empty()) {
    ROS_WARN_STREAM("FrankaHW: no controller can command '" << arm_id_ << "' at " << robot_ip_
                                                            << ": " << reason);
  }
}

bool CommandPermission::allows(const std::vector<std::string>& controllers) const {
  const std::string reason = refusal();
  if (reason.empty()) {
    return true;
  }
  std::string names;
  for (const std::string& name : controllers) {
    names += (names.empty() ? "'" : ", '") + name + "'";
  }
  ROS_ERROR_STREAM("FrankaHW: " << names << " cannot command '" << arm_id_ << "': " << reason);
  return false;
}

/// Why controllers must not command the robot, as one sentence; empty if they may.
std::string CommandPermission::refusal() const {
  const std::string contradiction = mismatch();
  if (contradiction.empty() || ignoresMismatch()) {
    return realtime_config_ == franka::RealtimeConfig::kEnforce ? realtimeRefusal() : "";
  }
  return contradiction + " Controllers that command it are refused while the parameter '" +
         mismatch_parameter_ + "' is not true (launch files: ignore_robot_mismatch:=true).";
}

std::string CommandPermission::mismatch() const {
  return robotMismatch(description_, arm_id_, joint_names_, protocol_);
}

bool CommandPermission::ignoresMismatch() const {
  std::string name;
  bool ignore = false;
  return nh_ && nh_->searchParam("ignore_robot_mismatch", name) && nh_->getParam(name, ignore) &&
         ignore;
}

}  // namespace franka_hw
