// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/request_codec.h>

#include <initializer_list>

#include "command_table.h"
#include "wire.h"

namespace franka_core::fci {

namespace {

constexpr std::uint8_t kLastRequestedController =
    static_cast<std::uint8_t>(ControllerMode::kExternalController);

// Each request's fields in the order of the wire (protocol 3.2), const where the request is.
template <typename Visitor, typename T>
void visitDeviation(Visitor& visit, T& deviation) noexcept {
  visit(deviation.translation, deviation.rotation, deviation.elbow);
}

template <typename Visitor, typename T>
void visitFields(Visitor& visit, T& request) noexcept {
  using Plain = std::remove_const_t<T>;
  if constexpr (std::is_same_v<Plain, SetCollisionBehaviorRequest>) {
    visit(request.lower_torques_acceleration, request.upper_torques_acceleration,
          request.lower_torques_nominal, request.upper_torques_nominal,
          request.lower_forces_acceleration, request.upper_forces_acceleration,
          request.lower_forces_nominal, request.upper_forces_nominal);
  } else if constexpr (std::is_same_v<Plain, SetJointImpedanceRequest>) {
    visit(request.K_theta);
  } else if constexpr (std::is_same_v<Plain, SetCartesianImpedanceRequest>) {
    visit(request.K_x);
  } else if constexpr (std::is_same_v<Plain, SetGuidingModeRequest>) {
    visit(request.guiding_mode, request.nullspace);
  } else if constexpr (std::is_same_v<Plain, SetEEToKRequest>) {
    visit(request.EE_T_K);
  } else if constexpr (std::is_same_v<Plain, SetNEToEERequest>) {
    visit(request.NE_T_EE);
  } else if constexpr (std::is_same_v<Plain, SetLoadRequest>) {
    visit(request.mass, request.F_x_Cload, request.inertia);
  } else if constexpr (std::is_same_v<Plain, SetFiltersRequest>) {
    visit(request.joint_position, request.joint_velocity, request.cartesian_position,
          request.cartesian_velocity, request.controller);
  }
}

template <typename T>
CodecError write(std::uint16_t /*version*/, const T& request, wire::Writer& writer) noexcept {
  visitFields(writer, request);
  return CodecError::kNone;
}

CodecError write(std::uint16_t /*version*/, const ConnectRequest& request,
                 wire::Writer& writer) noexcept {
  writer.integer(request.version);
  writer.integer(request.udp_port);
  return CodecError::kNone;
}

// In the request, numbers of motion generators start at joint positions; in the state at idle.
CodecError write(std::uint16_t version, const MoveRequest& request, wire::Writer& writer) noexcept {
  const auto controller = static_cast<std::uint8_t>(request.controller_mode);
  const auto generator = static_cast<std::uint8_t>(request.motion_generator_mode);
  if (controller > kLastRequestedController || generator == 0 ||
      request.motion_generator_mode > MotionGeneratorMode::kNone) {
    return CodecError::kUnknownEnum;
  }
  const bool torque_only = request.motion_generator_mode == MotionGeneratorMode::kNone;
  if ((torque_only && !hasTorqueOnlyMove(version)) ||
      (request.use_async_motion_generator && !hasAsyncMotion(version))) {
    return CodecError::kNotInThisVersion;
  }
  writer.integer<std::uint32_t>(controller);
  writer.integer<std::uint32_t>(generator - 1U);
  visitDeviation(writer, request.max_path_deviation);
  visitDeviation(writer, request.max_goal_deviation);
  if (hasAsyncMotion(version)) {
    writer(request.use_async_motion_generator, request.maximum_velocity);
  }
  return CodecError::kNone;
}

CodecError write(std::uint16_t /*version*/, const GetCartesianLimitRequest& request,
                 wire::Writer& writer) noexcept {
  writer.integer(static_cast<std::uint32_t>(request.id));
  return CodecError::kNone;
}

CodecError write(std::uint16_t /*version*/, const LoadModelLibraryRequest& request,
                 wire::Writer& writer) noexcept {
  writer.integer(static_cast<std::uint8_t>(request.architecture));
  writer.integer(static_cast<std::uint8_t>(request.system));
  return CodecError::kNone;
}

template <typename T>
CodecError read(std::uint16_t /*version*/, wire::Reader& reader, T& request) noexcept {
  visitFields(reader, request);
  return reader.booleans();
}

CodecError read(std::uint16_t /*version*/, wire::Reader& reader, ConnectRequest& request) noexcept {
  request.version = reader.integer<std::uint16_t>();
  request.udp_port = reader.integer<std::uint16_t>();
  return CodecError::kNone;
}

CodecError read(std::uint16_t version, wire::Reader& reader, MoveRequest& request) noexcept {
  const auto controller = reader.integer<std::uint32_t>();
  const auto generator = reader.integer<std::uint32_t>();
  constexpr auto kTorqueOnly = static_cast<std::uint32_t>(MotionGeneratorMode::kNone) - 1U;
  if (controller > kLastRequestedController || generator > kTorqueOnly) {
    return CodecError::kUnknownEnum;
  }
  if (generator == kTorqueOnly && !hasTorqueOnlyMove(version)) {
    return CodecError::kNotInThisVersion;
  }
  request.controller_mode = static_cast<ControllerMode>(controller);
  request.motion_generator_mode = static_cast<MotionGeneratorMode>(generator + 1U);
  visitDeviation(reader, request.max_path_deviation);
  visitDeviation(reader, request.max_goal_deviation);
  if (hasAsyncMotion(version)) {
    reader(request.use_async_motion_generator, request.maximum_velocity);
  }
  return reader.booleans();
}

CodecError read(std::uint16_t /*version*/, wire::Reader& reader,
                GetCartesianLimitRequest& request) noexcept {
  request.id = static_cast<std::int32_t>(reader.integer<std::uint32_t>());
  return CodecError::kNone;
}

CodecError read(std::uint16_t /*version*/, wire::Reader& reader,
                LoadModelLibraryRequest& request) noexcept {
  const auto architecture = reader.integer<std::uint8_t>();
  const auto system = reader.integer<std::uint8_t>();
  if (architecture > static_cast<std::uint8_t>(Architecture::kArm64) ||
      system > static_cast<std::uint8_t>(OperatingSystem::kWindows)) {
    return CodecError::kUnknownEnum;
  }
  request.architecture = static_cast<Architecture>(architecture);
  request.system = static_cast<OperatingSystem>(system);
  return CodecError::kNone;
}

// The empty request of a command, found in the list of all.
template <std::size_t kIndex = 0>
Request emptyRequest(std::size_t index) noexcept {
  if constexpr (kIndex + 1 < kCommandCount) {
    if (index != kIndex) {
      return emptyRequest<kIndex + 1>(index);
    }
  }
  return Request(std::in_place_index<kIndex>);
}

}  // namespace

std::optional<std::uint32_t> commandNumber(std::uint16_t version, Command command) noexcept {
  if (!isRobotVersion(version) || static_cast<std::size_t>(command) >= kCommandCount) {
    return std::nullopt;
  }
  const std::int8_t number = table::numberOf(version, command);
  if (number < 0) {
    return std::nullopt;
  }
  return static_cast<std::uint32_t>(number);
}

std::optional<Command> commandFromNumber(std::uint16_t version, std::uint32_t number) noexcept {
  for (std::size_t i = 0; i < kCommandCount; i++) {
    const auto command = static_cast<Command>(i);
    if (commandNumber(version, command) == number) {
      return command;
    }
  }
  return std::nullopt;
}

std::size_t requestSize(std::uint16_t version, Command command) noexcept {
  if (!commandNumber(version, command)) {
    return 0;
  }
  const bool async = command == Command::kMove && hasAsyncMotion(version);
  return kHeaderSize + table::rowOf(command).payload + (async ? table::kAsyncMovePayload : 0);
}

CodecError nextMessage(Bytes stream, std::size_t max_size, Header& header) noexcept {
  if (stream.size < kHeaderSize) {
    return CodecError::kIncomplete;
  }
  wire::Reader reader(stream.data);
  header.command = reader.integer<std::uint32_t>();
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

CodecError encodeRequest(std::uint16_t version, std::uint32_t command_id, const Request& request,
                         RequestMessage& message) noexcept {
  message.size = 0;
  if (!isRobotVersion(version)) {
    return CodecError::kUnknownVersion;
  }
  const std::optional<std::uint32_t> number = commandNumber(version, commandOf(request));
  if (!number) {
    return CodecError::kNotInThisVersion;
  }
  const std::size_t size = requestSize(version, commandOf(request));
  wire::Writer writer(message.data);
  writer.integer(*number);
  writer.integer(command_id);
  writer.integer(static_cast<std::uint32_t>(size));
  const CodecError error = std::visit(
      [&](const auto& fields) noexcept { return write(version, fields, writer); }, request);
  if (error == CodecError::kNone) {
    message.size = size;
  }
  return error;
}

CodecError decodeRequest(std::uint16_t version, Bytes message, Header& header,
                         Request& request) noexcept {
  if (!isRobotVersion(version)) {
    return CodecError::kUnknownVersion;
  }
  const CodecError framing = nextMessage(message, kMaxRequestSize, header);
  if (framing != CodecError::kNone || header.size != message.size) {
    return CodecError::kWrongSize;
  }
  const std::optional<Command> command = commandFromNumber(version, header.command);
  if (!command) {
    return CodecError::kUnknownCommand;
  }
  if (message.size != requestSize(version, *command)) {
    return CodecError::kWrongSize;
  }
  Request result = emptyRequest(static_cast<std::size_t>(*command));
  wire::Reader reader(message.data + kHeaderSize);
  const CodecError error =
      std::visit([&](auto& fields) noexcept { return read(version, reader, fields); }, result);
  if (error == CodecError::kNone) {
    request = result;
  }
  return error;
}

}  // namespace franka_core::fci
