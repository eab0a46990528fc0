// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>
#include <franka_core/fci/vacuum_codec.h>
#include <franka_sim/fci/hand_server.h>
#include <franka_sim/robot/vacuum_gripper_unit.h>

#include <cstdint>

namespace franka_sim::fci {

/// The vacuum gripper, protocol version 1. The profiles P0 to P3 are accepted without effect: what
/// they set on a device is not published.
struct VacuumDevice {
  using Unit = VacuumGripperUnit;
  using Command = franka_core::fci::vacuum::Command;
  using Request = franka_core::fci::vacuum::Request;
  using ReplyMessage = franka_core::fci::vacuum::ReplyMessage;
  using StateBuffer = franka_core::fci::vacuum::StateBuffer;

  static constexpr std::size_t kMaxRequestSize = franka_core::fci::vacuum::kMaxRequestSize;
  static constexpr std::uint16_t kNewestVersion = franka_core::fci::kVacuumGripperVersion;
  static bool supportsVersion(std::uint16_t version) noexcept {
    return franka_core::fci::isVacuumGripperVersion(version);
  }
  /// Hands a request other than Connect to the unit. @returns 0 when it refuses.
  static Unit::Ticket start(Unit& unit, const Request& request) noexcept;
  /// The unit's state as a datagram. @param message_id [ms]
  static StateBuffer encode(const Unit& unit, std::uint32_t message_id) noexcept;
};

using VacuumServer = HandServer<VacuumDevice>;

extern template class HandServer<VacuumDevice>;

}  // namespace franka_sim::fci
