// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/reply.h>
#include <poll.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fci/sockets.h"

namespace franka_sim::fci {

/// @returns false once the peer has vanished.
bool sendLine(Connection& connection, const std::string& text);

/// One client of a LineServer: its connection, its line and the answer to it. One line is in
/// progress; the next one is read once the answer to it has been sent. Used by the server's thread.
class LineClient {
 public:
  using Clock = std::chrono::steady_clock;

  explicit LineClient(std::unique_ptr<Connection> connection);

  /// Reads and sends what the socket allows. @param arrival number of the line, if one is new
  /// @returns whether one is new.
  bool receive(std::uint64_t arrival);
  /// The line that waits to be executed.
  const std::optional<std::string>& line() const noexcept { return line_; }
  /// Number of that line, or of the one before it; 0 as long as none has come.
  std::uint64_t arrival() const noexcept { return arrival_; }
  /// That line has been executed.
  void answerWith(Reply reply);
  /// Sends the answer, if there is one that need not wait.
  void sendAnswer();

  /// Whether it has sent no line until now, since before this time.
  bool isSilentSince(Clock::time_point time) const noexcept {
    return arrival_ == 0 && accepted_at_ <= time;
  }
  bool lineIsTooLong() const noexcept;
  /// Whether there is nothing to do until its socket reports something.
  bool isQuiet() const noexcept;
  /// Whether it sends no more; it may still wait for answers.
  bool hasEnded() const noexcept { return has_ended_; }
  /// Whether it has been released or has vanished, or has ended and has all its answers.
  bool isGone() const noexcept;
  void addDescriptor(std::vector<pollfd>& fds) const;
  /// For a last sentence; the client is not used any more.
  std::unique_ptr<Connection> releaseConnection() noexcept { return std::move(connection_); }

 private:
  bool isIdle() const noexcept { return !line_ && !reply_; }
  /// Of the next line in the buffer, without its end.
  std::optional<std::size_t> lineSize() const noexcept;

  std::unique_ptr<Connection> connection_;
  Clock::time_point accepted_at_{Clock::now()};
  std::uint64_t arrival_{0};
  bool has_ended_{false};
  bool is_broken_{false};
  std::optional<std::string> line_;
  std::optional<Reply> reply_;  ///< to its last line; kept until states have been sent
};

}  // namespace franka_sim::fci
