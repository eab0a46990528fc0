// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "robot/configuration.h"

#include <franka_sim/robot/control_unit_parameters.h>

#include "robot/transforms.h"

namespace franka_sim {

namespace codec = franka_core::fci;

namespace {

const ControlUnitParameters& checked(const ControlUnitParameters& parameters) {
  checkParameters(parameters);
  return parameters;
}

/// Assigns a value if it is valid.
template <typename T>
Status assign(bool good, T& target, const T& value) noexcept {
  if (!good) {
    return Status::kInvalidArgumentRejected;
  }
  target = value;
  return Status::kSuccess;
}

}  // namespace

Configuration::Configuration(const ControlUnitParameters& parameters)
    : parameters_(checked(parameters)),
      payload_(franka_core::combine(parameters.end_effector, parameters.load)),
      joint_stiffness_(parameters.joint_stiffness) {}

Status Configuration::apply(const codec::SetNEToEERequest& request) noexcept {
  return assign(isFrame(request.NE_T_EE), parameters_.NE_T_EE, request.NE_T_EE);
}

Status Configuration::apply(const codec::SetEEToKRequest& request) noexcept {
  return assign(isFrame(request.EE_T_K), parameters_.EE_T_K, request.EE_T_K);
}

Status Configuration::apply(const codec::SetLoadRequest& request) noexcept {
  const franka_core::Payload load{request.mass, request.F_x_Cload, request.inertia};
  const Status status = assign(isPayload(load), parameters_.load, load);
  payload_ = franka_core::combine(parameters_.end_effector, parameters_.load);
  return status;
}

Status Configuration::apply(const codec::SetCollisionBehaviorRequest& r) noexcept {
  const CollisionThresholds acceleration{r.lower_torques_acceleration, r.upper_torques_acceleration,
                                         r.lower_forces_acceleration, r.upper_forces_acceleration};
  const CollisionThresholds nominal{r.lower_torques_nominal, r.upper_torques_nominal,
                                    r.lower_forces_nominal, r.upper_forces_nominal};
  const bool good = areThresholds(acceleration) && areThresholds(nominal);
  assign(good, parameters_.acceleration, acceleration);
  return assign(good, parameters_.nominal, nominal);
}

Status Configuration::apply(const codec::SetJointImpedanceRequest& request) noexcept {
  return assign(isJointStiffness(request.K_theta), joint_stiffness_, request.K_theta);
}

Status Configuration::apply(const codec::SetCartesianImpedanceRequest& request) noexcept {
  return assign(isCartesianStiffness(request.K_x), parameters_.cartesian_stiffness, request.K_x);
}

Status Configuration::apply(const SetEndEffector& request) noexcept {
  const bool valid = isPayload(request.payload) && isFrame(request.F_T_NE);
  assign(valid, parameters_.end_effector, request.payload);
  const Status status = assign(valid, parameters_.F_T_NE, request.F_T_NE);
  payload_ = franka_core::combine(parameters_.end_effector, parameters_.load);
  return status;
}

Status Configuration::apply(const SetProtocolVersion& request) noexcept {
  const bool known = request.version >= 3 && request.version <= 10;
  return assign(known, parameters_.protocol_version, request.version);
}

void Configuration::writeTo(franka_core::RobotState& state) const noexcept {
  const franka_core::Payload& ee = parameters_.end_effector;
  const franka_core::Payload& load = parameters_.load;
  state.F_T_NE = parameters_.F_T_NE;
  state.NE_T_EE = parameters_.NE_T_EE;
  state.EE_T_K = parameters_.EE_T_K;
  state.F_T_EE = multiply(parameters_.F_T_NE, parameters_.NE_T_EE);
  state.m_ee = ee.mass;
  state.F_x_Cee = ee.com;
  state.I_ee = ee.inertia;
  state.m_load = load.mass;
  state.F_x_Cload = load.com;
  state.I_load = load.inertia;
  state.m_total = payload_.mass;
  state.F_x_Ctotal = payload_.com;
  state.I_total = payload_.inertia;
  state.O_ddP_O = parameters_.gravity;
}

}  // namespace franka_sim
