// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <string>

#include "physics/joints/plant_view.h"

namespace franka_sim::physics {

/// A joint of another device in MuJoCo's arrays. Positions are held in the same way as by brakes.
class MujocoDrive final : public JointDrive {
 public:
  MujocoDrive(const PlantView* view, std::string joint);

  JointMeasurement measure() const noexcept override;
  void applyEffort(double effort) noexcept override;
  using JointDrive::follow;
  bool follow(double position, const DriveLimits& limits) noexcept override;

  const std::array<std::string, 1>& joints() const noexcept { return joint_; }
  using Slots = std::array<JointSlot, 1>;
  /// Call after the model was recompiled; follow() stays in effect.
  void bind(const Slots& slots) noexcept;
  /// Call after the joint was teleported: the followed position is there.
  void jointWasMoved(const std::string& joint) noexcept;
  /// Zero effort, nothing followed.
  void reset() noexcept;
  /// Call before each physics step of a tick, counted from 1: the target moves in even steps, too.
  void prepare(int substep, int substeps) noexcept;

  /// What a snapshot keeps of it in addition to the model and the data.
  struct State {
    bool follows{false};
    double last_target{0},
        target{0};       ///< followed position at the last tick's end, and at this one's
    DriveLimits limits;  ///< while it follows
  };
  const State& state() const noexcept { return state_; }
  /// Call after the model's equalities were restored.
  void restore(const State& state) noexcept { state_ = state; }

 private:
  void writeTarget() noexcept;

  const PlantView* view_;
  std::array<std::string, 1> joint_;
  JointSlot slot_{};
  State state_;
};

}  // namespace franka_sim::physics
