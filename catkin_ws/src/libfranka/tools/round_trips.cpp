// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "round_trips.h"

#include <franka/exception.h>
#include <franka_core/fci/protocol.h>

#include <chrono>

namespace franka_info {

namespace {
// Short enough for statistics, long enough not to load the connection.
constexpr std::chrono::milliseconds kPause{25};
}  // namespace

RoundTrips::RoundTrips(franka::Robot& robot, const franka::RobotState& state) : robot_(robot) {
  choose(state);
  if (ask_) {
    thread_ = std::thread([this] { repeat(); });
  }
}

RoundTrips::~RoundTrips() { stop(); }

void RoundTrips::choose(const franka::RobotState& state) {
  if (franka_core::fci::hasFiltersAndWalls(robot_.serverVersion())) {
    command_ = "getVirtualWall";
    ask_ = [this] { robot_.getVirtualWall(0); };
  } else if (franka_core::fci::hasRobotModel(robot_.serverVersion())) {
    command_ = "getRobotModel";
    ask_ = [this] { robot_.getRobotModel(); };
  } else if (state.robot_mode == franka::RobotMode::kIdle) {
    command_ = "setK";
    ask_ = [this, EE_T_K = state.EE_T_K] { robot_.setK(EE_T_K); };
  } else {
    error_ = "this system has no command that changes nothing, and the robot is not idle";
  }
}

void RoundTrips::repeat() {
  using Clock = std::chrono::steady_clock;
  do {
    const Clock::time_point begin = Clock::now();
    try {
      ask_();
    } catch (const franka::CommandException&) {
      // A refusal is also an answer.
    } catch (const std::exception& error) {
      error_ = error.what();
      return;
    }
    times_.push_back(std::chrono::duration<double, std::milli>(Clock::now() - begin).count());
  } while (!isToStop());
}

bool RoundTrips::isToStop() {
  std::unique_lock<std::mutex> lock(mutex_);
  return changed_.wait_for(lock, kPause, [this] { return stopping_; });
}

void RoundTrips::stop() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) {
    thread_.join();
  }
}

}  // namespace franka_info
