// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/plant.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cstddef>
#include <limits>

namespace franka_sim::test {

/// An arm that moves as its control unit's model predicts: (M + B) ddq + c + g = tau + push, with
/// the quantities that the unit has computed anyway. A tick of it costs a tenth of one of FakeArm,
/// and it has no external torque but the push.
class ModelArm : public ArmPlant {
 public:
  using Joints = std::array<double, 7>;

  explicit ModelArm(const Joints& q) noexcept : q_(q) {}

  ArmMeasurement measure() const noexcept override {
    ArmMeasurement measurement{q_, dq_, tau_J_, 1};
    if (spoiled_) {
      measurement.q[3] = std::numeric_limits<double>::quiet_NaN();
    }
    return measurement;
  }
  void applyTorques(const Joints& tau) noexcept override { tau_ = tau; }
  void setBrakes(bool closed) noexcept override { braked_ = closed; }

  /// A tick with the model's quantities at its begin.
  void step(const franka_core::ArmDynamics& dynamics) noexcept {
    spoiled_ = false;
    if (braked_) {
      dq_.fill(0.0);
      tau_J_ = dynamics.gravity;
      return;
    }
    using Vector = Eigen::Map<const Eigen::Matrix<double, 7, 1>>;
    Eigen::Matrix<double, 7, 7> M(dynamics.mass.data());
    M.diagonal().array() += kRotor;
    const Eigen::Matrix<double, 7, 1> ddq =
        M.llt().solve(Vector(tau_.data()) + Vector(push_.data()) -
                      Vector(dynamics.coriolis.data()) - Vector(dynamics.gravity.data()));
    for (std::size_t i = 0; i < 7; i++) {
      dq_[i] += kTick * ddq[static_cast<int>(i)];
      q_[i] += kTick * dq_[i];
      tau_J_[i] = tau_[i] - kRotor * ddq[static_cast<int>(i)];
    }
  }

  void setPush(const Joints& push) noexcept { push_ = push; }  ///< external torque [Nm]
  void spoilMeasurement() noexcept { spoiled_ = true; }        ///< of the next tick: not finite
  void put(const Joints& q) noexcept {
    q_ = q;
    dq_.fill(0.0);
  }

  const Joints& torques() const noexcept { return tau_; }
  bool isBraked() const noexcept { return braked_; }

 private:
  static constexpr double kRotor = 0.1;

  Joints q_, dq_{}, tau_J_{}, tau_{}, push_{};
  bool braked_{false};
  bool spoiled_{false};
};

}  // namespace franka_sim::test
