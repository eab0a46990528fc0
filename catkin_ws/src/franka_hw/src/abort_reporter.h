// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/log.h>
#include <ros/node_handle.h>
#include <ros/publisher.h>

#include <string>
#include <vector>

namespace franka_hw {

/// Reports the last abort of a motion: on the latched topic `abort` (std_msgs/String) and, if there
/// is a log, in a CSV file, with the reason in a text file beside it: franka_plot shows both.
/// Called outside the control loop. Not real-time safe.
class AbortReporter {
 public:
  /// The files are written to the directory of the parameter `abort_log_directory`, which is
  /// searched for from the namespace of the robot upwards, or else to ROS's log directory.
  /// @param nh namespace of the robot @param arm_id part of the file names
  AbortReporter(ros::NodeHandle& nh, const std::string& arm_id);

  /// @param what a sentence for the user @param log the last states and commands, may be empty
  /// @param version of the robot's protocol, which selects the limits; 0: not known
  void report(const std::string& what, const std::vector<franka::Record>& log,
              unsigned version = 0);

 private:
  std::string save(const std::string& what, const std::vector<franka::Record>& log,
                   unsigned version) const;

  ros::Publisher publisher_;
  std::string arm_id_;
  std::string directory_;
};

}  // namespace franka_hw
