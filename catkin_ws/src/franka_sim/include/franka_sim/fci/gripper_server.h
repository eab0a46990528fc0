// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>
#include <franka_core/fci/protocol.h>
#include <franka_sim/fci/hand_server.h>
#include <franka_sim/robot/gripper_unit.h>

#include <cstdint>

namespace franka_sim::fci {

/// The hand with two fingers, protocol versions 2 and 3.
struct GripperDevice {
  using Unit = GripperUnit;
  using Command = franka_core::fci::gripper::Command;
  using Request = franka_core::fci::gripper::Request;
  using ReplyMessage = franka_core::fci::gripper::ReplyMessage;
  using StateBuffer = franka_core::fci::gripper::StateBuffer;

  static constexpr std::size_t kMaxRequestSize = franka_core::fci::gripper::kMaxRequestSize;
  static constexpr std::uint16_t kNewestVersion = franka_core::fci::kNewestGripperVersion;
  static bool supportsVersion(std::uint16_t version) noexcept {
    return franka_core::fci::isGripperVersion(version);
  }
  /// Hands a request other than Connect to the unit. @returns 0 when it refuses.
  static Unit::Ticket start(Unit& unit, const Request& request) noexcept;
  /// The unit's state as a datagram. @param message_id [ms]
  static StateBuffer encode(const Unit& unit, std::uint32_t message_id) noexcept;
};

using GripperServer = HandServer<GripperDevice>;

extern template class HandServer<GripperDevice>;

}  // namespace franka_sim::fci
