// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "franka/command_shaping.h"

#include <franka/control_tools.h>
#include <franka/lowpass_filter.h>
#include <franka/rate_limiting.h>
#include <franka_core/finite.h>
#include <franka_core/transform.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace franka {

namespace {

template <std::size_t kSize>
void requireFinite(const std::array<double, kSize>& values, const char* sentence) {
  if (!franka_core::allFinite(values)) {
    throw std::invalid_argument(sentence);
  }
}

bool isFiltered(const Shaping& shaping) { return shaping.cutoff_frequency < kMaxCutoffFrequency; }

template <std::size_t kSize>
void filter(const Shaping& shaping, const std::array<double, kSize>& reference,
            std::array<double, kSize>& values) {
  for (std::size_t i = 0; isFiltered(shaping) && i < kSize; i++) {
    values[i] = lowpassFilter(kDeltaT, values[i], reference[i], shaping.cutoff_frequency);
  }
}

void shapeElbow(const Shaping& shaping, bool commanded, const std::array<double, 2>& elbow,
                const franka_core::RobotState& state, franka_core::RobotCommand& command) {
  command.valid_elbow = commanded;
  command.elbow_c = elbow;
  if (!commanded) {
    return;
  }
  requireFinite(elbow, "libfranka: The commanded elbow is infinite or not a number.");
  double& q3 = command.elbow_c[0];
  const double reference = shaping.start_at_command ? q3 : state.elbow_c[0];
  if (isFiltered(shaping)) {
    q3 = lowpassFilter(kDeltaT, q3, reference, shaping.cutoff_frequency);
  }
  if (shaping.limits != nullptr) {
    const franka_core::DerivativeLimits& limits = shaping.limits->elbow;
    q3 = limitRate(limits.velocity, limits.acceleration, limits.jerk, q3, reference,
                   state.delbow_c[0], state.ddelbow_c[0]);
  }
  if (!isValidElbow(command.elbow_c)) {
    throw std::invalid_argument(
        "libfranka: The commanded elbow is invalid: its second value, the sign of joint 4, must be "
        "+1 or -1.");
  }
}

}  // namespace

void shape(const Shaping& shaping, const Torques& torques, const franka_core::RobotState& state,
           franka_core::RobotCommand& command) {
  requireFinite(torques.tau_J, "libfranka: A commanded torque is infinite or not a number.");
  command.tau_J_d = torques.tau_J;
  filter(shaping, state.tau_J_d, command.tau_J_d);
  if (shaping.limits != nullptr) {
    command.tau_J_d = limitRate(shaping.limits->torque_rate, command.tau_J_d, state.tau_J_d);
  }
}

void shape(const Shaping& shaping, const JointPositions& positions,
           const franka_core::RobotState& state, franka_core::RobotCommand& command) {
  requireFinite(positions.q, "libfranka: A commanded joint position is infinite or not a number.");
  const std::array<double, 7>& reference = shaping.start_at_command ? positions.q : state.q_d;
  command.q_c = positions.q;
  filter(shaping, reference, command.q_c);
  if (shaping.limits != nullptr) {
    command.q_c = shaping.limits->limitPositions(command.q_c, reference, state.dq_d, state.ddq_d);
  }
}

void shape(const Shaping& shaping, const JointVelocities& velocities,
           const franka_core::RobotState& state, franka_core::RobotCommand& command) {
  requireFinite(velocities.dq,
                "libfranka: A commanded joint velocity is infinite or not a number.");
  command.dq_c = velocities.dq;
  filter(shaping, state.dq_d, command.dq_c);
  if (shaping.limits != nullptr) {
    command.dq_c =
        shaping.limits->limitVelocities(state.q_d, command.dq_c, state.dq_d, state.ddq_d);
  }
}

void shape(const Shaping& shaping, const CartesianPose& pose, const franka_core::RobotState& state,
           franka_core::RobotCommand& command) {
  requireFinite(pose.O_T_EE, "libfranka: The commanded pose is infinite or not a number.");
  const std::array<double, 16>& reference = shaping.start_at_command ? pose.O_T_EE : state.O_T_EE_c;
  command.O_T_EE_c = pose.O_T_EE;
  if (isFiltered(shaping)) {
    command.O_T_EE_c =
        cartesianLowpassFilter(kDeltaT, command.O_T_EE_c, reference, shaping.cutoff_frequency);
  }
  // Before the limiter, whose own error would mention rate limiting.
  if (!isHomogeneousTransformation(command.O_T_EE_c)) {
    throw std::invalid_argument(
        "libfranka: The commanded pose is not a homogeneous transformation: " +
        franka_core::transformFault(command.O_T_EE_c) + ".");
  }
  if (shaping.limits != nullptr) {
    const auto& [v, a, j] = shaping.limits->translation;
    const auto& [w, dw, ddw] = shaping.limits->rotation;
    command.O_T_EE_c = limitRate(v, a, j, w, dw, ddw, command.O_T_EE_c, reference, state.O_dP_EE_c,
                                 state.O_ddP_EE_c);
  }
  shapeElbow(shaping, pose.hasElbow(), pose.elbow, state, command);
}

void shape(const Shaping& shaping, const CartesianVelocities& velocities,
           const franka_core::RobotState& state, franka_core::RobotCommand& command) {
  requireFinite(velocities.O_dP_EE,
                "libfranka: A commanded Cartesian velocity is infinite or not a number.");
  command.O_dP_EE_c = velocities.O_dP_EE;
  filter(shaping, state.O_dP_EE_c, command.O_dP_EE_c);
  if (shaping.limits != nullptr) {
    const auto& [v, a, j] = shaping.limits->translation;
    const auto& [w, dw, ddw] = shaping.limits->rotation;
    command.O_dP_EE_c =
        limitRate(v, a, j, w, dw, ddw, command.O_dP_EE_c, state.O_dP_EE_c, state.O_ddP_EE_c);
  }
  shapeElbow(shaping, velocities.hasElbow(), velocities.elbow, state, command);
}

}  // namespace franka
