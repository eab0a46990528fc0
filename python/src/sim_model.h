// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/model.h>
#include <franka_core/arm_model.h>

#include <array>

namespace pyfranka {

/// franka_core::ArmModel with the functions of franka::Model, for the live state of a simulated
/// robot (franka_core::RobotState) and for a franka::RobotState.
class SimModel {
 public:
  template <std::size_t size>
  using Array = std::array<double, size>;

  explicit SimModel(const franka_core::ArmModel& model) : model_(model) {}

  template <typename State>
  Array<16> pose(franka::Frame frame, const State& state) const {
    return pose(frame, state.q, state.F_T_EE, state.EE_T_K);
  }
  Array<16> pose(franka::Frame frame, const Array<7>& q, const Array<16>& F_T_EE,
                 const Array<16>& EE_T_K) const {
    return model_.pose(toCore(frame), q, F_T_EE, EE_T_K);
  }
  template <typename State>
  Array<42> zeroJacobian(franka::Frame frame, const State& state) const {
    return zeroJacobian(frame, state.q, state.F_T_EE, state.EE_T_K);
  }
  Array<42> zeroJacobian(franka::Frame frame, const Array<7>& q, const Array<16>& F_T_EE,
                         const Array<16>& EE_T_K) const {
    return model_.zeroJacobian(toCore(frame), q, F_T_EE, EE_T_K);
  }
  template <typename State>
  Array<42> bodyJacobian(franka::Frame frame, const State& state) const {
    return bodyJacobian(frame, state.q, state.F_T_EE, state.EE_T_K);
  }
  Array<42> bodyJacobian(franka::Frame frame, const Array<7>& q, const Array<16>& F_T_EE,
                         const Array<16>& EE_T_K) const {
    return model_.bodyJacobian(toCore(frame), q, F_T_EE, EE_T_K);
  }
  template <typename State>
  Array<49> mass(const State& state) const {
    return mass(state.q, state.I_total, state.m_total, state.F_x_Ctotal);
  }
  Array<49> mass(const Array<7>& q, const Array<9>& I_total, double m_total,
                 const Array<3>& F_x_Ctotal) const {
    return model_.mass(q, {m_total, F_x_Ctotal, I_total});
  }
  template <typename State>
  Array<7> coriolis(const State& state) const {
    return coriolis(state.q, state.dq, state.I_total, state.m_total, state.F_x_Ctotal);
  }
  Array<7> coriolis(const Array<7>& q, const Array<7>& dq, const Array<9>& I_total, double m_total,
                    const Array<3>& F_x_Ctotal) const {
    return model_.coriolis(q, dq, {m_total, F_x_Ctotal, I_total});
  }
  template <typename State>
  Array<7> gravity(const State& state) const {
    return gravity(state, state.O_ddP_O);
  }
  template <typename State>
  Array<7> gravity(const State& state, const Array<3>& gravity_earth) const {
    return gravity(state.q, state.m_total, state.F_x_Ctotal, gravity_earth);
  }
  Array<7> gravity(const Array<7>& q, double m_total, const Array<3>& F_x_Ctotal,
                   const Array<3>& gravity_earth) const {
    return model_.gravity(q, {m_total, F_x_Ctotal, {}}, gravity_earth);
  }

 private:
  static franka_core::ArmFrame toCore(franka::Frame frame) {
    return static_cast<franka_core::ArmFrame>(frame);  // in the same order
  }

  franka_core::ArmModel model_;
};

}  // namespace pyfranka
