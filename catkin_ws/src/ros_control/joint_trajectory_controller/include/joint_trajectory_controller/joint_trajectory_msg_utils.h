// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <boost_bind_compat/global_placeholders.h>
#include <ros/time.h>
#include <trajectory_msgs/JointTrajectory.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace joint_trajectory_controller {
namespace internal {

/// Start of a message: its stamp, or `time` if it has none.
inline ros::Time startTime(const trajectory_msgs::JointTrajectory& msg, const ros::Time& time) {
  return msg.header.stamp.isZero() ? time : msg.header.stamp;
}

/// Index of each element of t1 in t2; empty unless each exists, without duplicates.
template <class T>
std::vector<unsigned int> mapping(const T& t1, const T& t2) {
  std::vector<unsigned int> result;
  for (const auto& element : t1) {
    const auto found = std::find(t2.begin(), t2.end(), element);
    const auto index = static_cast<unsigned int>(found - t2.begin());
    if (found == t2.end() || std::find(result.begin(), result.end(), index) != result.end()) {
      return {};
    }
    result.push_back(index);
  }
  return result;
}

inline bool isFinite(const std::vector<double>& values) {
  return std::all_of(values.begin(), values.end(),
                     [](double value) { return std::isfinite(value); });
}

}  // namespace internal

/// Whether each quantity of a point is empty or has `joint_dim` elements.
inline bool isValid(const trajectory_msgs::JointTrajectoryPoint& point, unsigned int joint_dim) {
  const auto fits = [joint_dim](const std::vector<double>& values) {
    return values.empty() || values.size() == joint_dim;
  };
  return fits(point.positions) && fits(point.velocities) && fits(point.accelerations);
}

/// Whether that holds for all points of a message and its joints.
inline bool isValid(const trajectory_msgs::JointTrajectory& msg) {
  const auto joint_dim = static_cast<unsigned int>(msg.joint_names.size());
  return std::all_of(msg.points.begin(), msg.points.end(),
                     [joint_dim](const trajectory_msgs::JointTrajectoryPoint& p) {
                       return isValid(p, joint_dim);
                     });
}

/// Whether each point is later than the one before.
inline bool isTimeStrictlyIncreasing(const trajectory_msgs::JointTrajectory& msg) {
  return std::adjacent_find(msg.points.begin(), msg.points.end(),
                            [](const trajectory_msgs::JointTrajectoryPoint& a,
                               const trajectory_msgs::JointTrajectoryPoint& b) {
                              return a.time_from_start >= b.time_from_start;
                            }) == msg.points.end();
}

/// The last point at or before a time; the end if all are later.
inline std::vector<trajectory_msgs::JointTrajectoryPoint>::const_iterator findPoint(
    const trajectory_msgs::JointTrajectory& msg, const ros::Time& time) {
  const ros::Duration elapsed = time - internal::startTime(msg, time);
  const auto later = std::upper_bound(
      msg.points.begin(), msg.points.end(), elapsed,
      [](const ros::Duration& at, const trajectory_msgs::JointTrajectoryPoint& point) {
        return at < point.time_from_start;
      });
  return later == msg.points.begin() ? msg.points.end() : later - 1;
}

}  // namespace joint_trajectory_controller
