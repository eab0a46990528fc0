// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <utility>

namespace franka_sim::fci {

/// The answer to a line: a value, at once or when the line has taken effect.
class Reply {
 public:
  /// The value; nothing while it has to wait. Throws std::exception whose text becomes the error.
  using Later = std::function<std::optional<std::string>()>;

  // Implicit, so that handlers return texts.
  Reply(std::string value) : value_(std::move(value)) {}   // NOLINT(google-explicit-constructor)
  Reply(const char* value) : Reply(std::string(value)) {}  // NOLINT(google-explicit-constructor)
  /// @param later is called about every millisecond until it returns a value or throws
  explicit Reply(Later later) : later_(std::move(later)) {}
  /// Without a value, as soon as `done` returns true.
  static Reply when(std::function<bool()> done);

  /// The value; nothing while it has to wait.
  /// @throws std::exception with a sentence if the line has failed
  std::optional<std::string> value();
  /// The line of the answer, "ok", "ok <value>" or "error: <sentence>"; nothing while it has to
  /// wait.
  std::optional<std::string> line();

 private:
  std::optional<std::string> value_;
  Later later_;
};

}  // namespace franka_sim::fci
