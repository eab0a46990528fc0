// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_hw/model_base.h>

namespace franka_hw {

namespace {

constexpr std::array<double, 3> kGravityUpright{{0.0, 0.0, -9.81}};  // franka::Model's default

}  // namespace

std::array<double, 16> ModelBase::pose(franka::Frame frame,
                                       const franka::RobotState& robot_state) const {
  return pose(frame, robot_state.q, robot_state.F_T_EE, robot_state.EE_T_K);
}

std::array<double, 42> ModelBase::bodyJacobian(franka::Frame frame,
                                               const franka::RobotState& robot_state) const {
  return bodyJacobian(frame, robot_state.q, robot_state.F_T_EE, robot_state.EE_T_K);
}

std::array<double, 42> ModelBase::zeroJacobian(franka::Frame frame,
                                               const franka::RobotState& robot_state) const {
  return zeroJacobian(frame, robot_state.q, robot_state.F_T_EE, robot_state.EE_T_K);
}

std::array<double, 49> ModelBase::mass(const franka::RobotState& robot_state) const {
  return mass(robot_state.q, robot_state.I_total, robot_state.m_total, robot_state.F_x_Ctotal);
}

std::array<double, 7> ModelBase::coriolis(const franka::RobotState& robot_state) const {
  return coriolis(robot_state.q, robot_state.dq, robot_state.I_total, robot_state.m_total,
                  robot_state.F_x_Ctotal);
}

std::array<double, 7> ModelBase::gravity(const std::array<double, 7>& q, double total_mass,
                                         const std::array<double, 3>& F_x_Ctotal) const {
  return gravity(q, total_mass, F_x_Ctotal, kGravityUpright);
}

std::array<double, 7> ModelBase::gravity(const franka::RobotState& robot_state) const {
#ifdef ENABLE_BASE_ACCELERATION
  return gravity(robot_state, robot_state.O_ddP_O);
#else
  return gravity(robot_state, kGravityUpright);
#endif
}

std::array<double, 7> ModelBase::gravity(const franka::RobotState& robot_state,
                                         const std::array<double, 3>& gravity_earth) const {
  return gravity(robot_state.q, robot_state.m_total, robot_state.F_x_Ctotal, gravity_earth);
}

}  // namespace franka_hw
