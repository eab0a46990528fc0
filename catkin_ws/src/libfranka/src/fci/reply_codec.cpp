// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/reply_codec.h>

#include "wire.h"

namespace franka_core::fci {

namespace {

// The statuses of one kind of command in the order of their numbers (protocol 3.3).
struct Statuses {
  std::size_t count;
  std::array<Status, 12> in_order;
};

using S = Status;
constexpr S kUnsafe = S::kRejectedDueToActivatedSafetyFunctions;

constexpr Statuses kConnect{2, {{S::kSuccess, S::kIncompatibleLibraryVersion}}};
constexpr Statuses kLibrary{2, {{S::kSuccess, S::kError}}};
constexpr Statuses kPlain{2, {{S::kSuccess, S::kCommandNotPossibleRejected}}};
constexpr Statuses kPlain6{3, {{S::kSuccess, S::kCommandNotPossibleRejected, kUnsafe}}};
constexpr Statuses kSetter{
    3, {{S::kSuccess, S::kCommandNotPossibleRejected, S::kInvalidArgumentRejected}}};
constexpr Statuses kSetter6{
    4, {{S::kSuccess, S::kCommandNotPossibleRejected, S::kInvalidArgumentRejected, kUnsafe}}};
constexpr Statuses kMove{
    10,
    {{S::kSuccess, S::kMotionStarted, S::kPreempted, S::kCommandNotPossibleRejected,
      S::kStartAtSingularPoseRejected, S::kInvalidArgumentRejected, S::kReflexAborted,
      S::kEmergencyAborted, S::kInputErrorAborted, S::kAborted}}};
constexpr Statuses kMove6{
    12,
    {{S::kSuccess, S::kMotionStarted, S::kPreempted, S::kPreemptedDueToActivatedSafetyFunctions,
      kUnsafe, S::kCommandNotPossibleRejected, S::kStartAtSingularPoseRejected,
      S::kInvalidArgumentRejected, S::kReflexAborted, S::kEmergencyAborted, S::kInputErrorAborted,
      S::kAborted}}};
constexpr Statuses kStop{5,
                         {{S::kSuccess, S::kCommandNotPossibleRejected, S::kEmergencyAborted,
                           S::kReflexAborted, S::kAborted}}};
constexpr Statuses kStop6{6,
                          {{S::kSuccess, S::kCommandNotPossibleRejected, kUnsafe,
                            S::kEmergencyAborted, S::kReflexAborted, S::kAborted}}};
constexpr Statuses kRecovery{
    6,
    {{S::kSuccess, S::kCommandNotPossibleRejected, S::kManualErrorRecoveryRequiredRejected,
      S::kReflexAborted, S::kEmergencyAborted, S::kAborted}}};
constexpr Statuses kRecovery6{
    7,
    {{S::kSuccess, S::kCommandNotPossibleRejected, kUnsafe, S::kManualErrorRecoveryRequiredRejected,
      S::kReflexAborted, S::kEmergencyAborted, S::kAborted}}};

const Statuses& statuses(std::uint16_t version, Command command) noexcept {
  const bool safety = hasSafetyFunctions(version);
  switch (command) {
    case Command::kConnect:
      return kConnect;
    case Command::kLoadModelLibrary:
      return kLibrary;
    case Command::kMove:
      return safety ? kMove6 : kMove;
    case Command::kStopMove:
      return safety ? kStop6 : kStop;
    case Command::kAutomaticErrorRecovery:
      return safety ? kRecovery6 : kRecovery;
    case Command::kGetRobotModel:
      return safety ? kPlain6 : kPlain;
    default:
      return safety ? kSetter6 : kSetter;
  }
}

constexpr std::size_t kPlainReplySize = kHeaderSize + 1;

bool carriesModel(Command command) noexcept {
  return command == Command::kLoadModelLibrary || command == Command::kGetRobotModel;
}

CodecError checkCommand(std::uint16_t version, Command command) noexcept {
  if (!isRobotVersion(version)) {
    return CodecError::kUnknownVersion;
  }
  return commandNumber(version, command) ? CodecError::kNone : CodecError::kNotInThisVersion;
}

void writeHead(std::uint32_t number, std::uint32_t command_id, std::size_t size,
               std::uint8_t status, wire::Writer& writer) noexcept {
  writer.integer(number);
  writer.integer(command_id);
  writer.integer(static_cast<std::uint32_t>(size));
  writer.integer(status);
}

}  // namespace

std::size_t replySize(std::uint16_t version, Command command) noexcept {
  if (!commandNumber(version, command)) {
    return 0;
  }
  switch (command) {
    case Command::kConnect:
      return kPlainReplySize + sizeof(std::uint16_t);
    case Command::kGetCartesianLimit:
      return kMaxFixedReplySize;
    default:
      return kPlainReplySize;
  }
}

std::optional<std::uint8_t> statusNumber(std::uint16_t version, Command command,
                                         Status status) noexcept {
  if (checkCommand(version, command) != CodecError::kNone) {
    return std::nullopt;
  }
  const Statuses& list = statuses(version, command);
  for (std::size_t i = 0; i < list.count; i++) {
    if (list.in_order[i] == status) {
      return static_cast<std::uint8_t>(i);
    }
  }
  return std::nullopt;
}

std::optional<Status> statusFromNumber(std::uint16_t version, Command command,
                                       std::uint8_t number) noexcept {
  if (checkCommand(version, command) != CodecError::kNone) {
    return std::nullopt;
  }
  const Statuses& list = statuses(version, command);
  if (number >= list.count) {
    return std::nullopt;
  }
  return list.in_order[number];
}

CodecError encodeReply(std::uint16_t version, Command command, std::uint32_t command_id,
                       const Reply& reply, ReplyMessage& message) noexcept {
  message.size = 0;
  const CodecError error = checkCommand(version, command);
  if (error != CodecError::kNone) {
    return error;
  }
  const std::optional<std::uint8_t> status = statusNumber(version, command, reply.status);
  if (!status) {
    return CodecError::kUnknownStatus;
  }
  const std::size_t size = replySize(version, command);
  wire::Writer writer(message.data);
  writeHead(*commandNumber(version, command), command_id, size, *status, writer);
  if (command == Command::kConnect) {
    writer.integer(reply.server_version);
  } else if (command == Command::kGetCartesianLimit) {
    writer(reply.cartesian_limit.object_world_size, reply.cartesian_limit.object_frame,
           reply.cartesian_limit.active);
  }
  message.size = size;
  return CodecError::kNone;
}

CodecError encodeModelReplyHead(std::uint16_t version, Command command, std::uint32_t command_id,
                                std::size_t model_size, ReplyMessage& message) noexcept {
  message.size = 0;
  const CodecError error = checkCommand(version, command);
  if (error != CodecError::kNone) {
    return error;
  }
  if (!carriesModel(command)) {
    return CodecError::kNotInThisVersion;
  }
  if (model_size > kMaxReplySize - kPlainReplySize) {
    return CodecError::kTooLong;
  }
  wire::Writer writer(message.data);
  writeHead(*commandNumber(version, command), command_id, kPlainReplySize + model_size,
            *statusNumber(version, command, Status::kSuccess), writer);
  message.size = kPlainReplySize;
  return CodecError::kNone;
}

CodecError encodeModelReply(std::uint16_t version, Command command, std::uint32_t command_id,
                            Bytes model, std::vector<std::uint8_t>& message) {
  ReplyMessage head;
  const CodecError error = encodeModelReplyHead(version, command, command_id, model.size, head);
  message.assign(head.data, head.data + head.size);
  if (error == CodecError::kNone && model.size > 0) {
    message.insert(message.end(), model.data, model.data + model.size);
  }
  return error;
}

CodecError decodeReply(std::uint16_t version, Command command, Bytes message, Header& header,
                       Reply& reply, Bytes& model) noexcept {
  model = Bytes{};
  const CodecError known = checkCommand(version, command);
  if (known != CodecError::kNone) {
    return known;
  }
  const CodecError framing = nextMessage(message, kMaxReplySize, header);
  const std::size_t size = replySize(version, command);
  // Genuine clients accept a longer reply to Connect, which some servers send.
  const bool open_ended = carriesModel(command) || command == Command::kConnect;
  const bool fits = open_ended ? message.size >= size : message.size == size;
  if (framing != CodecError::kNone || header.size != message.size || !fits) {
    return CodecError::kWrongSize;
  }
  wire::Reader reader(message.data + kHeaderSize);
  const std::optional<Status> status =
      statusFromNumber(version, command, reader.integer<std::uint8_t>());
  if (!status) {
    return CodecError::kUnknownStatus;
  }
  Reply result;
  result.status = *status;
  if (command == Command::kConnect) {
    result.server_version = reader.integer<std::uint16_t>();
  } else if (command == Command::kGetCartesianLimit) {
    reader(result.cartesian_limit.object_world_size, result.cartesian_limit.object_frame,
           result.cartesian_limit.active);
  } else if (carriesModel(command)) {
    model = Bytes{message.data + size, message.size - size};
  }
  if (reader.booleans() != CodecError::kNone) {
    return reader.booleans();
  }
  reply = result;
  return CodecError::kNone;
}

}  // namespace franka_core::fci
