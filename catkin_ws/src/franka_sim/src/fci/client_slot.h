// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

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

#include "fci/sockets.h"

namespace franka_sim::fci {

/// Result of serving the first request in a connection's buffer.
enum class Served {
  kDone,        ///< consumed and answered
  kIncomplete,  ///< not all of it has arrived
  kHeldBack,    ///< left in the buffer for a later call
  kBroken       ///< not a request, or the peer has closed: the connection must end
};

/// Time limits of connections.
struct SlotRules {
  std::chrono::milliseconds confirm{5000};  ///< from accept until the connection identifies itself
  std::chrono::milliseconds request{5000};  ///< from the first byte of a request to its last
};

/// The TCP port of a server that takes one client at a time: the first connection that identifies
/// itself. All others are reset, then and later, so that their program fails at once instead of
/// waiting.
///
/// The cost per millisecond is bounded, whatever clients do: of each connection a few requests are
/// served (the rest stays in the system's buffers), none while the client does not read its
/// answers; a few connections are accepted, and a limited number that have not identified
/// themselves are kept. Beyond that the oldest is closed, of the new one's own address if that has
/// more than its share. Yet so many are accepted and kept that one program that connects as fast as
/// it can does not fill the system's queue, in which a genuine client would be lost for a second.
///
/// Called by one thread. serve() allocates only when a connection begins or ends, or when its
/// client reads more slowly than its answers arrive.
class ClientSlot {
 public:
  static constexpr int kRequestsAtOnce = 8;                  ///< per connection and millisecond
  static constexpr int kAcceptedAtOnce = 40;                 ///< connections per millisecond
  static constexpr std::size_t kMaxPending = 192;            ///< not yet identified connections
  static constexpr std::size_t kMaxPendingPerAddress = 160;  ///< of those, from one address

  using ServeOne = std::function<Served(Connection&)>;
  using Gone = std::function<void()>;
  using Report = std::function<void(const std::string&)>;

  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  ClientSlot(const std::string& address, std::uint16_t port, const SlotRules& rules = SlotRules())
      : listener_(address, port), rules_(rules) {}

  std::uint16_t port() const noexcept { return listener_.port(); }
  /// The connection that is being served, else the client's; null when there is none.
  Connection* client() noexcept;
  /// The remote address of that connection.
  const sockaddr_in& peer() const noexcept;
  /// Whether that connection has identified itself as the client.
  bool confirmed() const noexcept {
    return served_ != nullptr ? served_->confirmed : client_.has_value();
  }
  /// The connection that is being served has identified itself: it becomes the client.
  void confirm() noexcept;
  /// Whether there is no connection, identified or not, and none has come in this millisecond.
  bool idle() const noexcept {
    return !client_ && pending_.empty() && accepts_left_ == kAcceptedAtOnce;
  }
  /// Ends all connections.
  void drop() noexcept;

  /// Whether new connections are accepted; when closed, the port refuses. The present client stays.
  bool isOpen() const noexcept { return listener_.isOpen(); }
  void setOpen(bool open) noexcept {
    open ? static_cast<void>(listener_.open()) : listener_.close();
  }
  /// Sets the receiver of reasons why connections were closed: a sentence, of each kind at most one
  /// in ten seconds.
  void onRefusal(Report report) { report_ = std::move(report); }
  /// Reports to the same receiver why a request of the connection that is being served was refused;
  /// at most twenty in ten seconds.
  void reportRequest(const std::string& fault);

  /// Accepts, reads and answers.
  /// @param serve_one serves the first request in a connection's buffer.
  /// @param gone is called after the client has disconnected.
  void serve(const ServeOne& serve_one, const Gone& gone);

  /// Adds the sockets that must be polled before the next millisecond.
  void addDescriptors(std::vector<pollfd>& fds) const;

 private:
  using Clock = std::chrono::steady_clock;

  struct Entry {
    std::unique_ptr<Connection> connection;
    sockaddr_in peer;
    Clock::time_point accepted_at;
    std::optional<Clock::time_point> incomplete_since;
    int requests_left;
    bool confirmed;
  };
  enum Reason : std::size_t { kBusy, kLate, kNoRequest, kTooMany, kReasons };
  struct PastReport {
    Clock::time_point at;
    unsigned silent{0};  // cases not reported since
  };

  void beginMillisecond(Clock::time_point now);
  bool isCrowded(Clock::time_point now) const noexcept;
  std::size_t acceptPending(Clock::time_point now);
  void refuseExcess();
  bool serveEntry(Entry& entry, const ServeOne& serve_one, Clock::time_point now);
  void pollPending(std::size_t first);
  void servePending(std::size_t first, const ServeOne& serve_one, const Gone& gone,
                    Clock::time_point now);
  void refuseOthers();
  void refuse(Entry& entry, Reason reason);
  void reportRefusal(const sockaddr_in& peer, Reason reason);
  void addEntry(const Entry& entry, std::vector<pollfd>& fds) const;

  Listener listener_;
  SlotRules rules_;
  Report report_;
  Clock::time_point first_request_report_{};  // of the present ten seconds
  unsigned request_reports_{0};               // since then
  std::optional<Entry> client_;
  std::vector<Entry> pending_;  // oldest first
  std::vector<pollfd> polled_;  // what poll() reports of them
  Entry* served_{nullptr};
  Clock::time_point millisecond_{};
  int accepts_left_{kAcceptedAtOnce};
  std::array<std::optional<PastReport>, kReasons> past_reports_{};
};

}  // namespace franka_sim::fci
