// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/laws/control_laws.h"

#include <cstddef>

#include "robot/laws/cartesian_impedance.h"
#include "robot/laws/control_task.h"
#include "robot/laws/joint_impedance.h"
#include "robot/laws/saturate.h"

namespace franka_sim {

using franka_core::ControllerMode;
using franka_core::RobotMode;

namespace {

// Stiffness of the axes and the elbow that are not free in Guiding. Chosen here: equal to the
// initial values of Cartesian impedance control, because the stiffness of a real robot is not
// published.
constexpr double kGuidingTranslation = 3000.0;  // [N/m]
constexpr double kGuidingRotation = 300.0;      // [Nm/rad]
constexpr double kGuidingNullspace = 200.0;     // [Nm/rad]
constexpr double kNullspace = 10.0;             // [Nm/rad], chosen here (decision 11)

/// Fills the fields that do not depend on the task.
CartesianImpedanceInput measuredInput(const ControlUnitParameters& parameters,
                                      const franka_core::RobotState& state,
                                      const Estimate& estimate) noexcept {
  CartesianImpedanceInput in;
  in.O_T_EE = state.O_T_EE;
  in.EE_T_K = state.EE_T_K;
  in.O_J_EE = estimate.dynamics.zero_jacobian;
  in.mass = estimate.dynamics.mass;
  in.q = state.q;
  in.dq = estimate.dq;
  in.coriolis = estimate.dynamics.coriolis;
  in.rotor_inertia = parameters.rotor_inertia;
  return in;
}

std::array<double, 7> guide(CartesianImpedanceInput in, const GuidingTask& guiding) noexcept {
  in.O_T_EE_d = guiding.O_T_EE;
  in.O_dP_EE_d.fill(0.0);
  in.q_d = guiding.q;
  for (std::size_t i = 0; i < 6; i++) {
    in.K[i] = guiding.free[i] ? 0.0 : (i < 3 ? kGuidingTranslation : kGuidingRotation);
  }
  in.nullspace_stiffness = guiding.elbow_free ? 0.0 : kGuidingNullspace;
  return cartesianImpedance(in);
}

// The torques that links and rotors need for a desired acceleration, here that of braking. They act
// without a blend: an arm that begins to brake too late overshoots and springs back.
std::array<double, 7> accelerating(const std::array<double, 7>& ddq_d,
                                   const std::array<double, 49>& mass,
                                   const std::array<double, 7>& rotor_inertia) noexcept {
  std::array<double, 7> tau;
  for (std::size_t i = 0; i < 7; i++) {
    tau[i] = rotor_inertia[i] * ddq_d[i];
    for (std::size_t j = 0; j < 7; j++) {
      tau[i] += mass[7 * j + i] * ddq_d[j];
    }
  }
  return tau;
}

std::array<double, 7> sumOf(std::array<double, 7> a, const std::array<double, 7>& b) noexcept {
  for (std::size_t i = 0; i < 7; i++) {
    a[i] += b[i];
  }
  return a;
}

std::array<double, 7> follow(CartesianImpedanceInput in, const franka_core::RobotState& state,
                             const std::array<double, 6>& stiffness) noexcept {
  in.O_T_EE_d = state.O_T_EE_d;
  in.O_dP_EE_d = state.O_dP_EE_d;
  in.q_d = state.q_d;
  in.K = stiffness;
  in.nullspace_stiffness = kNullspace;
  return cartesianImpedance(in);
}

}  // namespace

const std::array<double, 7>& ControlLaws::torques(const ControlTask& task,
                                                  const franka_core::RobotState& state,
                                                  const Estimate& estimate) noexcept {
  if (task.law_switch == LawSwitch::kBlend) {
    blend_.lawChanges();
  } else if (task.law_switch == LawSwitch::kFromZero) {
    blend_.lawStartsFromZero();
  }
  const ControlUnitParameters& parameters = configuration_->parameters();
  law_ = saturate(law(task, state, estimate), parameters.max_torque);
  motor_torques_ = blend_.apply(law_);
  if (task.mode != RobotMode::kMove && state.ddq_d != std::array<double, 7>{}) {
    const std::array<double, 7> braking =
        accelerating(state.ddq_d, estimate.dynamics.mass, parameters.rotor_inertia);
    motor_torques_ = sumOf(motor_torques_, braking);
  }
  motor_torques_ = saturate(motor_torques_, parameters.max_torque);
  // The configured payload may be heavier than a motor can hold.
  motor_torques_ =
      sumOf(motor_torques_, saturate(estimate.dynamics.gravity, parameters.max_torque));
  return motor_torques_;
}

const std::array<double, 7>& ControlLaws::rest() noexcept {
  blend_.restart();
  motor_torques_.fill(0.0);
  return motor_torques_;
}

std::array<double, 7> ControlLaws::law(const ControlTask& task,
                                       const franka_core::RobotState& state,
                                       const Estimate& estimate) const noexcept {
  const ControlUnitParameters& parameters = configuration_->parameters();
  const auto joint_impedance = [&](const std::array<double, 7>& stiffness) {
    return JointImpedance(stiffness, parameters.rotor_inertia)
        .torque(state.q_d, state.dq_d, state.q, estimate.dq, estimate.dynamics.mass,
                estimate.dynamics.coriolis);
  };
  if (task.mode == RobotMode::kGuiding) {
    return guide(measuredInput(parameters, state, estimate), task.guiding);
  }
  if (task.mode != RobotMode::kMove) {
    // Holds a pose that was latched at the start of the mode (decision 6), or brakes.
    return joint_impedance(parameters.joint_stiffness);
  }
  switch (task.controller) {
    case ControllerMode::kExternalController:
      return task.tau;
    case ControllerMode::kCartesianImpedance:
      return follow(measuredInput(parameters, state, estimate), state,
                    parameters.cartesian_stiffness);
    default:
      return joint_impedance(configuration_->jointStiffness());
  }
}

}  // namespace franka_sim
