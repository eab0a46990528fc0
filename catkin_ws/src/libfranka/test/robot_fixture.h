// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/exception.h>
#include <franka/extensions.h>
#include <franka/robot.h>
#include <gtest/gtest.h>

#include <memory>
#include <string>

#include "fake_robot.h"

namespace franka_test {

using franka_core::fci::Command;
using franka_core::fci::Status;

constexpr std::array<std::uint16_t, 8> kVersions{3, 4, 5, 6, 7, 8, 9, 10};
// Commands.
constexpr std::array<double, 7> kTorques{1, -2, 3, -4, 0.5, -0.25, 0.125};
constexpr std::array<double, 7> kJoints{0.1, -0.9, 0.2, -2.2, 0.3, 1.5, 0.7};
constexpr std::array<double, 6> kTwist{0.01, -0.02, 0.03, 0.1, -0.2, 0.3};
constexpr std::array<double, 16> kPose{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1};
constexpr const char* kClosed = "libfranka: server closed connection";

/// Sets timeouts, and restores those before at its end.
class ScopedTimeouts {
 public:
  explicit ScopedTimeouts(const franka::Timeouts& timeouts) : before_(franka::timeouts()) {
    franka::setTimeouts(timeouts);
  }
  ~ScopedTimeouts() { franka::setTimeouts(before_); }
  ScopedTimeouts(const ScopedTimeouts&) = delete;
  ScopedTimeouts& operator=(const ScopedTimeouts&) = delete;

 private:
  franka::Timeouts before_;
};

/// Timeouts for a robot that answers at once or never. They are long enough for a busy machine.
class ShortTimeouts : public ScopedTimeouts {
 public:
  ShortTimeouts() : ScopedTimeouts(timeouts()) {}

 private:
  static franka::Timeouts timeouts() {
    franka::Timeouts timeouts;
    timeouts.connect = std::chrono::milliseconds(2000);
    timeouts.state = timeouts.silence = std::chrono::milliseconds(800);
    timeouts.command = timeouts.long_command = std::chrono::milliseconds(1500);
    return timeouts;
  }
};

inline std::unique_ptr<franka::Robot> connect(const FakeRobot& robot, std::size_t log_size = 50) {
  return std::make_unique<franka::Robot>(robot.address(), franka::RealtimeConfig::kIgnore,
                                         log_size);
}

/// Runs a function that throws an exception of this type, and returns its text.
template <typename Exception, typename Function>
std::string textOf(Function function) {
  try {
    function();
  } catch (const Exception& error) {
    return error.what();
  } catch (const std::exception& error) {
    ADD_FAILURE() << "another exception: " << error.what();
    return "";
  }
  ADD_FAILURE() << "no exception";
  return "";
}

inline bool startsWith(const std::string& text, const std::string& begin) {
  return text.compare(0, begin.size(), begin) == 0;
}

inline std::string versionName(const ::testing::TestParamInfo<std::uint16_t>& info) {
  return "Version" + std::to_string(info.param);
}

/// Tests for robots of every version.
class EveryVersion : public ::testing::TestWithParam<std::uint16_t> {
 protected:
  FakeRobot fake{GetParam()};
};

}  // namespace franka_test
