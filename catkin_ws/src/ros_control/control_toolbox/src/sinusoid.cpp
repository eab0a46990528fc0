// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "control_toolbox/sinusoid.h"

#include <cmath>

namespace control_toolbox {

Sinusoid::Sinusoid(double offset, double amplitude, double frequency, double phase)
    : offset_(offset),
      amplitude_(amplitude),
      angular_frequency_(2.0 * M_PI * frequency),
      phase_(phase) {}

double Sinusoid::update(double time, double& qd, double& qdd) {
  const double angle = angular_frequency_ * time + phase_;
  const double swing = amplitude_ * std::sin(angle);
  qd = angular_frequency_ * amplitude_ * std::cos(angle);
  qdd = -angular_frequency_ * angular_frequency_ * swing;
  return offset_ + swing;
}

}  // namespace control_toolbox
