// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/host.h>
#include <franka_sim/fci/sockets.h>

#include <chrono>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace franka_sim::fci {

/// The control interface, which stands for the operator beside the robot: commands of one line each
/// over TCP, answered by one line, "ok", "ok <value>" or "error: <sentence>". `nc` suffices as a
/// client. Commands are executed between two ticks, by the thread that runs the host, and answered
/// once states that show their effect have been sent.
///
/// One client at a time. A second one is refused with a sentence, unless the first has not sent a
/// line for 5 s since it came; then the first is closed with a sentence. While no other client
/// waits, there is no time limit.
class LineServer final : public Service {
 public:
  using Words = std::vector<std::string>;
  /// Gets the words after the command's name; returns the value to answer, or nothing.
  /// @throws std::exception whose text becomes the error.
  using Handler = std::function<std::string(const Words&)>;
  /// Whether a command can be executed now, or has taken effect.
  using Ready = std::function<bool()>;

  /// @param first_line a client that has sent no line for this time is replaced by a new one
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  LineServer(const std::string& address, std::uint16_t port,
             std::chrono::seconds first_line = std::chrono::seconds(5))
      : listener_(address, port), first_line_(first_line) {}
  /// Sends the answer that is still due, to the line that ended the host; none where the effect has
  /// not come about.
  ~LineServer() override;

  std::uint16_t port() const noexcept { return listener_.port(); }
  /// @param usage the command as the user types it, for example "user_stop on|off"; its first word
  /// is the name.
  /// @param ready lines wait until it returns true
  /// @param done the answer to an executed line waits until it returns true
  void add(
      const std::string& usage, Handler handler, Ready ready = [] { return true; },
      Ready done = [] { return true; });
  /// The answer to one line.
  std::string answer(const std::string& line) const;

  void serve() override;
  void published() override;
  void addDescriptors(std::vector<pollfd>& fds) const override;

 private:
  using Clock = std::chrono::steady_clock;
  struct Entry {
    std::string usage;
    Handler handler;
    Ready ready;
    Ready done;
  };
  /// A refused connection: it is closed once its peer has read the reason.
  struct Leaving {
    std::unique_ptr<Connection> connection;
    Clock::time_point until;
  };

  void accept();
  void serveClient();
  bool isReady(const std::string& line) const;
  bool isDone() const;
  void dismiss(std::unique_ptr<Connection> connection, const std::string& sentence);
  void closeLeaving();
  std::string help() const;

  Listener listener_;
  Clock::duration first_line_;
  std::unique_ptr<Connection> client_;
  Clock::time_point accepted_at_{};
  bool has_spoken_{false};             ///< the client has sent a line
  bool has_ended_{false};              ///< it sends no more, but may still wait for answers
  bool waits_{false};                  ///< its line cannot be executed yet
  std::optional<std::string> answer_;  ///< to its last line; kept until states have been sent
  Ready done_;                         ///< of that line; empty: done
  std::vector<Leaving> leaving_;
  std::map<std::string, Entry> entries_;
};

/// A word as a number. @throws std::invalid_argument with a sentence.
double toNumber(const std::string& word);
/// A word as a whole number from 0 to 18446744073709551615, the largest of 64 bits.
/// @throws std::invalid_argument with a sentence.
std::uint64_t toSeed(const std::string& word);
/// "on" or "off". @throws std::invalid_argument with a sentence.
bool toSwitch(const std::string& word);

}  // namespace franka_sim::fci
