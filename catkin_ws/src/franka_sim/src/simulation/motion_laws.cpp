// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/rotations.h>
#include <franka_core/smooth_step.h>
#include <franka_core/tick.h>
#include <franka_sim/simulation/motion_laws.h>

#include <algorithm>

#include "robot/laws/control_laws.h"

namespace franka_sim {

using franka_core::kTick;
using franka_core::RobotState;

namespace {

// Initial stiffnesses, chosen here: soft enough to touch things, stiff enough to reach a target.
constexpr std::array<double, 7> kJointSpring{600, 600, 600, 600, 250, 150, 50};  // [Nm/rad]
constexpr std::array<double, 6> kCartesianSpring{2000, 2000, 2000, 100, 100, 100};
constexpr double kNullspaceSpring = 10.0;  // [Nm/rad]

// A client of the robot sees velocities with their noise, the robot itself without.
std::array<double, 7> coriolisOf(const RobotState& state, const ControlUnitParameters& unit,
                                 const franka_core::ArmDynamics& dynamics) noexcept {
  if (unit.sensors.dq_noise == std::array<double, 7>{}) {
    return dynamics.coriolis;
  }
  return unit.model.coriolis(state.q, state.dq, {state.m_total, state.F_x_Ctotal, state.I_total});
}

// Of a motion of this duration, after this time.
double shareOf(double time, double duration, TargetMotion motion) {
  if (duration <= 0.0) {
    return 1.0;
  }
  return motion == TargetMotion::kLinear ? time / duration
                                         : franka_core::smoothStep(time / duration);
}

}  // namespace

JointLaw::JointLaw(const RobotState& state) noexcept
    : stiffness_(kJointSpring), from_(state.q_d), to_(state.q_d), desired_(state.q_d) {}

void JointLaw::setTarget(const std::array<double, 7>& q, double duration,
                         TargetMotion motion) noexcept {
  from_ = desired_;
  to_ = q;
  time_ = 0.0;
  duration_ = duration;
  motion_ = motion;
}

std::array<double, 7> JointLaw::torque(const RobotState& state, const ControlUnitParameters& unit,
                                       const franka_core::ArmDynamics& dynamics) noexcept {
  time_ = std::min(time_ + kTick, duration_);
  const double share = shareOf(time_, duration_, motion_);
  std::array<double, 7> dq_d;
  for (std::size_t i = 0; i < desired_.size(); i++) {
    const double next = from_[i] + share * (to_[i] - from_[i]);
    dq_d[i] = duration_ > 0.0 ? (next - desired_[i]) / kTick : 0.0;
    desired_[i] = next;
  }
  return JointImpedance(stiffness_, unit.rotor_inertia)
      .torque(desired_, dq_d, state.q, state.dq, dynamics.mass, coriolisOf(state, unit, dynamics));
}

CartesianLaw::CartesianLaw(const RobotState& state) noexcept
    : stiffness_(kCartesianSpring),
      nullspace_stiffness_(kNullspaceSpring),
      from_(state.O_T_EE_d),
      to_(state.O_T_EE_d),
      desired_(state.O_T_EE_d),
      q_(state.q_d) {}

void CartesianLaw::setTarget(const std::array<double, 16>& O_T_EE, double duration,
                             TargetMotion motion) noexcept {
  from_ = desired_;
  to_ = O_T_EE;
  time_ = 0.0;
  duration_ = duration;
  motion_ = motion;
}

void CartesianLaw::advance() noexcept {
  time_ = std::min(time_ + kTick, duration_);
  const double share = shareOf(time_, duration_, motion_);
  const Eigen::Map<const Eigen::Matrix4d> from(from_.data()), to(to_.data());
  Eigen::Map<Eigen::Matrix4d> desired(desired_.data());
  const Eigen::Matrix3d turn = from.topLeftCorner<3, 3>().transpose() * to.topLeftCorner<3, 3>();
  desired.topLeftCorner<3, 3>() =
      from.topLeftCorner<3, 3>() * franka_core::rotationFrom(share * franka_core::vectorOf(turn));
  desired.topRightCorner<3, 1>() =
      from.topRightCorner<3, 1>() +
      share * (to.topRightCorner<3, 1>() - from.topRightCorner<3, 1>());
}

std::array<double, 7> CartesianLaw::torque(const RobotState& state,
                                           const ControlUnitParameters& unit,
                                           const franka_core::ArmDynamics& dynamics) noexcept {
  const std::array<double, 16> before = desired_;
  advance();
  CartesianImpedanceInput input{};
  input.O_T_EE_d = desired_;
  input.O_T_EE = state.O_T_EE;
  input.EE_T_K = state.EE_T_K;
  if (duration_ > 0.0) {  // otherwise the target jumps, with no velocity on its way
    Eigen::Map<Eigen::Matrix<double, 6, 1>>(input.O_dP_EE_d.data()) =
        franka_core::twistBetween(Eigen::Map<const Eigen::Matrix4d>(before.data()),
                                  Eigen::Map<const Eigen::Matrix4d>(desired_.data()), kTick);
  }
  input.O_J_EE = dynamics.zero_jacobian;
  input.mass = dynamics.mass;
  input.q_d = q_;
  input.q = state.q;
  input.dq = state.dq;
  input.coriolis = coriolisOf(state, unit, dynamics);
  input.K = stiffness_;
  input.nullspace_stiffness = nullspace_stiffness_;
  input.rotor_inertia = unit.rotor_inertia;
  return cartesianImpedance(input);
}

}  // namespace franka_sim
