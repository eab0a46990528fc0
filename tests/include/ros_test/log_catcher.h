// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <ros/console.h>

#include <mutex>
#include <string>
#include <utility>
#include <vector>

namespace ros_test {

/// Collects the log lines of this process during its lifetime. Thread-safe.
class LogCatcher : public ros::console::LogAppender {
 public:
  LogCatcher() { ros::console::register_appender(this); }
  ~LogCatcher() override { ros::console::deregister_appender(this); }
  LogCatcher(const LogCatcher&) = delete;
  LogCatcher& operator=(const LogCatcher&) = delete;

  void log(ros::console::Level level, const char* text, const char* /*file*/,
           const char* /*function*/, int /*line*/) override {
    const std::lock_guard<std::mutex> lock(mutex_);
    lines_.emplace_back(level, text);
  }

  /// The lines logged so far, of this level or above.
  std::string text(ros::console::Level level = ros::console::levels::Debug) const {
    const std::lock_guard<std::mutex> lock(mutex_);
    std::string all;
    for (const auto& [of, line] : lines_) {
      all += of >= level ? line + "\n" : "";
    }
    return all;
  }

 private:
  mutable std::mutex mutex_;
  std::vector<std::pair<ros::console::Level, std::string>> lines_;
};

}  // namespace ros_test
