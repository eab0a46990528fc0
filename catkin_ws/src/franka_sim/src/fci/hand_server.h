// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <franka_core/fci/gripper_codec.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/fci/vacuum_codec.h>
#include <franka_sim/robot/hands/gripper_unit.h>
#include <franka_sim/robot/hands/vacuum_gripper_unit.h>

#include <chrono>
#include <cstdint>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fci/client_slot.h"

namespace franka_sim::fci {

/// TCP and UDP server of the device on the flange: requests over TCP, states over UDP about thirty
/// times a second (the real rate is not published). One client at a time, as with RobotServer. A
/// command that replaces another one ends it: the earlier one's reply is Aborted.
///
/// Called by one thread. serve allocates only when a client connects.
/// @tparam Device defines what differs between the two: GripperDevice, VacuumDevice.
template <typename Device>
class HandServer {
 public:
  using Unit = typename Device::Unit;

  /// @param unit outlives the server.
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  HandServer(const std::string& address, std::uint16_t port, Unit& unit)
      : unit_(unit), slot_(address, port), datagrams_(address) {}

  std::uint16_t port() const noexcept { return slot_.port(); }
  /// Whether clients can connect, since the last setOpen().
  bool isOpen() const noexcept { return slot_.isOpen(); }
  bool hasClient() const noexcept { return slot_.confirmed(); }
  bool idle() const noexcept { return slot_.idle(); }
  /// See ClientSlot::onRefusal.
  void onRefusal(ClientSlot::Report report) { slot_.onRefusal(std::move(report)); }
  /// Whether a command of any client runs. It continues after its client has disconnected: a hand
  /// must not drop an object because a program ends.
  bool busy() const noexcept { return unit_.isBusy(); }

  /// Closed: the port refuses, and the client is disconnected.
  void setOpen(bool open) noexcept;
  /// Accepts, reads and answers. @param stops_only serves Connect and Stop only.
  void serve(bool stops_only = false);
  /// Sends a state if one is due, and the replies to commands that have ended.
  /// @param milliseconds of simulated time since the last call.
  void publish(std::uint64_t milliseconds);

  void addDescriptors(std::vector<pollfd>& fds) const { slot_.addDescriptors(fds); }

 private:
  using Header = franka_core::fci::gripper::Header;
  using Status = franka_core::fci::gripper::Status;
  using ConnectRequest = franka_core::fci::gripper::ConnectRequest;
  using Request = typename Device::Request;
  using Command = typename Device::Command;
  struct Running {
    Command command;
    std::uint32_t id;
    TicketLog::Ticket ticket;
  };
  static constexpr std::chrono::milliseconds kStatePeriod{33};

  static Status toStatus(GripperOutcome outcome) noexcept;
  Served serveOne(Connection& client, bool stops_only);
  bool connect(const Header& header, const ConnectRequest& request);
  bool start(const Header& header, const Request& request);
  bool reply(Command command, std::uint32_t id, Status status, std::uint16_t version = 0);
  bool replyToEnded();
  void clearClient() noexcept { running_.reset(); }

  Unit& unit_;
  ClientSlot slot_;
  Datagrams datagrams_;
  std::chrono::steady_clock::time_point state_sent_at_{};
  std::optional<Running> running_;  // for the connected client
  std::uint64_t message_id_{0};
};

template <typename Device>
typename HandServer<Device>::Status HandServer<Device>::toStatus(GripperOutcome outcome) noexcept {
  switch (outcome) {
    case GripperOutcome::kSucceeded:
      return Status::kSuccess;
    case GripperOutcome::kInterrupted:
      return Status::kAborted;
    default:
      return Status::kUnsuccessful;
  }
}

template <typename Device>
void HandServer<Device>::setOpen(bool open) noexcept {
  slot_.setOpen(open);
  if (!open) {
    slot_.drop();
    clearClient();
  }
}

template <typename Device>
void HandServer<Device>::serve(bool stops_only) {
  slot_.serve([this, stops_only](Connection& client) { return serveOne(client, stops_only); },
              [this] { clearClient(); });
}

template <typename Device>
Served HandServer<Device>::serveOne(Connection& client, bool stops_only) {
  using franka_core::fci::CodecError;
  Header header;
  const franka_core::fci::Bytes stream = client.received();
  const CodecError framing =
      franka_core::fci::gripper::nextMessage(stream, Device::kMaxRequestSize, header);
  if (framing != CodecError::kNone) {
    return framing == CodecError::kIncomplete ? Served::kIncomplete : Served::kBroken;
  }
  Request request;
  if (decodeRequest({stream.data, header.size}, header, request) != CodecError::kNone) {
    return Served::kBroken;
  }
  if (stops_only && slot_.confirmed() && commandOf(request) != Command::kStop) {
    return Served::kHeldBack;
  }
  client.consume(header.size);
  const auto* connection = std::get_if<ConnectRequest>(&request);
  const bool connection_valid = connection != nullptr ? connect(header, *connection)
                                                      : slot_.confirmed() && start(header, request);
  return connection_valid ? Served::kDone : Served::kBroken;
}

template <typename Device>
bool HandServer<Device>::connect(const Header& header, const ConnectRequest& request) {
  const bool fits = Device::supportsVersion(request.version);
  if (!reply(Command::kConnect, header.command_id, fits ? Status::kSuccess : Status::kFail,
             fits ? request.version : Device::kNewestVersion)) {
    return false;
  }
  if (fits) {
    slot_.confirm();
    sockaddr_in peer = slot_.peer();
    peer.sin_port = htons(request.udp_port);
    datagrams_.setPeer(peer);
    state_sent_at_ = {};
  }
  return true;
}

template <typename Device>
bool HandServer<Device>::start(const Header& header, const Request& request) {
  const TicketLog::Ticket ticket = Device::start(unit_, request);
  const Command command = commandOf(request);
  if (ticket == 0) {
    return reply(command, header.command_id, Status::kFail);
  }
  // The unit has ended the previous command; its reply goes first.
  if (!replyToEnded()) {
    return false;
  }
  running_ = Running{command, header.command_id, ticket};
  return replyToEnded();
}

template <typename Device>
bool HandServer<Device>::replyToEnded() {
  if (!running_ || unit_.outcome(running_->ticket) == GripperOutcome::kRunning) {
    return true;
  }
  const Running ended = *running_;
  running_.reset();
  return reply(ended.command, ended.id, toStatus(unit_.outcome(ended.ticket)));
}

template <typename Device>
bool HandServer<Device>::reply(Command command, std::uint32_t id, Status status,
                               std::uint16_t version) {
  franka_core::fci::gripper::Reply reply;
  reply.status = status;
  reply.server_version = version;
  typename Device::ReplyMessage message;
  return encodeReply(command, id, reply, message) == franka_core::fci::CodecError::kNone &&
         slot_.client()->send(message.bytes());
}

template <typename Device>
void HandServer<Device>::publish(std::uint64_t milliseconds) {
  message_id_ += milliseconds;
  if (!slot_.confirmed()) {
    return;
  }
  const auto now = std::chrono::steady_clock::now();
  const bool ended = running_ && unit_.outcome(running_->ticket) != GripperOutcome::kRunning;
  if (ended || now - state_sent_at_ >= kStatePeriod) {
    state_sent_at_ = now;
    const auto state = Device::encode(unit_, static_cast<std::uint32_t>(message_id_));
    datagrams_.send({state.data(), state.size()});
  }
  if (!replyToEnded()) {
    slot_.drop();
    clearClient();
  }
}

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
