// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/gripper_codec.h>

#include "gripper_framing.h"

namespace franka_core::fci::gripper {

namespace {

constexpr std::uint16_t kConnect = 0;

// Bytes after the header, in the order of Command (protocol 7.1).
constexpr std::array<std::size_t, 5> kPayload{{4, 0, 40, 16, 0}};

void write(const ConnectRequest& request, wire::Writer& writer) noexcept {
  writeConnect(request, writer);
}
void write(const HomingRequest&, wire::Writer&) noexcept {}
void write(const GraspRequest& request, wire::Writer& writer) noexcept {
  writer(request.width, request.epsilon_inner, request.epsilon_outer, request.speed, request.force);
}
void write(const MoveRequest& request, wire::Writer& writer) noexcept {
  writer(request.width, request.speed);
}
void write(const StopRequest&, wire::Writer&) noexcept {}

GraspRequest readGrasp(wire::Reader& reader) noexcept {
  GraspRequest request;
  reader(request.width, request.epsilon_inner, request.epsilon_outer, request.speed, request.force);
  return request;
}

MoveRequest readMove(wire::Reader& reader) noexcept {
  MoveRequest request;
  reader(request.width, request.speed);
  return request;
}

// The last status of a reply to this command.
std::uint16_t lastStatus(std::uint16_t command) noexcept {
  return static_cast<std::uint16_t>(command == kConnect ? Status::kFail : Status::kAborted);
}

std::size_t sizeOfReply(std::uint16_t command) noexcept {
  return kHeaderSize + sizeof(std::uint16_t) + (command == kConnect ? sizeof(std::uint16_t) : 0);
}

}  // namespace

CodecError nextMessage(Bytes stream, std::size_t max_size, Header& header) noexcept {
  if (stream.size < kHeaderSize) {
    return CodecError::kIncomplete;
  }
  wire::Reader reader(stream.data);
  header.command = reader.integer<std::uint16_t>();
  header.command_id = reader.integer<std::uint32_t>();
  header.size = reader.integer<std::uint32_t>();
  if (header.size < kHeaderSize) {
    return CodecError::kWrongSize;
  }
  if (header.size > max_size) {
    return CodecError::kTooLong;
  }
  return header.size > stream.size ? CodecError::kIncomplete : CodecError::kNone;
}

std::size_t requestSize(Command command) noexcept {
  return sizeOfRequest(kPayload, static_cast<std::size_t>(command));
}

void encodeRequest(std::uint32_t command_id, const Request& request,
                   RequestMessage& message) noexcept {
  writeRequest(kPayload, command_id, request, message,
               [](const auto& fields, wire::Writer& writer) noexcept { write(fields, writer); });
}

CodecError decodeRequest(Bytes message, Header& header, Request& request) noexcept {
  const CodecError error = readRequestHeader(kPayload, kMaxRequestSize, message, header);
  if (error != CodecError::kNone) {
    return error;
  }
  wire::Reader reader(message.data + kHeaderSize);
  switch (static_cast<Command>(header.command)) {
    case Command::kConnect:
      request = readConnect(reader);
      break;
    case Command::kHoming:
      request = HomingRequest{};
      break;
    case Command::kGrasp:
      request = readGrasp(reader);
      break;
    case Command::kMove:
      request = readMove(reader);
      break;
    case Command::kStop:
      request = StopRequest{};
      break;
  }
  return CodecError::kNone;
}

CodecError encodeReply(std::uint16_t command, std::uint32_t command_id, const Reply& reply,
                       ReplyMessage& message) noexcept {
  message.size = 0;
  const auto status = static_cast<std::uint16_t>(reply.status);
  if (status > lastStatus(command)) {
    return CodecError::kUnknownStatus;
  }
  wire::Writer writer(message.data);
  writeHeader(command, command_id, sizeOfReply(command), writer);
  writer.integer(status);
  if (command == kConnect) {
    writer.integer(reply.server_version);
  }
  message.size = sizeOfReply(command);
  return CodecError::kNone;
}

CodecError decodeReply(std::uint16_t command, Bytes message, Header& header,
                       Reply& reply) noexcept {
  // As with the robot, a reply to Connect may be longer.
  const std::size_t size = sizeOfReply(command);
  if (!isWhole(message, kMaxReceivedReplySize, header) || message.size < size ||
      (message.size > size && command != kConnect)) {
    return CodecError::kWrongSize;
  }
  wire::Reader reader(message.data + kHeaderSize);
  const auto status = reader.integer<std::uint16_t>();
  if (status > lastStatus(command)) {
    return CodecError::kUnknownStatus;
  }
  reply = Reply{};
  reply.status = static_cast<Status>(status);
  if (command == kConnect) {
    reply.server_version = reader.integer<std::uint16_t>();
  }
  return CodecError::kNone;
}

void encodeState(const State& state, StateBuffer& buffer) noexcept {
  wire::Writer writer(buffer.data());
  writer.integer(state.message_id);
  writer(state.width, state.max_width, state.is_grasped);
  writer.integer(state.temperature);
}

CodecError decodeState(Bytes datagram, State& state) noexcept {
  if (datagram.size != kStateSize) {
    return CodecError::kWrongSize;
  }
  wire::Reader reader(datagram.data);
  State read;
  read.message_id = reader.integer<std::uint32_t>();
  reader(read.width, read.max_width, read.is_grasped);
  read.temperature = reader.integer<std::uint16_t>();
  if (reader.booleans() == CodecError::kNone) {
    state = read;
  }
  return reader.booleans();
}

}  // namespace franka_core::fci::gripper
