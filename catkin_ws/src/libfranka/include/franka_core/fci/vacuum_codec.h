// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>

/// @file
/// The vacuum gripper's protocol, version 1. Header, nextMessage, replies and statuses are the
/// gripper's.
/// Pure functions without allocation or exception.

namespace franka_core::fci::vacuum {

constexpr std::size_t kMaxRequestSize = 20;
constexpr std::size_t kStateSize = 16;

using gripper::decodeReply;
using gripper::encodeReply;
using gripper::Header;
using gripper::Reply;
using gripper::ReplyMessage;
using gripper::Status;

enum class Command : std::uint16_t { kConnect, kVacuum, kDropOff, kStop };
enum class Profile : std::uint8_t { kP0, kP1, kP2, kP3 };
enum class DeviceStatus : std::uint8_t { kGreen, kYellow, kOrange, kRed };

using ConnectRequest = gripper::ConnectRequest;
struct VacuumRequest {
  std::uint8_t vacuum{0};  ///< set point [10 mbar]
  Profile profile{Profile::kP0};
  std::int64_t timeout_ms{0};
};
struct DropOffRequest {
  std::int64_t timeout_ms{0};
};
struct StopRequest {};

/// In the order of Command.
using Request = std::variant<ConnectRequest, VacuumRequest, DropOffRequest, StopRequest>;

constexpr Command commandOf(const Request& request) noexcept {
  return static_cast<Command>(request.index());
}

struct State {
  std::uint32_t message_id{0};  ///< [ms]
  bool in_control_range{false};
  bool part_detached{false};
  bool part_present{false};
  DeviceStatus device_status{DeviceStatus::kGreen};
  std::int32_t actual_power{0};  ///< [%]
  std::int32_t vacuum{0};        ///< [mbar]
};

using RequestMessage = Message<kMaxRequestSize>;
using StateBuffer = std::array<std::uint8_t, kStateSize>;

/// Like the gripper's; decodeRequest also fails with kUnknownEnum (a profile).
std::size_t requestSize(Command command) noexcept;
void encodeRequest(std::uint32_t command_id, const Request& request,
                   RequestMessage& message) noexcept;
CodecError decodeRequest(Bytes message, Header& header, Request& request) noexcept;

/// The state datagram. decodeState fails with kWrongSize, kBadBoolean or kUnknownEnum.
void encodeState(const State& state, StateBuffer& buffer) noexcept;
CodecError decodeState(Bytes datagram, State& state) noexcept;

}  // namespace franka_core::fci::vacuum
