// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>

#include <array>
#include <variant>

/// @file
/// The gripper's protocol, versions 2 and 3 (no published difference in their bytes). Framing: a
/// header of 10 bytes (u16 command, u32 command id, u32 size of header and payload); statuses are
/// u16. Pure functions without allocation or exception; widths [m], speed [m/s], force [N].

namespace franka_core::fci::gripper {

constexpr std::size_t kHeaderSize = 10;
constexpr std::size_t kMaxRequestSize = 50;
constexpr std::size_t kMaxReplySize = 14;
/// Largest reply that a client accepts (chosen here: replies to Connect may be longer than ours).
constexpr std::size_t kMaxReceivedReplySize = 256;
constexpr std::size_t kStateSize = 23;

enum class Command : std::uint16_t { kConnect, kHoming, kGrasp, kMove, kStop };

/// Statuses of all replies except Connect's, which has 0 (success) and 1 (incompatible version).
enum class Status : std::uint16_t { kSuccess, kFail, kUnsuccessful, kAborted };

struct ConnectRequest {
  std::uint16_t version{0};
  std::uint16_t udp_port{0};
};
struct HomingRequest {};
struct GraspRequest {
  double width{0.0};
  double epsilon_inner{0.005}, epsilon_outer{0.005};
  double speed{0.0};
  double force{0.0};
};
struct MoveRequest {
  double width{0.0};
  double speed{0.0};
};
struct StopRequest {};

/// In the order of Command.
using Request = std::variant<ConnectRequest, HomingRequest, GraspRequest, MoveRequest, StopRequest>;

constexpr Command commandOf(const Request& request) noexcept {
  return static_cast<Command>(request.index());
}

struct Reply {
  Status status{Status::kSuccess};  ///< for Connect: kFail is "incompatible version"
  std::uint16_t server_version{0};  ///< Connect
};

struct State {
  std::uint32_t message_id{0};  ///< [ms]
  double width{0.0};
  double max_width{0.0};
  bool is_grasped{false};
  std::uint16_t temperature{0};  ///< [deg C]
};

struct Header {
  std::uint16_t command{0};
  std::uint32_t command_id{0};
  std::uint32_t size{0};
};

using RequestMessage = Message<kMaxRequestSize>;
using ReplyMessage = Message<kMaxReplySize>;
using StateBuffer = std::array<std::uint8_t, kStateSize>;

/// Like fci::nextMessage, with the gripper's header. Also for the vacuum gripper.
CodecError nextMessage(Bytes stream, std::size_t max_size, Header& header) noexcept;

/// With header; 0 for unknown commands.
std::size_t requestSize(Command command) noexcept;

/// Client to gripper. Arguments that are not finite are passed on. decodeRequest fails with
/// kWrongSize or kUnknownCommand and fills `header` if it is complete.
void encodeRequest(std::uint32_t command_id, const Request& request,
                   RequestMessage& message) noexcept;
CodecError decodeRequest(Bytes message, Header& header, Request& request) noexcept;

/// Gripper to client. Both grippers have the same replies: a status, and for Connect (number 0 of
/// both) a version. Fails with kUnknownStatus (Connect has only two), decodeReply also with
/// kWrongSize.
CodecError encodeReply(std::uint16_t command, std::uint32_t command_id, const Reply& reply,
                       ReplyMessage& message) noexcept;
CodecError decodeReply(std::uint16_t command, Bytes message, Header& header, Reply& reply) noexcept;

/// The same for either gripper's Command.
template <typename AnyCommand>
CodecError encodeReply(AnyCommand command, std::uint32_t command_id, const Reply& reply,
                       ReplyMessage& message) noexcept {
  return encodeReply(static_cast<std::uint16_t>(command), command_id, reply, message);
}
template <typename AnyCommand>
CodecError decodeReply(AnyCommand command, Bytes message, Header& header, Reply& reply) noexcept {
  return decodeReply(static_cast<std::uint16_t>(command), message, header, reply);
}

/// The state datagram. decodeState fails with kWrongSize or kBadBoolean.
void encodeState(const State& state, StateBuffer& buffer) noexcept;
CodecError decodeState(Bytes datagram, State& state) noexcept;

}  // namespace franka_core::fci::gripper
