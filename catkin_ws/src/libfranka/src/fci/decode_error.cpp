// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/decode_error.h>

namespace franka_core::fci {

const char* describe(CodecError error) noexcept {
  switch (error) {
    case CodecError::kNone:
      return "The message is in order.";
    case CodecError::kUnknownVersion:
      return "There is no such protocol version.";
    case CodecError::kNotInThisVersion:
      return "This protocol version has no such command or mode.";
    case CodecError::kWrongSize:
      return "The message does not have the size that this protocol version gives it.";
    case CodecError::kIncomplete:
      return "The message has not arrived whole yet.";
    case CodecError::kTooLong:
      return "The message announces more bytes than any message has.";
    case CodecError::kUnknownCommand:
      return "The message carries a command number that this protocol version does not have.";
    case CodecError::kUnknownStatus:
      return "The reply carries a status that this command does not have.";
    case CodecError::kUnknownEnum:
      return "The message carries a mode or choice that does not exist.";
    case CodecError::kBadBoolean:
      return "The message carries a truth value that is neither 0 nor 1.";
    case CodecError::kNotFinite:
      return "The message carries a number that is infinite or not a number.";
  }
  return "The message is faulty in an unknown way.";
}

std::string sentence(CodecError error, const std::string& what, std::size_t received_size,
                     std::size_t expected_size) {
  std::string text = "Cannot use the " + what + " (" + std::to_string(received_size) + " bytes";
  if (error == CodecError::kWrongSize && received_size != expected_size) {
    text += " where " + std::to_string(expected_size) + " are due";
  }
  return text + "): " + describe(error);
}

}  // namespace franka_core::fci
