// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_example_controllers/joint_wall.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace franka_example_controllers {

namespace {

double positive(double value, const char* name) {
  if (value < 0.0) {
    ROS_WARN_STREAM("JointWall: " << name << " is " << value << ", but must not be negative; using "
                                  << -value << ".");
  }
  return std::abs(value);
}

}  // namespace

JointWall::JointWall(double soft_upper_joint_position_limit, double soft_lower_joint_position_limit,
                     double PD_zone_width, double D_zone_width, double PD_zone_stiffness,
                     double PD_zone_damping, double D_zone_damping)
    : upper_(soft_upper_joint_position_limit),
      lower_(soft_lower_joint_position_limit),
      pd_width_(positive(PD_zone_width, "PD_zone_width")),
      d_width_(positive(D_zone_width, "D_zone_width")),
      stiffness_(positive(PD_zone_stiffness, "PD_zone_stiffness")),
      pd_damping_(positive(PD_zone_damping, "PD_zone_damping")),
      d_damping_(positive(D_zone_damping, "D_zone_damping")) {}

void JointWall::reset() {
  begun_ = false;
  scale_ = 1.0;
}

double JointWall::depth(double q) const noexcept {
  const double width = pd_width_ + d_width_;
  const double distance = std::min(upper_ - q, q - lower_);
  return width > 0.0 ? std::clamp(1.0 - distance / width, 0.0, 1.0) : 0.0;
}

void JointWall::begin(double q) {
  if (q < lower_ || q > upper_) {
    throw std::runtime_error("JointWall: a joint stands at " + franka_core::numberText(q) +
                             " rad, outside its soft limits " + franka_core::numberText(lower_) +
                             " and " + franka_core::numberText(upper_) +
                             ". Guide it back between them first.");
  }
  begun_ = true;
  scale_ = 1.0 - depth(q);
}

double JointWall::computeTorque(double q, double dq) {
  if (!begun_) {
    begin(q);
  }
  // The zones only grow, as far as the joint has left them.
  scale_ = std::max(scale_, 1.0 - depth(q));
  const double pd = scale_ * pd_width_;
  const double zone = scale_ * (pd_width_ + d_width_);

  if (q > upper_ - pd) {
    return -pd_damping_ * dq + stiffness_ * (upper_ - pd - q);
  }
  if (q < lower_ + pd) {
    return -pd_damping_ * dq + stiffness_ * (lower_ + pd - q);
  }
  return q > upper_ - zone || q < lower_ + zone ? -d_damping_ * dq : 0.0;
}

}  // namespace franka_example_controllers
