// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/unit_requests.h>

#include <cstdint>
#include <optional>

namespace franka_sim::fci {

/// Handles the requests that a robot server receives from its client, and reports their results.
/// The control unit implements it; tests use a simpler implementation. Called by one thread;
/// nothing throws.
class ArmRequestHandler {
 public:
  using Status = franka_core::fci::Status;

  virtual ~ArmRequestHandler() = default;

  /// The present state; modes and configuration include the last request.
  virtual const franka_core::RobotState& state() const noexcept = 0;
  /// A client has connected with this protocol version.
  virtual void connected(std::uint16_t version) noexcept = 0;
  /// The client has disconnected; its motion may still run.
  virtual void disconnected() noexcept = 0;
  /// Whether clients may connect. When it becomes false, a connected client is dropped.
  virtual bool active() const noexcept = 0;

  /// The answer to any request except Connect and those for models. Move returns kMotionStarted, or
  /// the reason for its refusal. StopMove and AutomaticErrorRecovery may return nothing now and the
  /// answer later through takeAnswer.
  virtual std::optional<Status> handle(const franka_core::fci::Request& request) noexcept = 0;
  /// The virtual wall with that number; nothing if there is no such number.
  virtual std::optional<franka_core::fci::CartesianLimit> wall(std::int32_t id) const noexcept = 0;

  /// The result of the motion, the stop or the recovery; each answer is returned once.
  virtual std::optional<Status> takeAnswer(PendingAnswer which) noexcept = 0;
};

}  // namespace franka_sim::fci
