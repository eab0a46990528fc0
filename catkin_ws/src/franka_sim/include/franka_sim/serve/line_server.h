// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/host.h>
#include <poll.h>
#include <sys/types.h>

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

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

  /// The line of the answer, "ok", "ok <value>" or "error: <sentence>"; nothing while it has to
  /// wait.
  std::optional<std::string> line();

 private:
  std::optional<std::string> value_;
  Later later_;
};

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

  /// That a line has fewer words than its command reads: it is answered with the command's usage.
  struct MissingWord {};
  /// The words after a command's name.
  class Words {
   public:
    explicit Words(std::vector<std::string> words) : words_(std::move(words)) {}
    std::size_t size() const noexcept { return words_.size(); }
    const std::string& operator[](std::size_t i) const noexcept { return words_[i]; }
    /// @throws MissingWord
    const std::string& at(std::size_t i) const {
      return i < words_.size() ? words_[i] : throw MissingWord();
    }

   private:
    std::vector<std::string> words_;
  };
  /// Gets the words after the command's name; returns what to answer, "" for a plain "ok".
  /// @throws std::exception whose text becomes the error; MissingWord.
  using Handler = std::function<Reply(const Words&)>;
  /// Whether a command can be executed now.
  using Ready = std::function<bool()>;
  /// The user whose program has the other end of a connection; nothing if that is not known.
  using UserOf = std::function<std::optional<uid_t>(int connection)>;

  /// @param first_line a client that has sent no line for this time may be replaced by a new one
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  LineServer(const std::string& address, std::uint16_t port,
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
  /// @param usage the command as the user types it, for example "user_stop on|off"; its first word
  /// is the name.
  /// @param ready lines wait until it returns true
  void add(const std::string& usage, Handler handler, Ready ready = [] { return true; });

  void serve() override;
  bool idle() const override;
  void published() override;
  void addDescriptors(std::vector<pollfd>& fds) const override;

 private:
  class Impl;

  std::unique_ptr<Impl> impl_;
};

/// A word as a number. @throws std::invalid_argument with a sentence.
double toNumber(const std::string& word);
/// A word as a whole number from 0 to 18446744073709551615, the largest of 64 bits.
/// @throws std::invalid_argument with a sentence.
std::uint64_t toSeed(const std::string& word);
/// "on" or "off". @throws std::invalid_argument with a sentence.
bool toSwitch(const std::string& word);

}  // namespace franka_sim::fci
