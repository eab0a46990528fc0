// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <mujoco/mujoco.h>

#include <vector>

#include "physics/contacts/geom_contact.h"
#include "physics/contacts/ownership.h"
#include "physics/joints/motor_side.h"

namespace franka_sim::physics {

/// Holds the objects of a world in place while they rest and no robot can touch one (decision 60):
/// their contacts need not be computed then.
///
/// Owned by the stepping thread; allocates only in `fit` and where its state is kept.
class ObjectRest {
 public:
  /// Call for a new model. @param owners outlives it
  void fit(const mjModel& model, const Ownership& owners);
  /// What decides about the next ticks.
  struct State {
    bool held{false};
    bool decided{false};                ///< for the next tick
    int rested{0};                      ///< ticks, up to what is enough
    std::vector<GeomContact> contacts;  ///< of the held objects, in their last step
  };
  const State& state() const noexcept { return state_; }
  /// @param state of the same model
  void restore(const State& state) { state_ = state; }
  /// The state of the world was changed from outside.
  void disturb() noexcept {
    state_.held = false;
    state_.decided = false;
    state_.rested = 0;
  }
  /// For comparisons: without, objects are never held.
  void use(bool used) noexcept {
    used_ = used;
    disturb();
  }

  /// Decides whether objects are held in the tick that begins, unless that is decided already.
  /// @param free whether nothing but gravity and other objects can act on them
  /// @param contacts a function that returns those of the last step. Real-time safe.
  template <typename Contacts>
  void startTick(const mjData& data, bool free, const Contacts& contacts) noexcept {
    if (state_.decided) {
      return;
    }
    state_.decided = true;
    const bool before = state_.held;
    state_.held = free && restsLongEnough(data);
    if (state_.held && !before) {
      state_.contacts.assign(contacts().begin(), contacts().end());
    }
  }
  /// Keeps where they are; call before the steps of a tick. Real-time safe.
  void startSteps(const mjData& data, const MotorSide& motor_side) noexcept;
  /// Puts them back; call after each step. Real-time safe.
  void finishStep(mjData* data) const noexcept;
  /// Call after the last step, once the torques of the tick are known. Real-time safe.
  void finishTick(MotorSide* motor_side) noexcept;
  /// Whether the objects are held in the tick that was decided last. Real-time safe.
  bool held() const noexcept { return state_.held; }

 private:
  bool restsLongEnough(const mjData& data) noexcept;

  bool used_{true};
  bool possible_{false};
  State state_;
  const Ownership* owners_{nullptr};
  std::vector<int> positions_;  ///< of objects, in qpos
  std::vector<double> kept_positions_, kept_accelerations_, kept_torques_;
};

}  // namespace franka_sim::physics
