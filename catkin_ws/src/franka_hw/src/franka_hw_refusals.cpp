// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// FrankaHW: the reasons to refuse controllers.
#include <franka/control_tools.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/robot_mismatch.h>
#include <ros/console.h>

#include <thread>

namespace franka_hw {

std::string FrankaHW::refusalOfMotions() const {
  const std::string contradiction = mismatch();
  if (contradiction.empty() || ignoresMismatch()) {
    return realtimeRefusal();
  }
  return contradiction + " Controllers that command it are refused while the parameter '" +
         mismatch_parameter_ + "' is not true (launch files: ignore_robot_mismatch:=true).";
}

std::string FrankaHW::mismatch() const {
  return robotMismatch(urdf_model_, arm_id_, joint_names_, protocol_);
}

bool FrankaHW::ignoresMismatch() const {
  return get_ignore_robot_mismatch_ && get_ignore_robot_mismatch_();
}

std::string FrankaHW::realtimeRefusal() const {
  if (!enforcesRealtime()) {
    return "";
  }
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

void FrankaHW::warnOfRefusals() const {
  const std::string contradiction = mismatch();
  if (!contradiction.empty() && ignoresMismatch()) {
    ROS_WARN_STREAM("FrankaHW: controllers may command '"
                    << arm_id_ << "' at " << robot_ip_
                    << ", because ignore_robot_mismatch is true, but " << contradiction);
  }
  const std::string refusal = refusalOfMotions();
  if (!refusal.empty()) {
    ROS_WARN_STREAM("FrankaHW: no controller can command '" << arm_id_ << "' at " << robot_ip_
                                                            << ": " << refusal);
  }
}

}  // namespace franka_hw
