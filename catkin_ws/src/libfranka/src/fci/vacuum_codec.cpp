// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/vacuum_codec.h>

#include "gripper_framing.h"

namespace franka_core::fci::vacuum {

namespace {

// Bytes after the header, in the order of Command (protocol 7.2).
constexpr std::array<std::size_t, 4> kPayload{{4, 10, 8, 0}};

void write(const ConnectRequest& request, wire::Writer& writer) noexcept {
  gripper::writeConnect(request, writer);
}
void write(const VacuumRequest& request, wire::Writer& writer) noexcept {
  writer.integer(request.vacuum);
  writer.integer(static_cast<std::uint8_t>(request.profile));
  writer.integer(static_cast<std::uint64_t>(request.timeout_ms));
}
void write(const DropOffRequest& request, wire::Writer& writer) noexcept {
  writer.integer(static_cast<std::uint64_t>(request.timeout_ms));
}
void write(const StopRequest&, wire::Writer&) noexcept {}

CodecError readVacuum(wire::Reader& reader, Request& request) noexcept {
  VacuumRequest vacuum;
  vacuum.vacuum = reader.integer<std::uint8_t>();
  const auto profile = reader.integer<std::uint8_t>();
  vacuum.timeout_ms = static_cast<std::int64_t>(reader.integer<std::uint64_t>());
  if (profile > static_cast<std::uint8_t>(Profile::kP3)) {
    return CodecError::kUnknownEnum;
  }
  vacuum.profile = static_cast<Profile>(profile);
  request = vacuum;
  return CodecError::kNone;
}

}  // namespace

std::size_t requestSize(Command command) noexcept {
  const auto index = static_cast<std::size_t>(command);
  return index < kPayload.size() ? gripper::kHeaderSize + kPayload[index] : 0;
}

std::size_t replySize(Command command) noexcept {
  return gripper::kPlainReplySize + (command == Command::kConnect ? sizeof(std::uint16_t) : 0);
}

void encodeRequest(std::uint32_t command_id, const Request& request,
                   RequestMessage& message) noexcept {
  const Command command = commandOf(request);
  message.size = requestSize(command);
  wire::Writer writer(message.data);
  gripper::writeHeader(static_cast<std::uint16_t>(command), command_id, message.size, writer);
  std::visit([&](const auto& fields) noexcept { write(fields, writer); }, request);
}

CodecError decodeRequest(Bytes message, Header& header, Request& request) noexcept {
  if (!gripper::isWhole(message, kMaxRequestSize, header)) {
    return CodecError::kWrongSize;
  }
  if (header.command >= kPayload.size()) {
    return CodecError::kUnknownCommand;
  }
  const auto command = static_cast<Command>(header.command);
  if (message.size != requestSize(command)) {
    return CodecError::kWrongSize;
  }
  wire::Reader reader(message.data + gripper::kHeaderSize);
  switch (command) {
    case Command::kConnect: {
      ConnectRequest connect;
      gripper::readConnect(reader, connect);
      request = connect;
      break;
    }
    case Command::kVacuum:
      return readVacuum(reader, request);
    case Command::kDropOff:
      request = DropOffRequest{static_cast<std::int64_t>(reader.integer<std::uint64_t>())};
      break;
    case Command::kStop:
      request = StopRequest{};
      break;
  }
  return CodecError::kNone;
}

CodecError encodeReply(Command command, std::uint32_t command_id, const Reply& reply,
                       ReplyMessage& message) noexcept {
  return gripper::writeReply(static_cast<std::uint16_t>(command), command_id, reply, message);
}

CodecError decodeReply(Command command, Bytes message, Header& header, Reply& reply) noexcept {
  return gripper::readReply(static_cast<std::uint16_t>(command), message, header, reply);
}

void encodeState(const State& state, StateBuffer& buffer) noexcept {
  wire::Writer writer(buffer.data());
  writer.integer(state.message_id);
  writer(state.in_control_range, state.part_detached, state.part_present);
  writer.integer(static_cast<std::uint8_t>(state.device_status));
  writer.integer(static_cast<std::uint32_t>(state.actual_power));
  writer.integer(static_cast<std::uint32_t>(state.vacuum));
}

CodecError decodeState(Bytes datagram, State& state) noexcept {
  if (datagram.size != kStateSize) {
    return CodecError::kWrongSize;
  }
  wire::Reader reader(datagram.data);
  State read;
  read.message_id = reader.integer<std::uint32_t>();
  reader(read.in_control_range, read.part_detached, read.part_present);
  const auto device_status = reader.integer<std::uint8_t>();
  read.device_status = static_cast<DeviceStatus>(device_status);
  read.actual_power = static_cast<std::int32_t>(reader.integer<std::uint32_t>());
  read.vacuum = static_cast<std::int32_t>(reader.integer<std::uint32_t>());
  if (reader.booleans() != CodecError::kNone) {
    return reader.booleans();
  }
  if (device_status > static_cast<std::uint8_t>(DeviceStatus::kRed)) {
    return CodecError::kUnknownEnum;
  }
  state = read;
  return CodecError::kNone;
}

}  // namespace franka_core::fci::vacuum
