// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/unit_requests.h>

#include <cstdint>
#include <optional>

namespace franka_sim::fci {

/// Handles the requests that a robot server receives from its client, and reports how they ended.
/// The control unit implements it; tests use a simpler implementation. One thread; nothing throws.
class ArmRequestHandler {
 public:
  using Status = franka_core::fci::Status;

  virtual ~ArmRequestHandler() = default;

  /// What the robot shows now; modes and configuration as the last request left them.
  virtual const franka_core::RobotState& state() const noexcept = 0;
  /// A client has connected with this protocol version.
  virtual void connected(std::uint16_t version) noexcept = 0;
  /// The client has gone; a motion of its may still run.
  virtual void disconnected() noexcept = 0;
  /// Whether clients may connect. When it is switched off, a connected client is dropped.
  virtual bool active() const noexcept = 0;

  /// The answer to any request but Connect and those for models. Move answers kMotionStarted, or
  /// why not. StopMove and AutomaticErrorRecovery may answer later: nothing now, then by
  /// takeAnswer.
  virtual std::optional<Status> handle(const franka_core::fci::Request& request) noexcept = 0;
  /// The virtual wall of that number; nothing if there is no such number.
  virtual std::optional<franka_core::fci::CartesianLimit> wall(std::int32_t id) const noexcept = 0;

  /// How the motion, the stop or the recovery ended; each answer is returned once.
  virtual std::optional<Status> takeAnswer(PendingAnswer which) noexcept = 0;
};

}  // namespace franka_sim::fci
