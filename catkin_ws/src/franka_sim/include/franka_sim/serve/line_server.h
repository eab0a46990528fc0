// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/command_table.h>
#include <franka_sim/serve/host.h>
#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim::fci {

/// The control interface, which represents the operator beside the robot: commands of one line each
/// over TCP, answered by one line, "ok", "ok <value>" or "error: <sentence>". `nc` suffices as a
/// client. Commands are executed between two ticks, by the thread that runs the host, and answered
/// once states that show their effect have been sent.
///
/// Several clients at a time, each with one line in progress. Lines are executed in the order of
/// their arrival; one that waits, or whose effect takes time, delays no line of another client.
/// A client beyond kMaxClients is refused with a sentence, unless one of the others has not sent a
/// line for 5 s since it came; then that one is closed with a sentence. Below that number of
/// clients there is no time limit.
///
/// It has no login. A connection that sends the first line of an HTTP request is closed with a
/// sentence before anything is executed, because any page in a browser can send one (decision 67).
class LineServer final : public Service {
 public:
  static constexpr std::size_t kMaxClients = 8;

  /// The user whose program has the other end of a connection; nothing if that is not known.
  using UserOf = std::function<std::optional<uid_t>(int connection)>;

  /// @param commands what lines do; outlives the server
  /// @param first_line a client that has sent no line for this time may be replaced by a new one
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  LineServer(const std::string& address, std::uint16_t port, const CommandTable& commands,
             std::chrono::seconds first_line = std::chrono::seconds(5));
  /// Sends the answers that are still due, such as that to the line that ended the host; none where
  /// the effect has not come about.
  ~LineServer() override;
  LineServer(const LineServer&) = delete;
  LineServer& operator=(const LineServer&) = delete;

  std::uint16_t port() const noexcept;
  /// From now on, connections of other users than this process' own and root are closed with a
  /// sentence, as those of other machines are, whose users nobody knows (decision 67).
  /// @param user_of another source of users, for tests
  void serveOwnUserOnly(UserOf user_of = {});

  void serve() override;
  bool idle() const override;
  void published() override;
  void addDescriptors(std::vector<pollfd>& fds) const override;

 private:
  class Impl;

  std::unique_ptr<Impl> impl_;
};

}  // namespace franka_sim::fci
