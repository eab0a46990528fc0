// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>

#include <chrono>
#include <cstddef>
#include <cstdint>

#include "network/endpoint.h"

namespace franka::network {

/// The UDP socket on which states arrive and from which commands go back to where they came from.
///
/// The robot is whoever sent the datagram that was accepted first; others are not listened to from
/// then on. One thread at a time. After construction nothing allocates, locks or throws: safe in
/// the 1 kHz loop.
class DatagramSocket {
 public:
  /// One datagram, or none.
  struct Received {
    bool any;          ///< false: nothing there, or nothing came in time
    std::size_t size;  ///< [bytes] of the datagram, also where it is larger than the buffer
  };

  /// Listens on all addresses of this machine, on a port the system chooses.
  /// @param timeout how long receive waits for a datagram; a second in the genuine client.
  /// @throws NetworkException if there is no such socket.
  explicit DatagramSocket(std::chrono::milliseconds timeout = std::chrono::seconds(1));

  std::uint16_t port() const noexcept { return port_; }

  /// The oldest datagram that waits, without waiting for one.
  Received tryReceive(std::uint8_t* buffer, std::size_t capacity) noexcept;
  /// The same, waiting up to the timeout. Where the robot's answers come faster than a thread is
  /// woken up (a simulated one in lock-step), it waits for them without going to sleep.
  Received receive(std::uint8_t* buffer, std::size_t capacity) noexcept;
  /// Says that the datagram received last came from the robot.
  void accept() noexcept;
  /// Sends to the robot.
  /// @returns 0, or the system's error number. Without an accepted datagram: EDESTADDRREQ.
  int answer(franka_core::fci::Bytes datagram) noexcept;

 private:
  Received awaitSwiftly(std::uint8_t* buffer, std::size_t capacity) noexcept;
  Received receiveFromRobot(std::uint8_t* buffer, std::size_t capacity, int flags) noexcept;

  std::chrono::milliseconds timeout_;
  Descriptor socket_;
  std::uint16_t port_{0};
  sockaddr_in last_sender_{};
  sockaddr_in robot_{};
  bool has_robot_{false};
  bool may_spin_;      ///< the robot can work on another processor meanwhile
  bool swift_{false};  ///< the last wait was shorter than kSwift
};

}  // namespace franka::network
