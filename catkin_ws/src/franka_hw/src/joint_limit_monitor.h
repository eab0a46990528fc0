// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/node_handle.h>
#include <ros/wall_timer.h>
#include <urdf/model.h>

#include <array>
#include <atomic>
#include <string>

namespace franka_hw {

/// Warns about joints of one arm that are near an end of their range in the description.
///
/// The thread of the control cycle calls check(), which records the joints; a timer of ROS prints
/// them when another one has come near, until this is destroyed.
class JointLimitMonitor {
 public:
  /// @param nh serves the timer @param description joints that are missing there are not checked
  JointLimitMonitor(ros::NodeHandle& nh, const std::string& arm_id,
                    const std::array<std::string, 7>& joint_names, const urdf::Model& description);

  /// Records the joints that are nearer than `threshold` [rad] to an end of their range.
  /// Real-time safe. @param q positions [rad]
  void check(const std::array<double, 7>& q, double threshold) noexcept;

  /// The timer calls it. Not real-time safe.
  /// @returns a sentence that names all joints near an end if one of them was not near for the last
  /// five seconds; otherwise an empty string @param now later than in the last call
  std::string makeWarning(ros::WallTime now);

 private:
  double distanceToLimit(std::size_t joint, double q) const noexcept;

  const std::string arm_id_;
  const std::array<std::string, 7> joint_names_;
  std::array<std::array<double, 2>, 7> ranges_;    // [rad]; infinite without limits
  std::array<std::atomic<double>, 7> near_limit_;  // position of a joint near its end, else NaN
  std::array<ros::WallTime, 7> last_near_{};       // used by makeWarning()
  ros::WallTimer timer_;
};

}  // namespace franka_hw
