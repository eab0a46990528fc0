// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/hands/gripper_unit.h>
#include <franka_sim/robot/plant.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>

namespace franka_sim::test {

/// Two sliding fingers without friction, coupled by a stiff spring like a common drive, with stops
/// at 0 and 0.04 m and an optional object between them. Substeps of 0.05 ms.
class FakeHand : public HandPlant {
 public:
  /// @param mass of each finger with its drive [kg] @param coupling between the fingers [N/m]
  explicit FakeHand(double mass = 0.115, double coupling = 20000.0)
      : mass_(mass), coupling_(coupling) {}

  /// An object [m]: between the closing fingers, or around the opening ones.
  struct Object {
    double left{0.0};     ///< finger 1 meets it at q[0] = left + position
    double right{0.0};    ///< finger 2 at q[1] = right - position
    bool hollow{false};   ///< grasped from inside
    bool movable{false};  ///< slides in the fingers' direction against friction
    double position{0.0};
    double mass{0.1};
    double friction{0.6};  ///< [N]
  };

  bool has_object{false};
  Object object;

  HandMeasurement measure() const noexcept override { return {q_, dq_}; }
  void applyForces(const std::array<double, 2>& force) noexcept override { force_ = force; }

  void put(double width) {
    q_.fill(0.5 * width);
    dq_.fill(0.0);
  }

  void step() noexcept {
    for (int i = 0; i < 20; i++) {
      substep(5e-5);
    }
  }

  double width() const { return q_[0] + q_[1]; }
  double speed() const { return dq_[0] + dq_[1]; }
  /// Force of each finger on the object, mean of the last substep [N].
  const std::array<double, 2>& padForce() const { return pad_; }

 private:
  static constexpr double kStiffness = 50000.0;  // of stops and objects [N/m]

  double damping() const { return 1.4 * std::sqrt(kStiffness * mass_); }

  void substep(double dt) noexcept {
    std::array<double, 2> total;
    for (std::size_t i = 0; i < 2; i++) {
      const std::size_t other = 1 - i;
      total[i] = force_[i] + coupling_ * (q_[other] - q_[i]) +
                 2.0 * std::sqrt(coupling_ * mass_) * 0.5 * (dq_[other] - dq_[i]);
      total[i] += wall(-q_[i], -dq_[i]) - wall(q_[i] - 0.04, dq_[i]);
      pad_[i] = 0.0;
      if (has_object) {
        const double side = i == 0 ? 1.0 : -1.0;
        const double border = (i == 0 ? object.left : object.right) + side * object.position;
        const double rate = dq_[i] - side * object_speed_;
        pad_[i] = object.hollow ? wall(q_[i] - border, rate) : wall(border - q_[i], -rate);
        total[i] += object.hollow ? -pad_[i] : pad_[i];
      }
    }
    moveObject(dt);
    for (std::size_t i = 0; i < 2; i++) {
      dq_[i] += dt * total[i] / mass_;
      q_[i] += dt * dq_[i];
    }
  }

  void moveObject(double dt) noexcept {
    if (!has_object || !object.movable) {
      return;
    }
    const double push = pad_[1] - pad_[0];
    const double limit = object.friction;
    // Coulomb friction that can stop the object within a step but not reverse it.
    double speed = object_speed_ + dt * push / object.mass;
    const double brake = dt * limit / object.mass;
    speed = speed > 0 ? std::max(speed - brake, 0.0) : std::min(speed + brake, 0.0);
    object_speed_ = speed;
    object.position += dt * speed;
  }

  double wall(double depth, double rate) const noexcept {
    return depth > 0 ? std::max(kStiffness * depth + damping() * rate, 0.0) : 0.0;
  }

  double mass_;
  double coupling_;
  std::array<double, 2> q_{{0.02, 0.02}}, dq_{}, force_{}, pad_{};
  double object_speed_{0.0};
};

}  // namespace franka_sim::test
