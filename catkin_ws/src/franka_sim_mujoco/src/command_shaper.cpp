// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/lowpass_filter.h>
#include <franka/rate_limiting.h>
#include <franka_core/finite.h>
#include <franka_core/joint_limiter.h>
#include <franka_core/motion_limits.h>
#include <franka_core/transform.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim_mujoco/command_shaper.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <functional>

namespace franka_sim_mujoco {

namespace {

using franka_hw::ControlMode;
using franka_sim::kTick;
using Joints = std::array<double, 7>;

// Margin to every limit, as in libfranka's limiter, so that rounding never exceeds a limit.
constexpr double kMargin = franka::kLimitEps;

Joints withMargin(Joints limits) noexcept {
  for (double& limit : limits) {
    limit -= kMargin;
  }
  return limits;
}

// Velocities have the margin of the robot's own client: that of a Panda also keeps what the
// acceleration adds while packets are lost.
double velocityWithMargin(const franka_core::MotionLimits& limits, double velocity,
                          double acceleration) noexcept {
  return limits.position_velocity
             ? velocity - kMargin
             : franka::rate_limiting_detail::withMargin(velocity, acceleration);
}

bool isFiltered(const ShapingOptions& options) noexcept {
  return options.cutoff_frequency < franka::kMaxCutoffFrequency;
}

template <std::size_t N>
void filter(const ShapingOptions& options, const std::array<double, N>& last,
            std::array<double, N>& values) {
  if (!isFiltered(options)) {
    return;
  }
  for (std::size_t i = 0; i < N; ++i) {
    values[i] = franka::lowpassFilter(kTick, values[i], last[i], options.cutoff_frequency);
  }
}

franka_core::JointVelocityRange rangeOf(const franka_core::MotionLimits& limits,
                                        const Joints& q) noexcept {
  if (limits.position_velocity) {
    return franka_core::rangeAt(
        franka_core::followable(limits.velocity_near_ends, withMargin(limits.arm.ddq),
                                withMargin(limits.arm.dddq), kMargin),
        q);
  }
  franka_core::JointVelocityRange range{};
  for (std::size_t i = 0; i < range.highest.size(); ++i) {
    range.highest[i] = velocityWithMargin(limits, limits.arm.dq[i], limits.arm.ddq[i]);
  }
  std::transform(range.highest.begin(), range.highest.end(), range.lowest.begin(), std::negate<>());
  return range;
}

void limitVelocities(const franka_core::RobotState& state, const franka_core::MotionLimits& limits,
                     Joints& dq) noexcept {
  dq =
      franka_core::limitVelocities(rangeOf(limits, state.q_d), withMargin(limits.arm.ddq),
                                   withMargin(limits.arm.dddq), dq, state.dq_d, state.ddq_d, kTick);
}

Joints shapePositions(const ShapingOptions& options, Joints q, const franka_core::RobotState& state,
                      const franka_core::MotionLimits& limits) {
  filter(options, state.q_d, q);
  if (options.rate_limiting) {
    Joints dq;
    for (std::size_t i = 0; i < q.size(); ++i) {
      dq[i] = (q[i] - state.q_d[i]) / kTick;
    }
    limitVelocities(state, limits, dq);
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = state.q_d[i] + dq[i] * kTick;
    }
  }
  return q;
}

Joints shapeVelocities(const ShapingOptions& options, Joints dq,
                       const franka_core::RobotState& state,
                       const franka_core::MotionLimits& limits) {
  filter(options, state.dq_d, dq);
  if (options.rate_limiting) {
    limitVelocities(state, limits, dq);
  }
  return dq;
}

std::array<double, 16> shapePose(const ShapingOptions& options, std::array<double, 16> pose,
                                 const franka_core::RobotState& state,
                                 const franka_core::MotionLimits& limits) {
  if (isFiltered(options)) {
    pose = franka::cartesianLowpassFilter(kTick, pose, state.O_T_EE_c, options.cutoff_frequency);
  }
  // As in the client's loop: a pose that is not a transform after the filter goes to the robot,
  // which checks it.
  if (options.rate_limiting && franka_core::isHomogeneousTransformation(pose)) {
    const auto& [v, a, j] = limits.arm.translation;
    const auto& [w, dw, ddw] = limits.arm.rotation;
    pose = franka::limitRate(velocityWithMargin(limits, v, a), a - kMargin, j - kMargin,
                             velocityWithMargin(limits, w, dw), dw - kMargin, ddw - kMargin, pose,
                             state.O_T_EE_c, state.O_dP_EE_c, state.O_ddP_EE_c);
  }
  return pose;
}

std::array<double, 6> shapeTwist(const ShapingOptions& options, std::array<double, 6> twist,
                                 const franka_core::RobotState& state,
                                 const franka_core::MotionLimits& limits) {
  filter(options, state.O_dP_EE_c, twist);
  if (options.rate_limiting) {
    const auto& [v, a, j] = limits.arm.translation;
    const auto& [w, dw, ddw] = limits.arm.rotation;
    twist = franka::limitRate(velocityWithMargin(limits, v, a), a - kMargin, j - kMargin,
                              velocityWithMargin(limits, w, dw), dw - kMargin, ddw - kMargin, twist,
                              state.O_dP_EE_c, state.O_ddP_EE_c);
  }
  return twist;
}

void setElbow(const std::array<double, 2>& elbow, franka_core::RobotCommand& command) noexcept {
  command.valid_elbow = elbow[0] != 0.0 || elbow[1] != 0.0;
  command.elbow_c = elbow;
}

void shapeElbow(const ShapingOptions& options, const std::array<double, 2>& elbow,
                const franka_core::RobotState& state, const franka_core::MotionLimits& limits,
                franka_core::RobotCommand& command) {
  if (!command.valid_elbow || !franka_core::allFinite(elbow)) {
    return;
  }
  double& q3 = command.elbow_c[0];
  if (isFiltered(options)) {
    q3 = franka::lowpassFilter(kTick, q3, state.elbow_c[0], options.cutoff_frequency);
  }
  if (options.rate_limiting) {
    const auto& [v, a, j] = limits.arm.elbow;
    q3 = franka::limitRate(velocityWithMargin(limits, v, a), a - kMargin, j - kMargin, q3,
                           state.elbow_c[0], state.delbow_c[0], state.ddelbow_c[0]);
  }
}

Joints shapeTorques(const ShapingOptions& options, Joints torque,
                    const franka_core::RobotState& state, const franka_core::MotionLimits& limits) {
  filter(options, state.tau_J_d, torque);
  return options.rate_limiting
             ? franka::limitRate(withMargin(limits.arm.dtau), torque, state.tau_J_d)
             : torque;
}

// The controllers' command, with one function per kind. Values that are not finite pass unchanged.
void shapeAll(const ShapingOptions& options, ControlMode mode, const ArmCommands& desired,
              const franka_core::RobotState& state, const franka_core::MotionLimits& limits,
              franka_core::RobotCommand& command) {
  if (contains(mode, ControlMode::JointTorque) && options.torques &&
      franka_core::allFinite(desired.torque)) {
    command.tau_J_d = shapeTorques(options, desired.torque, state, limits);
  }
  if (contains(mode, ControlMode::JointPosition) && franka_core::allFinite(desired.position)) {
    command.q_c = shapePositions(options, desired.position, state, limits);
  }
  if (contains(mode, ControlMode::JointVelocity) && franka_core::allFinite(desired.velocity)) {
    command.dq_c = shapeVelocities(options, desired.velocity, state, limits);
  }
  if (contains(mode, ControlMode::CartesianPose)) {
    if (franka_core::allFinite(desired.pose)) {
      command.O_T_EE_c = shapePose(options, desired.pose, state, limits);
    }
    shapeElbow(options, desired.pose_elbow, state, limits, command);
  }
  if (contains(mode, ControlMode::CartesianVelocity)) {
    if (franka_core::allFinite(desired.twist)) {
      command.O_dP_EE_c = shapeTwist(options, desired.twist, state, limits);
    }
    shapeElbow(options, desired.twist_elbow, state, limits, command);
  }
}

franka_core::RobotCommand unshaped(ControlMode mode, const ArmCommands& desired) noexcept {
  franka_core::RobotCommand command;
  if (contains(mode, ControlMode::JointTorque)) {
    command.tau_J_d = desired.torque;
  }
  if (contains(mode, ControlMode::JointPosition)) {
    command.q_c = desired.position;
  }
  if (contains(mode, ControlMode::JointVelocity)) {
    command.dq_c = desired.velocity;
  }
  if (contains(mode, ControlMode::CartesianPose)) {
    command.O_T_EE_c = desired.pose;
    setElbow(desired.pose_elbow, command);
  }
  if (contains(mode, ControlMode::CartesianVelocity)) {
    command.O_dP_EE_c = desired.twist;
    setElbow(desired.twist_elbow, command);
  }
  return command;
}

}  // namespace

franka_core::RobotCommand shapeCommand(const ShapingOptions& options, ControlMode mode,
                                       const ArmCommands& desired,
                                       const franka_core::RobotState& state,
                                       const franka_core::MotionLimits& limits) noexcept {
  franka_core::RobotCommand command = unshaped(mode, desired);
  command.message_id = state.message_id;
  try {
    shapeAll(options, mode, desired, state, limits, command);
  } catch (...) {
    // libfranka's functions throw for values that are checked here before; another libfranka may
    // check more.
    command = unshaped(mode, desired);
    command.message_id = state.message_id;
  }
  return command;
}

}  // namespace franka_sim_mujoco
