// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/exception.h>
#include <franka/extensions.h>
#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/gripper_codec.h>
#include <franka_core/fci/texts.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <type_traits>

#include "network/command_channel.h"
#include "network/datagram_socket.h"

namespace franka {

/// Common part of hand and vacuum gripper: requests with one reply, and states that arrive
/// continuously.
///
/// Protocol describes one of the two: the types of its codec, kPort, kOldest, kNewest, and
/// kTextPrefix, the start of its texts. The functions of the codec are found by these types.
/// Threads: execute from any number, readOnce from one at a time.
template <typename Protocol>
class GripperConnection {
 public:
  using Request = typename Protocol::Request;
  using State = typename Protocol::State;
  using Status = franka_core::fci::gripper::Status;
  using Reply = franka_core::fci::gripper::Reply;

  /// @throws NetworkException, IncompatibleVersionException
  explicit GripperConnection(const std::string& address)
      : timeouts_(timeouts()), datagrams_(std::min(timeouts_.state, kSlice)) {
    const network::Endpoint endpoint = network::parseEndpoint(address, Protocol::kPort);
    const Deadline deadline = network::Clock::now() + timeouts_.connect;
    const std::optional<std::uint16_t> required = offer(endpoint, Protocol::kNewest, deadline);
    if (!required) {
      return;
    }
    // A gripper accepts only its own version, and replies with it.
    // NOLINTNEXTLINE(misc-redundant-expression)  kOldest and kNewest are the same in some protocols
    if (*required < Protocol::kOldest || *required >= Protocol::kNewest ||
        offer(endpoint, *required, deadline)) {
      throw IncompatibleVersionException(*required, Protocol::kNewest);
    }
  }

  std::uint16_t version() const noexcept { return version_; }

  /// @returns whether the gripper succeeded.
  /// @throws CommandException if the command failed or was aborted.
  /// @throws NetworkException if no reply arrives within `bound`.
  bool execute(const Request& request, std::chrono::milliseconds bound) {
    const Reply reply = decode(request, await(request, network::Clock::now() + bound, bound));
    switch (reply.status) {
      case Status::kSuccess:
        return true;
      case Status::kUnsuccessful:
        return false;
      case Status::kAborted:
        throw CommandException(text(franka_core::fci::kGripperAborted));
      case Status::kFail:
        break;
    }
    throw CommandException(text(franka_core::fci::kGripperFailed));
  }

  /// The state in the next datagram, after those already received.
  State readOnce() {
    channel_->checkProcess();
    const std::unique_lock<std::mutex> lock(state_mutex_, std::try_to_lock);
    if (!lock.owns_lock()) {
      throw InvalidOperationException(
          text("Cannot perform this operation while another read operation is running."));
    }
    typename Protocol::StateBuffer buffer;
    while (datagrams_.tryReceive(buffer.data(), buffer.size()).any) {
    }
    const Deadline deadline = network::Clock::now() + stateBound();
    auto received = datagrams_.receive(buffer.data(), buffer.size());
    while (!received.any) {
      if (channel_->closedByServer()) {
        throw NetworkException(franka_core::fci::kServerClosed);
      }
      if (network::Clock::now() >= deadline) {
        throw NetworkException(franka_core::fci::kStateTimeout);
      }
      received = datagrams_.receive(buffer.data(), buffer.size());
    }
    State state;
    if (decodeState({buffer.data(), received.size}, state) != franka_core::fci::CodecError::kNone) {
      throw ProtocolException(franka_core::fci::kWrongObjectSize);
    }
    datagrams_.accept();
    return state;
  }

  /// Bound of long commands, such as homing.
  std::chrono::milliseconds longBound() const noexcept { return timeouts_.long_command; }

 private:
  using Deadline = network::Clock::time_point;

  // Period at which a wait for a state checks the connection.
  static constexpr std::chrono::milliseconds kSlice{50};

  // Load may stop a simulated hand for a while.
  std::chrono::milliseconds stateBound() const noexcept {
    return channel_->serverIsLoopback() ? std::max(timeouts_.state, timeouts_.silence)
                                        : timeouts_.state;
  }

  static std::string text(const std::string& ending) { return Protocol::kTextPrefix + ending; }

  static franka_core::fci::CodecError findMessage(franka_core::fci::Bytes stream, std::uint32_t& id,
                                                  std::size_t& size) {
    franka_core::fci::gripper::Header header;
    const auto error = franka_core::fci::gripper::nextMessage(
        stream, franka_core::fci::gripper::kMaxReceivedReplySize, header);
    id = header.command_id;
    size = header.size;
    return error;
  }

  /// @returns the version that the gripper requires instead, or nothing if it agrees.
  std::optional<std::uint16_t> offer(const network::Endpoint& endpoint, std::uint16_t version,
                                     Deadline deadline) {
    channel_.reset();
    channel_ = std::make_unique<network::CommandChannel>(endpoint, findMessage, deadline);
    const Request request = franka_core::fci::gripper::ConnectRequest{version, datagrams_.port()};
    const Reply reply = decode(request, await(request, deadline, timeouts_.connect));
    version_ = reply.status == Status::kSuccess ? reply.server_version : version;
    return reply.status == Status::kSuccess ? std::nullopt
                                            : std::make_optional(reply.server_version);
  }

  network::CommandChannel::Message await(const Request& request, Deadline deadline,
                                         std::chrono::milliseconds bound) {
    struct ReplyEraser {
      network::CommandChannel& channel;
      std::uint32_t id;
      ~ReplyEraser() { channel.discardReplies(id); }
    };
    const std::uint32_t id = channel_->expect();
    const ReplyEraser eraser{*channel_, id};
    typename Protocol::RequestMessage message;
    encodeRequest(id, request, message);
    channel_->send(message.bytes());
    auto reply = channel_->receive(id, deadline);
    if (!reply) {
      throw NetworkException(std::string(franka_core::fci::kConnectionTimeout) +
                             " The gripper has not answered within " +
                             std::to_string(bound.count()) + " ms.");
    }
    return std::move(*reply);
  }

  Reply decode(const Request& request, const network::CommandChannel::Message& message) {
    franka_core::fci::gripper::Header header;
    Reply reply;
    const auto error =
        decodeReply(commandOf(request), {message.data(), message.size()}, header, reply);
    if (error != franka_core::fci::CodecError::kNone) {
      throw ProtocolException(text("Unexpected response while handling a command!"));
    }
    return reply;
  }

  const Timeouts timeouts_;
  network::DatagramSocket datagrams_;
  std::unique_ptr<network::CommandChannel> channel_;
  std::uint16_t version_{0};
  std::mutex state_mutex_;
};

}  // namespace franka
