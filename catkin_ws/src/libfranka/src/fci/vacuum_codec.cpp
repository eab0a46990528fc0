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
  return gripper::sizeOfRequest(kPayload, static_cast<std::size_t>(command));
}

void encodeRequest(std::uint32_t command_id, const Request& request,
                   RequestMessage& message) noexcept {
  gripper::writeRequest(
      kPayload, command_id, request, message,
      [](const auto& fields, wire::Writer& writer) noexcept { write(fields, writer); });
}

CodecError decodeRequest(Bytes message, Header& header, Request& request) noexcept {
  const CodecError error = gripper::readRequestHeader(kPayload, kMaxRequestSize, message, header);
  if (error != CodecError::kNone) {
    return error;
  }
  wire::Reader reader(message.data + gripper::kHeaderSize);
  switch (static_cast<Command>(header.command)) {
    case Command::kConnect:
      request = gripper::readConnect(reader);
      break;
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
