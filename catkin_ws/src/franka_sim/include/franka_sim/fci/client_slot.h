// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/sockets.h>
#include <poll.h>

#include <array>
#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace franka_sim::fci {

/// What became of the first request in a connection's buffer.
enum class Served {
  kDone,        ///< taken off the buffer and answered
  kIncomplete,  ///< not all of it has arrived
  kHeldBack,    ///< left in the buffer for a later call
  kBroken       ///< no request, or its sender has vanished: the connection must end
};

/// How long connections may take.
struct SlotRules {
  std::chrono::milliseconds confirm{5000};  ///< to say who they are; nobody waits for that
  std::chrono::milliseconds request{5000};  ///< to send the rest of a request that has begun
};

/// The TCP port of a server that takes one client at a time: the first connection that says who it
/// is. Others are turned away, then and later: their connection is reset, so that a program fails
/// at once instead of waiting.
///
/// No client costs the server more than a little in each millisecond, whatever it does: of each
/// connection a few requests are served, the rest waits in the system's buffers; while a client
/// does not read its answers nothing is served; a few connections are accepted, and so many are
/// held that have not said who they are. Beyond that the oldest makes room, of the newcomer's own
/// address where that has more than its share.
///
/// One thread. serve allocates only when a connection comes, ends or is slower than its answers.
class ClientSlot {
 public:
  static constexpr int kRequestsAtOnce = 8;             ///< of a connection in a millisecond
  static constexpr int kAcceptedAtOnce = 32;            ///< connections in a millisecond
  static constexpr std::size_t kMostNewcomers = 32;     ///< connections without a name
  static constexpr std::size_t kMostOfOneAddress = 24;  ///< of those

  using ServeOne = std::function<Served(Connection&)>;
  using Gone = std::function<void()>;
  using Tell = std::function<void(const std::string&)>;

  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  ClientSlot(const std::string& address, std::uint16_t port, const SlotRules& rules = SlotRules())
      : listener_(address, port), rules_(std::move(rules)) {}

  std::uint16_t port() const noexcept { return listener_.port(); }
  /// The connection that is being served, else the client's; null when there is none.
  Connection* client() noexcept;
  /// Where that connection comes from.
  const sockaddr_in& peer() const noexcept;
  /// Whether that is the client, who has said who it is.
  bool confirmed() const noexcept {
    return served_ != nullptr ? served_->confirmed : client_.has_value();
  }
  /// The connection that is being served has said who it is: it is the client from now on.
  void confirm() noexcept;
  /// Ends all connections.
  void drop() noexcept;

  /// Whether anybody can connect; closed, the port refuses. The client that is there stays.
  void setOpen(bool open) noexcept {
    open ? static_cast<void>(listener_.open()) : listener_.close();
  }
  /// Who is told why a connection was ended: a sentence, of each kind at most one in ten seconds.
  void onRefusal(Tell tell) { tell_ = std::move(tell); }

  /// Accepts, reads and answers.
  /// @param serve_one serves the first request in a connection's buffer.
  /// @param gone is called when the client has gone.
  void serve(const ServeOne& serve_one, const Gone& gone);

  /// Adds the sockets that have something to say before the next millisecond.
  void addDescriptors(std::vector<pollfd>& fds) const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Guest {
    std::unique_ptr<Connection> connection;
    sockaddr_in peer;
    Clock::time_point accepted_at;
    std::optional<Clock::time_point> incomplete_since;
    int requests_left;
    bool confirmed;
  };
  enum Reason : std::size_t { kBusy, kLate, kNoRequest, kTooMany, kReasons };
  struct Told {
    Clock::time_point at;
    unsigned silent{0};  // cases that were not told since
  };

  void beginMillisecond(Clock::time_point now);
  void acceptNewcomers(Clock::time_point now);
  void makeRoom();
  bool serveGuest(Guest& guest, const ServeOne& serve_one, Clock::time_point now);
  void serveNewcomers(const ServeOne& serve_one, const Gone& gone, Clock::time_point now);
  void turnAway();
  void refuse(Guest& guest, Reason reason);
  void tellWhy(const sockaddr_in& peer, Reason reason);
  void addGuest(const Guest& guest, std::vector<pollfd>& fds) const;

  Listener listener_;
  SlotRules rules_;
  Tell tell_;
  std::optional<Guest> client_;
  std::vector<Guest> newcomers_;  // the oldest first
  Guest* served_{nullptr};
  Clock::time_point millisecond_{};
  int accepts_left_{kAcceptedAtOnce};
  std::array<std::optional<Told>, kReasons> told_{};
};

}  // namespace franka_sim::fci
