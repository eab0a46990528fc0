// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>
#include <franka_sim_mujoco/fci/client_slot.h>
#include <franka_sim_mujoco/robot/gripper_unit.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim_mujoco::fci {

/// The network face of the hand: requests over TCP, states over UDP about thirty times a second
/// (the real rate is not published). Protocol versions 2 and 3. One client at a time, as with
/// RobotServer. A command that replaces another one ends it: the earlier one's reply is Aborted.
///
/// One thread; serve allocates only when a client connects.
class GripperServer {
 public:
  /// @param unit outlives the server.
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  GripperServer(const std::string& address, std::uint16_t port, GripperUnit& unit);
  ~GripperServer();

  std::uint16_t port() const noexcept { return slot_.port(); }
  bool hasClient() const noexcept { return slot_.confirmed(); }
  /// A command runs whose outcome a client waits for.
  bool busy() const noexcept { return running_.has_value(); }

  /// Accepts, reads and answers. @param stops_only leaves all but Connect and Stop.
  void serve(bool stops_only = false);
  /// Sends a state if one is due and the replies of what has ended.
  /// @param milliseconds of simulated time since the last call.
  void publish(std::uint64_t milliseconds);

  void addDescriptors(std::vector<pollfd>& fds) const;

 private:
  using Header = franka_core::fci::gripper::Header;
  struct Running {
    franka_core::fci::gripper::Command command;
    std::uint32_t id;
    GripperUnit::Ticket ticket;
  };

  void forgetClient() noexcept;
  bool serveOne(Connection& client, bool stops_only, bool& progressed);
  bool connect(const Header& header, const franka_core::fci::gripper::ConnectRequest& request);
  bool start(const Header& header, const franka_core::fci::gripper::Request& request);
  bool reply(franka_core::fci::gripper::Command command, std::uint32_t id,
             franka_core::fci::gripper::Status status, std::uint16_t version = 0);
  bool replyToEnded();

  GripperUnit& unit_;
  ClientSlot slot_;
  Datagrams datagrams_;
  std::chrono::steady_clock::time_point state_sent_at_{};
  std::optional<Running> running_;
  std::uint64_t message_id_{0};
};

}  // namespace franka_sim_mujoco::fci
