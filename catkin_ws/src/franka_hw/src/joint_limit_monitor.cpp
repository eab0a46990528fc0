// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "joint_limit_monitor.h"

#include <franka_core/numbers.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace franka_hw {

namespace {

constexpr double kInfinity = std::numeric_limits<double>::infinity();
constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kDegreesPerRadian = 57.29577951308232;
// A joint that was away from its ends for this time is reported again. [s]
constexpr double kTimeAway = 5.0;
constexpr double kLimitCheckPeriod = 0.5;

}  // namespace

JointLimitMonitor::JointLimitMonitor(ros::NodeHandle& nh, const std::string& arm_id,
                                     const std::array<std::string, 7>& joint_names,
                                     const urdf::Model& description)
    : arm_id_(arm_id), joint_names_(joint_names) {
  for (std::size_t i = 0; i < joint_names_.size(); i++) {
    const urdf::JointConstSharedPtr joint = description.getJoint(joint_names_[i]);
    ranges_[i] = {-kInfinity, kInfinity};
    if (joint && joint->limits) {
      ranges_[i] = {joint->limits->lower, joint->limits->upper};
    }
    near_limit_[i] = kNan;
  }
  timer_ = nh.createWallTimer(ros::WallDuration(kLimitCheckPeriod), [this](const auto& event) {
    const std::string text = makeWarning(event.current_real);
    if (!text.empty()) {
      ROS_WARN_STREAM(text);
    }
  });
}

void JointLimitMonitor::check(const std::array<double, 7>& q, double threshold) noexcept {
  for (std::size_t i = 0; i < q.size(); i++) {
    const bool near = distanceToLimit(i, q[i]) < threshold;
    near_limit_[i].store(near ? q[i] : kNan, std::memory_order_relaxed);
  }
}

double JointLimitMonitor::distanceToLimit(std::size_t joint, double q) const noexcept {
  return std::min(std::abs(q - ranges_[joint][0]), std::abs(q - ranges_[joint][1]));
}

std::string JointLimitMonitor::makeWarning(ros::WallTime now) {
  using franka_core::fixedText;
  std::string joints;
  bool has_new_joint = false;
  for (std::size_t i = 0; i < joint_names_.size(); i++) {
    const double q = near_limit_[i].load(std::memory_order_relaxed);
    if (std::isnan(q)) {
      continue;
    }
    has_new_joint = has_new_joint || (now - last_near_[i]).toSec() > kTimeAway;
    last_near_[i] = now;
    joints += "\n\t" + joint_names_[i] + ": " +
              fixedText(distanceToLimit(i, q) * kDegreesPerRadian, 6) +
              " degrees to the end of its range (q = " + fixedText(q, 6) + ", limits " +
              fixedText(ranges_[i][0], 6) + " and " + fixedText(ranges_[i][1], 6) + " rad)";
  }
  return has_new_joint ? "FrankaHW: joints of '" + arm_id_ + "' near their limits:" + joints : "";
}

}  // namespace franka_hw
