// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/fci/arm_desk.h>
#include <franka_sim_mujoco/robot/control_unit.h>

namespace franka_sim_mujoco::fci {

/// Hands requests to a control unit and its outcomes back, in the words of the protocol.
class UnitDesk final : public ArmDesk {
 public:
  /// @param unit outlives the desk.
  explicit UnitDesk(ControlUnit& unit) noexcept : unit_(unit) {}

  const franka_core::RobotState& state() const noexcept override { return unit_.state(); }
  void connected(std::uint16_t version) noexcept override;
  std::optional<Status> handle(const franka_core::fci::Request& request) noexcept override;
  std::optional<franka_core::fci::CartesianLimit> wall(std::int32_t id) const noexcept override;
  std::optional<Status> motionEnd() noexcept override;
  std::optional<Status> stopEnd() noexcept override;
  std::optional<Status> recoveryEnd() noexcept override;

 private:
  ControlUnit& unit_;
};

}  // namespace franka_sim_mujoco::fci
