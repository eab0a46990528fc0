// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/motion/command_filter.h"

#include <franka_core/rotations.h>
#include <franka_core/tick.h>
#include <franka_core/transform.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <cstddef>

#include "robot/transforms.h"

namespace franka_sim {

using franka_core::kTick;

namespace {

constexpr double kOff = 1000.0;  // [Hz]

double gainOf(double cutoff) noexcept {
  return cutoff >= kOff ? 1.0 : kTick / (kTick + 1.0 / (2.0 * 3.14159265358979323846 * cutoff));
}

template <std::size_t N>
void smooth(double gain, const std::array<double, N>& input,
            std::array<double, N>& output) noexcept {
  for (std::size_t i = 0; i < N; i++) {
    output[i] = gain >= 1.0 ? input[i] : gain * input[i] + (1.0 - gain) * output[i];
  }
}

void smoothPose(double gain, const Transform& input, Transform& output) noexcept {
  if (gain >= 1.0 || !franka_core::isRigidTransform(input)) {
    output = input;
    return;
  }
  const Eigen::Map<const Eigen::Matrix4d> next(input.data());
  Eigen::Map<Eigen::Matrix4d> last(output.data());
  const Eigen::Quaterniond from(franka_core::orthonormalized(last.topLeftCorner<3, 3>()));
  const Eigen::Quaterniond to(franka_core::orthonormalized(next.topLeftCorner<3, 3>()));
  last.topLeftCorner<3, 3>() = from.slerp(gain, to).toRotationMatrix();
  last.topRightCorner<3, 1>() += gain * (next.topRightCorner<3, 1>() - last.topRightCorner<3, 1>());
}

}  // namespace

bool CommandFilter::set(const franka_core::fci::SetFiltersRequest& cutoffs) noexcept {
  bool active = false;
  for (const double cutoff :
       {cutoffs.joint_position, cutoffs.joint_velocity, cutoffs.cartesian_position,
        cutoffs.cartesian_velocity, cutoffs.controller}) {
    if (!(cutoff >= 1.0 && cutoff <= kOff)) {
      return false;
    }
    active = active || cutoff < kOff;
  }
  cutoffs_ = cutoffs;
  active_ = active;
  return true;
}

void CommandFilter::begin(const franka_core::RobotState& state) noexcept {
  last_ = franka_core::RobotCommand();
  last_.q_c = state.q_d;
  last_.O_T_EE_c = state.O_T_EE_c;
  last_.elbow_c = state.elbow_c;
}

const franka_core::RobotCommand& CommandFilter::apply(
    const franka_core::RobotCommand& command) noexcept {
  if (!active_) {
    return command;
  }
  const franka_core::RobotCommand before = last_;
  last_ = command;
  last_.q_c = before.q_c;
  last_.dq_c = before.dq_c;
  last_.O_T_EE_c = before.O_T_EE_c;
  last_.O_dP_EE_c = before.O_dP_EE_c;
  last_.tau_J_d = before.tau_J_d;
  last_.elbow_c = before.elbow_c;
  smooth(gainOf(cutoffs_.joint_position), command.q_c, last_.q_c);
  smooth(gainOf(cutoffs_.joint_velocity), command.dq_c, last_.dq_c);
  smoothPose(gainOf(cutoffs_.cartesian_position), command.O_T_EE_c, last_.O_T_EE_c);
  smooth(gainOf(cutoffs_.cartesian_velocity), command.O_dP_EE_c, last_.O_dP_EE_c);
  smooth(gainOf(cutoffs_.controller), command.tau_J_d, last_.tau_J_d);
  if (command.valid_elbow) {
    smooth(gainOf(cutoffs_.cartesian_position), command.elbow_c, last_.elbow_c);
    last_.elbow_c[1] = command.elbow_c[1];
  }
  return last_;
}

}  // namespace franka_sim
