// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/reply.h>

#include <exception>

namespace franka_sim::fci {

Reply Reply::when(std::function<bool()> done) {
  return Reply(
      [done = std::move(done)] { return done() ? std::optional<std::string>("") : std::nullopt; });
}

std::optional<std::string> Reply::value() {
  if (!value_) {
    value_ = later_();
  }
  return value_;
}

std::optional<std::string> Reply::line() {
  try {
    const std::optional<std::string> found = value();
    if (!found) {
      return {};
    }
    return found->empty() ? "ok" : "ok " + *found;
  } catch (const std::exception& error) {
    return std::string("error: ") + error.what();
  }
}

}  // namespace franka_sim::fci
