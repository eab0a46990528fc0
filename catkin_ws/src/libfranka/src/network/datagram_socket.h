// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>
#include <franka_core/spin_rule.h>

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "network/endpoint.h"

namespace franka::network {

/// The UDP socket that receives states and sends commands back to their sender.
///
/// The robot is the sender of the first accepted datagram; others are ignored from then on. Called
/// by one thread at a time. After construction no function throws. Real-time safe.
class DatagramSocket {
 public:
  /// One datagram, or none.
  struct Received {
    bool any;          ///< false: no datagram, or none in time
    std::size_t size;  ///< [bytes] of the datagram, even if larger than the buffer
  };

  /// Listens on all addresses of this machine, on a port chosen by the system.
  /// @param timeout of receive; a second in the genuine client.
  /// @throws NetworkException if there is no such socket.
  explicit DatagramSocket(std::chrono::milliseconds timeout = std::chrono::seconds(1));

  std::uint16_t port() const noexcept { return port_; }

  /// The oldest received datagram, without waiting.
  Received tryReceive(std::uint8_t* buffer, std::size_t capacity) noexcept;
  /// The same, waiting up to the timeout. Waits for the robot's reaction to a command in the mode
  /// of setWaitMode; other waits sleep.
  Received receive(std::uint8_t* buffer, std::size_t capacity) noexcept;
  /// How to wait for the state that follows an answer; without this call: asleep.
  void setWaitMode(franka_core::WaitMode mode) noexcept {
    spin_rule_ = franka_core::SpinRule(mode);
  }
  /// Declares that the last received datagram came from the robot.
  void accept() noexcept;
  /// Sends to the robot.
  /// @returns 0, or the system's error number. Without an accepted datagram: EDESTADDRREQ.
  int answer(franka_core::fci::Bytes datagram) noexcept;

 private:
  Received receiveFromRobot(std::uint8_t* buffer, std::size_t capacity, int flags) noexcept;

  std::chrono::milliseconds timeout_;
  Descriptor socket_;
  std::uint16_t port_{0};
  sockaddr_in last_sender_{};
  sockaddr_in robot_{};
  bool has_robot_{false};
  franka_core::SpinRule spin_rule_{franka_core::WaitMode::kBlock};
  bool has_answered_{false};  ///< since the last wait
};

}  // namespace franka::network
