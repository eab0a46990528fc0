// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <cstddef>
#include <string>

#include "physics/joints/plant_view.h"

namespace franka_sim::physics {

/// The seven joints of an arm in MuJoCo's arrays.
class MujocoArm final : public ArmPlant {
 public:
  /// @param torque_offset of the joints' torque sensors [Nm]
  MujocoArm(const PlantView* view, std::array<std::string, 7> joints,
            const std::array<double, 7>& torque_offset);

  ArmMeasurement measure() const noexcept override;
  void applyTorques(const std::array<double, 7>& tau) noexcept override;
  void setBrakes(bool closed) noexcept override;

  const std::array<std::string, 7>& joints() const noexcept { return joints_; }
  using Slots = std::array<JointSlot, 7>;
  /// Call after the model was recompiled.
  void bind(const Slots& slots) noexcept { slots_ = slots; }
  /// Restores the brakes in a recompiled model.
  void restoreBrakes() noexcept;
  /// Call after a joint was teleported: closed brakes hold it there.
  void jointWasMoved(const std::string& joint) noexcept;
  /// Opens brakes, zero torque.
  void reset() noexcept;

  /// What a snapshot keeps of it in addition to the model and the data.
  struct State {
    bool brakes_closed{false};
    std::array<double, 7> brake_positions{};
  };
  const State& state() const noexcept { return state_; }
  /// Call after the model's equalities were restored.
  void restore(const State& state) noexcept { state_ = state; }

 private:
  void writeBrake(std::size_t joint) noexcept;

  const PlantView* view_;
  std::array<std::string, 7> joints_;
  std::array<double, 7> torque_offset_;
  std::array<JointSlot, 7> slots_{};
  State state_;
};

}  // namespace franka_sim::physics
