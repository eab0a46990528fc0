// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/sine_sweep.h"

#include <cmath>
#include <initializer_list>

namespace control_toolbox {

bool SineSweep::init(double start_freq, double end_freq, double duration, double amplitude) {
  for (const double number : {start_freq, end_freq, duration, amplitude}) {
    if (!std::isfinite(number) || number <= 0.0) {
      return false;
    }
  }
  start_ = 2.0 * M_PI * start_freq;
  growth_ = std::log(end_freq / start_freq) / duration;
  duration_ = duration;
  amplitude_ = amplitude;
  return true;
}

double SineSweep::update(double time) {
  if (!(time >= 0.0 && time <= duration_)) {
    return 0.0;
  }
  // The integral of start_ exp(growth_ t), also for a constant frequency.
  const double angle = start_ * (growth_ == 0.0 ? time : std::expm1(growth_ * time) / growth_);
  return amplitude_ * std::sin(angle);
}

}  // namespace control_toolbox
