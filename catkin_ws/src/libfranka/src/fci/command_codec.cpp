// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/command_codec.h>

#include "wire.h"

namespace franka_core::fci {

namespace {

constexpr std::size_t kSizeWithoutTorqueFinished = 370;

// All fields after the message id, in the order of the datagram (protocol 4.2).
template <typename Visitor, typename Command>
void visitFields(Visitor& visit, Command& command, std::uint16_t version) noexcept {
  visit(command.q_c, command.dq_c, command.O_T_EE_c, command.O_dP_EE_c, command.elbow_c,
        command.valid_elbow, command.motion_generation_finished, command.tau_J_d);
  if (hasTorqueOnlyMove(version)) {
    visit(command.torque_command_finished);
  }
}

}  // namespace

std::size_t commandSize(std::uint16_t version) noexcept {
  if (!isRobotVersion(version)) {
    return 0;
  }
  return kSizeWithoutTorqueFinished + (hasTorqueOnlyMove(version) ? 1 : 0);
}

CodecError encodeCommand(std::uint16_t version, const RobotCommand& command,
                         CommandBuffer& buffer) noexcept {
  if (!isRobotVersion(version)) {
    return CodecError::kUnknownVersion;
  }
  wire::Writer writer(buffer.data());
  writer.integer(command.message_id);
  visitFields(writer, command, version);
  return CodecError::kNone;
}

CodecError decodeCommand(std::uint16_t version, Bytes datagram, RobotCommand& command) noexcept {
  if (!isRobotVersion(version)) {
    return CodecError::kUnknownVersion;
  }
  if (datagram.size != commandSize(version)) {
    return CodecError::kWrongSize;
  }
  wire::Reader reader(datagram.data);
  RobotCommand read;
  read.message_id = reader.integer<std::uint64_t>();
  visitFields(reader, read, version);
  if (reader.booleans() != CodecError::kNone) {
    return reader.booleans();
  }
  command = read;
  return reader.finite() ? CodecError::kNone : CodecError::kNotFinite;
}

}  // namespace franka_core::fci
