// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <cstdint>
#include <string>

namespace franka_core::fci {

/// Why a message could not be decoded or encoded.
enum class CodecError : std::uint8_t {
  kNone,
  kUnknownVersion,    ///< there is no such protocol version
  kNotInThisVersion,  ///< the command, mode or status exists, but not in this protocol version
  kWrongSize,         ///< not the size that this message has in this version
  kIncomplete,        ///< the stream holds less than one message so far; not a fault
  kTooLong,           ///< the header announces more bytes than any message has
  kUnknownCommand,    ///< a command number that this version does not have
  kUnknownStatus,     ///< a reply's status that this command does not have in this version
  kUnknownEnum,       ///< a mode, profile or the like outside its list
  kBadBoolean,        ///< neither 0 nor 1
  kNotFinite,         ///< a number of a command is infinite or NaN; decoded nevertheless
};

/// One sentence for the user, for example "The message does not have the size that this protocol
/// version gives it." Never null. Real-time safe.
const char* describe(CodecError error) noexcept;

/// The sentence with the message's kind and sizes: `what` is for example "robot state of protocol
/// version 5".
std::string sentence(CodecError error, const std::string& what, std::size_t received_size,
                     std::size_t expected_size);

}  // namespace franka_core::fci
