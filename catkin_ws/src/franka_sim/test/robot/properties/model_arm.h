// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/plant.h>

#include <array>
#include <cmath>
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
    Joints sum;
    for (std::size_t i = 0; i < 7; i++) {
      sum[i] = tau_[i] + push_[i] - dynamics.coriolis[i] - dynamics.gravity[i];
    }
    const Joints ddq = solve(dynamics.mass, sum);
    for (std::size_t i = 0; i < 7; i++) {
      dq_[i] += kTick * ddq[i];
      q_[i] += kTick * dq_[i];
      tau_J_[i] = tau_[i] - kRotor * ddq[i];
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

  // (M + B) x = b by Cholesky's factorization.
  static Joints solve(const std::array<double, 49>& mass, Joints b) noexcept {
    std::array<std::array<double, 7>, 7> L;
    for (std::size_t i = 0; i < 7; i++) {
      for (std::size_t j = 0; j <= i; j++) {
        double sum = mass[7 * j + i] + (i == j ? kRotor : 0.0);
        for (std::size_t k = 0; k < j; k++) {
          sum -= L[i][k] * L[j][k];
        }
        L[i][j] = i == j ? std::sqrt(sum) : sum / L[j][j];
      }
      for (std::size_t k = 0; k < i; k++) {
        b[i] -= L[i][k] * b[k];
      }
      b[i] /= L[i][i];
    }
    for (std::size_t i = 7; i-- > 0;) {
      for (std::size_t k = i + 1; k < 7; k++) {
        b[i] -= L[k][i] * b[k];
      }
      b[i] /= L[i][i];
    }
    return b;
  }

  Joints q_, dq_{}, tau_J_{}, tau_{}, push_{};
  bool braked_{false};
  bool spoiled_{false};
};

}  // namespace franka_sim::test
