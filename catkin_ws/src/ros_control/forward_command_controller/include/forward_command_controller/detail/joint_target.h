// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/console.h>
#include <ros/node_handle.h>
#include <urdf/model.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace forward_command_controller {
namespace detail {

/// Range of a joint in the robot's description. [rad], or [m] for prismatic joints.
struct JointRange {
  bool limited{false};     ///< whether lower and upper count
  bool revolute{false};    ///< turns within limits
  bool continuous{false};  ///< turns without limits
  double lower{0.0};
  double upper{0.0};

  JointRange() = default;
  explicit JointRange(const urdf::Joint& joint)
      : revolute(joint.type == urdf::Joint::REVOLUTE),
        continuous(joint.type == urdf::Joint::CONTINUOUS) {
    limited = joint.limits && (revolute || joint.type == urdf::Joint::PRISMATIC);
    if (limited) {
      lower = std::min(joint.limits->lower, joint.limits->upper);
      upper = std::max(joint.limits->lower, joint.limits->upper);
    }
  }

  /// The nearest allowed position. Real-time safe.
  double clamped(double position) const {
    return limited ? std::max(lower, std::min(position, upper)) : position;
  }

  /// The displacement from one position to another within the limits. A revolute joint takes the
  /// shortest turn that its limits allow; one outside its limits moves straight to `to`, which
  /// leads back inside. `to` must be within the limits. Real-time safe.
  double way(double from, double to) const {
    const double straight = to - from;
    if (!continuous && !(revolute && limited)) {
      return straight;
    }
    const double shortest = std::remainder(straight, 2.0 * M_PI);
    if (continuous) {
      return shortest;
    }
    if (!isAllowed(from)) {
      return straight;
    }
    // Otherwise the opposite turn, which ends at `to` or between `from` and `to`.
    return isAllowed(from + shortest) ? shortest : shortest - std::copysign(2.0 * M_PI, shortest);
  }

 private:
  bool isAllowed(double position) const { return position >= lower && position <= upper; }
};

/// Finds a joint in the robot's description (parameter `robot_description`, here or in a namespace
/// above).
/// @return false, with an error in the log, without a description or such a joint in it.
inline bool findJoint(const ros::NodeHandle& node, const std::string& name,
                      urdf::JointConstSharedPtr& joint) {
  urdf::Model model;
  if (!model.initParamWithNodeHandle("robot_description", node)) {
    ROS_ERROR(
        "Failed to parse urdf file: the parameter 'robot_description', looked for from %s up, is "
        "missing or no robot's description.",
        node.getNamespace().c_str());
    return false;
  }
  joint = model.getJoint(name);
  if (!joint) {
    ROS_ERROR("Could not find joint '%s' in urdf (robot '%s').", name.c_str(),
              model.getName().c_str());
    return false;
  }
  return true;
}

}  // namespace detail
}  // namespace forward_command_controller
