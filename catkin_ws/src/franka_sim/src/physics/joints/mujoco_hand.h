// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <string>

#include "physics/joints/plant_view.h"

namespace franka_sim::physics {

/// The two fingers of a hand in MuJoCo's arrays.
class MujocoHand final : public HandPlant {
 public:
  MujocoHand(const PlantView* view, std::array<std::string, 2> joints);

  HandMeasurement measure() const noexcept override;
  void applyForces(const std::array<double, 2>& force) noexcept override;

  const std::array<std::string, 2>& joints() const noexcept { return joints_; }
  using Slots = std::array<JointSlot, 2>;
  void bind(const Slots& slots) noexcept { slots_ = slots; }

 private:
  const PlantView* view_;
  std::array<std::string, 2> joints_;
  std::array<JointSlot, 2> slots_{};
};

}  // namespace franka_sim::physics
