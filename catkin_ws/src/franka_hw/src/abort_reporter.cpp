// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "abort_reporter.h"

#include <ros/console.h>
#include <ros/file_log.h>
#include <std_msgs/String.h>

#include <ctime>
#include <fstream>

namespace franka_hw {

AbortReporter::AbortReporter(ros::NodeHandle& nh, const std::string& arm_id)
    : publisher_(nh.advertise<std_msgs::String>("abort", 1, true)), arm_id_(arm_id) {
  std::string name;
  if (!nh.searchParam("abort_log_directory", name) || !nh.getParam(name, directory_)) {
    directory_ = ros::file_log::getLogDirectory();
  }
}

void AbortReporter::report(const std::string& what, const std::vector<franka::Record>& log,
                           unsigned version) {
  std_msgs::String message;
  message.data = what;
  if (!log.empty()) {
    const std::string file = save(what, log, version);
    message.data +=
        file.empty() ? "\nThe log of the motion could not be written to '" + directory_ + "'."
                     : "\nThe last " + std::to_string(log.size()) + " states and commands: " + file;
  }
  ROS_ERROR_STREAM(arm_id_ << ": " << message.data);
  publisher_.publish(message);
}

std::string AbortReporter::save(const std::string& what, const std::vector<franka::Record>& log,
                                unsigned version) const {
  const std::time_t now = std::time(nullptr);
  char stamp[32];
  std::tm local{};
  ::localtime_r(&now, &local);
  std::strftime(stamp, sizeof(stamp), "%Y-%m-%d_%H-%M-%S", &local);
  // The robot's own time distinguishes two aborts in the same second.
  const std::string path = directory_ + "/franka_abort_" + arm_id_ + "_" + stamp + "_" +
                           std::to_string(log.back().state.time.toMSec());
  std::ofstream file(path + ".csv");
  file << franka::logToCSV(log);
  std::ofstream reason(path + ".txt");
  reason << what << "\n";
  if (version > 0) {
    reason << "Robot's protocol version: " << version << "\n";
  }
  return file.good() ? path + ".csv" : "";
}

}  // namespace franka_hw
