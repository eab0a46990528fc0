// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/vacuum_codec.h>
#include <franka_sim_mujoco/fci/client_slot.h>
#include <franka_sim_mujoco/robot/vacuum_gripper_unit.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim_mujoco::fci {

/// The network face of the vacuum gripper, protocol version 1: as GripperServer otherwise. The
/// profiles P0 to P3 are accepted and make no difference: what they set on a device is not
/// published.
///
/// One thread; serve allocates only when a client connects.
class VacuumServer {
 public:
  /// @param unit outlives the server.
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  VacuumServer(const std::string& address, std::uint16_t port, VacuumGripperUnit& unit);

  std::uint16_t port() const noexcept { return slot_.port(); }
  bool hasClient() const noexcept { return slot_.confirmed(); }
  /// A command runs whose outcome a client waits for.
  bool busy() const noexcept { return running_.has_value(); }

  /// Accepts, reads and answers. @param stops_only leaves all but Connect and Stop.
  void serve(bool stops_only = false);
  /// Sends a state if one is due and the replies of what has ended.
  /// @param milliseconds of simulated time since the last call.
  void publish(std::uint64_t milliseconds);

  void addDescriptors(std::vector<pollfd>& fds) const { slot_.addDescriptors(fds); }

 private:
  using Header = franka_core::fci::vacuum::Header;
  struct Running {
    franka_core::fci::vacuum::Command command;
    std::uint32_t id;
    VacuumGripperUnit::Ticket ticket;
  };

  bool serveOne(Connection& client, bool stops_only, bool& progressed);
  bool connect(const Header& header, const franka_core::fci::vacuum::ConnectRequest& request);
  bool start(const Header& header, const franka_core::fci::vacuum::Request& request);
  bool reply(franka_core::fci::vacuum::Command command, std::uint32_t id,
             franka_core::fci::vacuum::Status status, std::uint16_t version = 0);
  bool replyToEnded();
  void sendState();

  VacuumGripperUnit& unit_;
  ClientSlot slot_;
  Datagrams datagrams_;
  std::chrono::steady_clock::time_point state_sent_at_{};
  std::optional<Running> running_;
  std::uint64_t message_id_{0};
};

}  // namespace franka_sim_mujoco::fci
