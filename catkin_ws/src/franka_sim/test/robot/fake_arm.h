// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/plant.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cstddef>

namespace franka_sim::test {

namespace codec = franka_core::fci;

using Vector7 = Eigen::Matrix<double, 7, 1>;
using Matrix7 = Eigen::Matrix<double, 7, 7>;

/// An arm with (M(q) + B) ddq + c + g + friction = tau + J^T F, in two semi-implicit Euler substeps
/// of 0.5 ms, with link-side torque sensors (decision 2). Its payload is the true one, not the one
/// configured in the unit.
class FakeArm : public ArmPlant {
 public:
  FakeArm(const franka_core::ArmModel& model, const std::array<double, 7>& q)
      : model_(model), q_(q) {}

  franka_core::Payload payload;  ///< true payload at the flange
  std::array<double, 3> gravity{{0, 0, -9.81}};
  std::array<double, 6> push{};  ///< external, in O, at the frame below [N, Nm]
  std::array<double, 16> push_frame{franka_core::kIdentityTransform};  ///< in the flange frame

  ArmMeasurement measure() const noexcept override { return {q_, dq_, tau_J_, kSubsteps}; }
  void applyTorques(const std::array<double, 7>& tau) noexcept override { tau_ = tau; }
  void setBrakes(bool closed) noexcept override { braked_ = closed; }

  void step() noexcept {
    const std::array<double, 7> before = dq_;
    Vector7 sum = Vector7::Zero();
    for (int i = 0; i < kSubsteps; i++) {
      sum += substep();
    }
    for (std::size_t i = 0; i < 7; i++) {
      tau_J_[i] = sum[i] / kSubsteps - kRotor * (dq_[i] - before[i]) / 1e-3;
    }
  }

  void put(const std::array<double, 7>& q) noexcept {
    q_ = q;
    dq_.fill(0.0);
  }

  const std::array<double, 7>& q() const { return q_; }
  const std::array<double, 7>& dq() const { return dq_; }
  const std::array<double, 7>& torques() const { return tau_; }

  static constexpr double kRotor = 0.1;
  static constexpr int kSubsteps = 2;

 private:
  // Returns the torque on the link side from motor and friction, or from the brakes.
  Vector7 substep() noexcept {
    constexpr double kStep = 1e-3 / kSubsteps;
    franka_core::ArmDynamics d;
    model_.computeDynamics(franka_core::ArmFrame::kEndEffector, q_, dq_, push_frame,
                           franka_core::kIdentityTransform, payload, gravity, d);
    const Eigen::Map<const Eigen::Matrix<double, 6, 7>> J(d.zero_jacobian.data());
    const Vector7 outside =
        J.transpose() * Eigen::Map<const Eigen::Matrix<double, 6, 1>>(push.data());
    const Vector7 bias =
        Eigen::Map<const Vector7>(d.coriolis.data()) + Eigen::Map<const Vector7>(d.gravity.data());
    if (braked_) {
      dq_.fill(0.0);
      return Eigen::Map<const Vector7>(d.gravity.data()) - outside;
    }
    const Vector7 tau = Eigen::Map<const Vector7>(tau_.data());
    Matrix7 M = Eigen::Map<const Matrix7>(d.mass.data());
    M.diagonal().array() += kRotor;
    const Vector7 ddq = M.llt().solve(tau + outside - bias);
    for (int i = 0; i < 7; i++) {
      dq_[i] += kStep * ddq[i];
      q_[i] += kStep * dq_[i];
    }
    return tau;
  }

  franka_core::ArmModel model_;
  std::array<double, 7> q_, dq_{}, tau_J_{}, tau_{};
  bool braked_{false};
};

/// One tick of unit and arm, as both interfaces run it.
inline const franka_core::RobotState& tick(ControlUnit& unit, FakeArm& arm,
                                           const franka_core::RobotCommand* command = nullptr) {
  const franka_core::RobotState& state = unit.observe(arm.measure());
  arm.applyTorques(unit.actuate(command));
  arm.setBrakes(unit.status().brakes_closed);
  arm.step();
  return state;
}

inline const franka_core::RobotState& run(ControlUnit& unit, FakeArm& arm, int ticks,
                                          const franka_core::RobotCommand* command = nullptr) {
  for (int i = 0; i < ticks; i++) {
    tick(unit, arm, command);
  }
  return unit.state();
}

}  // namespace franka_sim::test
