// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/viewer/pace_meter.h"

#include <franka_core/numbers.h>

namespace franka_sim {

namespace {

constexpr double kPaceSpan = 0.5;  ///< over which the pace is measured [s]

}  // namespace

std::string PaceMeter::text(double time) {
  const Clock::time_point now = Clock::now();
  const double passed = std::chrono::duration<double>(now - begin_).count();
  if (!started_ || time < time_ || passed > 4 * kPaceSpan) {
    text_.clear();
  } else if (passed < kPaceSpan) {
    return text_;
  } else {
    const double pace = (time - time_) / passed;
    text_ = pace > 0 ? franka_core::fixedText(pace, 2) + " x real time" : "time stands still";
  }
  started_ = true;
  begin_ = now;
  time_ = time;
  return text_;
}

}  // namespace franka_sim
