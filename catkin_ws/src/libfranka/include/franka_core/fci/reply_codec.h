// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/request_codec.h>

#include <vector>

/// @file
/// The robot's TCP channel, replies. Pure functions.

namespace franka_core::fci {

constexpr std::size_t kMaxFixedReplySize = 166;  ///< GetCartesianLimit

using ReplyMessage = Message<kMaxFixedReplySize>;

/// Size of a reply in this version, header included and model excluded. 0 if the version has no
/// such command.
std::size_t replySize(std::uint16_t version, Command command) noexcept;

/// The number of a status in a reply to this command; empty if it has no such status.
std::optional<std::uint8_t> statusNumber(std::uint16_t version, Command command,
                                         Status status) noexcept;

/// The status of a number.
std::optional<Status> statusFromNumber(std::uint16_t version, Command command,
                                       std::uint8_t number) noexcept;

/// Robot: writes a reply; for the two that carry a model, one without it (for failures). No
/// allocation. Fails with kUnknownVersion, kNotInThisVersion or kUnknownStatus; `message` is then
/// empty. The version is the client's, except that Connect is the same in every version.
CodecError encodeReply(std::uint16_t version, Command command, std::uint32_t command_id,
                       const Reply& reply, ReplyMessage& message) noexcept;

/// Robot: writes the reply to LoadModelLibrary or GetRobotModel with the library's or the URDF's
/// bytes. Allocates. Fails as encodeReply does; kTooLong beyond kMaxReplySize.
CodecError encodeModelReply(std::uint16_t version, Command command, std::uint32_t command_id,
                            Bytes model, std::vector<std::uint8_t>& message);

/// The same without the model itself, for a robot that sends it without a copy: the bytes before
/// the `model_size` bytes of the model. No allocation.
CodecError encodeModelReplyHead(std::uint16_t version, Command command, std::uint32_t command_id,
                                std::size_t model_size, ReplyMessage& message) noexcept;

/// Client: reads a reply to `command`. `header` is filled if there are 12 bytes. `model` contains
/// the bytes after the status of LoadModelLibrary and GetRobotModel (it points into `message`), and
/// is empty for other commands. The header's command is not compared, as in the genuine client:
/// replies belong to requests by their command_id. Fails with kUnknownVersion, kNotInThisVersion,
/// kWrongSize, kUnknownStatus, kBadBoolean.
CodecError decodeReply(std::uint16_t version, Command command, Bytes message, Header& header,
                       Reply& reply, Bytes& model) noexcept;

}  // namespace franka_core::fci
