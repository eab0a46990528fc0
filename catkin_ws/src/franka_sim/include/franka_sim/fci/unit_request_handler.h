// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/arm_request_handler.h>
#include <franka_sim/robot/control_unit.h>

#include <cstdint>
#include <optional>

namespace franka_sim::fci {

/// Translates requests of the protocol for a control unit, and translates the unit's results back.
class UnitRequestHandler final : public ArmRequestHandler {
 public:
  /// @param unit outlives the handler.
  explicit UnitRequestHandler(ControlUnit& unit) noexcept : unit_(unit) {}

  const franka_core::RobotState& state() const noexcept override { return unit_.state(); }
  void connected(std::uint16_t version) noexcept override;
  void disconnected() noexcept override { unit_.request(ClientLost{}); }
  bool active() const noexcept override { return unit_.status().fci_active; }
  std::optional<Status> handle(const franka_core::fci::Request& request) noexcept override;
  std::optional<franka_core::fci::CartesianLimit> wall(std::int32_t id) const noexcept override;
  std::optional<Status> takeAnswer(PendingAnswer which) noexcept override;

 private:
  void applyVersion() noexcept;

  ControlUnit& unit_;
  std::uint16_t version_{0};  // of a client that connected during another one's motion; otherwise 0
};

}  // namespace franka_sim::fci
