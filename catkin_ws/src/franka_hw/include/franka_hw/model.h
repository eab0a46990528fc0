// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/model.h>
#include <franka_hw/model_base.h>

#include <array>
#include <utility>

namespace franka_hw {

/// The model that the robot provides, with the interface of all models. Layouts, units and frames:
/// ModelBase. Real-time safe. (franka::Model neither allocates nor locks.)
class Model : public ModelBase {
 public:
  /// @param model as from franka::Robot::loadModel
  explicit Model(franka::Model&& model) : model_(std::move(model)) {}

  // Keeps the overloads for a robot state visible beside the overrides.
  using ModelBase::bodyJacobian;
  using ModelBase::coriolis;
  using ModelBase::gravity;
  using ModelBase::mass;
  using ModelBase::pose;
  using ModelBase::zeroJacobian;

  std::array<double, 16> pose(franka::Frame frame, const std::array<double, 7>& q,
                              const std::array<double, 16>& F_T_EE,
                              const std::array<double, 16>& EE_T_K) const override {
    return model_.pose(frame, q, F_T_EE, EE_T_K);
  }
  std::array<double, 42> bodyJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override {
    return model_.bodyJacobian(frame, q, F_T_EE, EE_T_K);
  }
  std::array<double, 42> zeroJacobian(franka::Frame frame, const std::array<double, 7>& q,
                                      const std::array<double, 16>& F_T_EE,
                                      const std::array<double, 16>& EE_T_K) const override {
    return model_.zeroJacobian(frame, q, F_T_EE, EE_T_K);
  }
  std::array<double, 49> mass(const std::array<double, 7>& q,
                              const std::array<double, 9>& total_inertia, double total_mass,
                              const std::array<double, 3>& F_x_Ctotal) const noexcept override {
    return model_.mass(q, total_inertia, total_mass, F_x_Ctotal);
  }
  std::array<double, 7> coriolis(const std::array<double, 7>& q, const std::array<double, 7>& dq,
                                 const std::array<double, 9>& total_inertia, double total_mass,
                                 const std::array<double, 3>& F_x_Ctotal) const noexcept override {
    return model_.coriolis(q, dq, total_inertia, total_mass, F_x_Ctotal);
  }
  std::array<double, 7> gravity(
      const std::array<double, 7>& q, double total_mass, const std::array<double, 3>& F_x_Ctotal,
      const std::array<double, 3>& gravity_earth) const noexcept override {
    return model_.gravity(q, total_mass, F_x_Ctotal, gravity_earth);
  }

 private:
  franka::Model model_;
};

}  // namespace franka_hw
