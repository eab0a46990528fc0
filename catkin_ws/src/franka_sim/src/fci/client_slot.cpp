// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fci/client_slot.h"

#include <arpa/inet.h>

#include <algorithm>
#include <utility>

namespace franka_sim::fci {

namespace {

/// The period of the per-millisecond limits. A little less, so that a host that serves once in a
/// tick, not always at the same moment of it, finds each tick's limits.
constexpr std::chrono::microseconds kMillisecond{900};

/// A connection stays at least this long, even if its place is needed. Chosen here: its first
/// request, sent right after it, may arrive a moment later.
constexpr std::chrono::milliseconds kMinimumAge{4};

/// More new connections than this at a time are served once a millisecond, not each when it comes:
/// a look at the sockets for each of them would take longer than they do (chosen here).
constexpr int kFew = 8;

/// Limits log messages to one per kind in this period.
constexpr std::chrono::seconds kReportPeriod{10};

/// The most refused requests that are reported in this period. Chosen here: more than a person
/// tries.
constexpr unsigned kMaxRequestReports = 20;

bool sameAddress(const sockaddr_in& one, const sockaddr_in& other) noexcept {
  return one.sin_addr.s_addr == other.sin_addr.s_addr;
}

std::string textOf(const sockaddr_in& peer) {
  char text[INET_ADDRSTRLEN] = "";
  inet_ntop(AF_INET, &peer.sin_addr, text, sizeof(text));
  return text;
}

}  // namespace

Connection* ClientSlot::client() noexcept {
  if (served_ != nullptr) {
    return served_->connection.get();
  }
  return client_ ? client_->connection.get() : nullptr;
}

const sockaddr_in& ClientSlot::peer() const noexcept {
  return served_ != nullptr ? served_->peer : client_->peer;
}

void ClientSlot::confirm() noexcept {
  if (served_ != nullptr) {
    served_->confirmed = true;
    served_->connection->watchPeer();
  }
}

void ClientSlot::drop() noexcept {
  client_.reset();
  pending_.clear();
}

void ClientSlot::serve(const ServeOne& serve_one, const Gone& gone) {
  const Clock::time_point now = Clock::now();
  if (now - millisecond_ >= kMillisecond) {
    beginMillisecond(now);
  }
  // What has been said is heard before its place is needed.
  servePending(0, serve_one, gone, now);
  const std::size_t accepted = acceptPending(now);
  // Serve the client before others are refused: after a quick reconnect the old connection may
  // still look open.
  if (client_ && !serveEntry(*client_, serve_one, now)) {
    client_.reset();
    gone();
  }
  servePending(pending_.size() - accepted, serve_one, gone, now);
  if (client_) {
    refuseOthers();
  }
}

void ClientSlot::beginMillisecond(Clock::time_point now) {
  millisecond_ = now;
  accepts_left_ = kAcceptedAtOnce;
  if (client_) {
    client_->requests_left = kRequestsAtOnce;
  }
  for (Entry& entry : pending_) {
    entry.requests_left = kRequestsAtOnce;
  }
}

bool ClientSlot::isCrowded(Clock::time_point now) const noexcept {
  const bool many_came =
      kAcceptedAtOnce - accepts_left_ > kFew && now - millisecond_ < kMillisecond;
  return many_came || pending_.size() > kFew;
}

// @returns how many connections it has added at the end of pending_
std::size_t ClientSlot::acceptPending(Clock::time_point now) {
  std::size_t accepted = 0;
  while (accepts_left_ > 0) {
    if (pending_.size() >= kMaxPendingPerAddress &&
        now - pending_.front().accepted_at < kMinimumAge) {
      accepts_left_ = 0;
      break;
    }
    sockaddr_in peer{};
    Descriptor socket = listener_.accept(peer);
    if (!socket) {
      break;
    }
    accepts_left_--;
    pending_.push_back({std::make_unique<Connection>(std::move(socket)), peer, now, std::nullopt,
                        kRequestsAtOnce, false});
    accepted++;
    refuseExcess();
  }
  return std::min(accepted, pending_.size());
}

// Refuses a connection if there are too many with the newest one.
void ClientSlot::refuseExcess() {
  const auto of_its_address = [this](const Entry& entry) {
    return sameAddress(entry.peer, pending_.back().peer);
  };
  auto oldest = pending_.end();
  if (static_cast<std::size_t>(std::count_if(pending_.begin(), pending_.end(), of_its_address)) >
      kMaxPendingPerAddress) {
    oldest = std::find_if(pending_.begin(), pending_.end(), of_its_address);
  } else if (pending_.size() > kMaxPending) {
    oldest = pending_.begin();
  }
  if (oldest != pending_.end()) {
    refuse(*oldest, kTooMany);
    pending_.erase(oldest);
  }
}

// @returns false when the connection must end.
bool ClientSlot::serveEntry(Entry& entry, const ServeOne& serve_one, Clock::time_point now) {
  served_ = &entry;
  struct Finish {
    Entry*& served;
    ~Finish() { served = nullptr; }
  } finish{served_};
  Connection& connection = *entry.connection;
  if (!connection.flush()) {
    return false;
  }
  while (entry.requests_left > 0 && !connection.hasUnsent()) {
    // A client that has closed its connection counts as disconnected, even if its last request is
    // unread.
    if (!connection.receive()) {
      return false;
    }
    switch (serve_one(connection)) {
      case Served::kDone:
        entry.requests_left--;
        entry.incomplete_since.reset();
        break;
      case Served::kHeldBack:
        entry.incomplete_since.reset();
        return !connection.isFull() || !connection.peerHasClosed();
      case Served::kBroken:
        if (!connection.peerHasClosed()) {
          reportRefusal(entry.peer, kNoRequest);
        }
        return false;
      case Served::kIncomplete:
        if (connection.received().size == 0) {
          return true;
        }
        entry.incomplete_since = entry.incomplete_since.value_or(now);
        if (now - *entry.incomplete_since < rules_.request) {
          return true;
        }
        refuse(entry, kLate);
        return false;
    }
  }
  return !connection.peerHasClosed();
}

void ClientSlot::pollPending(std::size_t first) {
  polled_.clear();
  for (std::size_t i = first; i < pending_.size(); i++) {
    polled_.push_back({pending_[i].connection->descriptor(), POLLIN | POLLRDHUP, 0});
  }
  if (!polled_.empty()) {
    ::poll(polled_.data(), polled_.size(), 0);
  }
}

// Serves the connections from an index on, until one of them is the client.
void ClientSlot::servePending(std::size_t first, const ServeOne& serve_one, const Gone& gone,
                              Clock::time_point now) {
  if (client_) {
    return;
  }
  pollPending(first);
  bool client_stays = true;
  for (std::size_t i = first; i < pending_.size() && !client_; i++) {
    Entry& entry = pending_[i];
    const bool late = now - entry.accepted_at >= rules_.confirm;
    const bool speaks = polled_[i - first].revents != 0 || entry.connection->hasUnsent() ||
                        entry.connection->received().size > 0;
    if (!speaks && !late) {
      continue;
    }
    const bool stays = serveEntry(entry, serve_one, now);
    if (entry.confirmed) {
      client_stays = stays;
      client_ = std::move(entry);
    } else if (!stays) {
      entry.connection.reset();
    } else if (late) {
      refuse(entry, kLate);
      entry.connection.reset();
    }
  }
  const auto is_gone = [](const Entry& entry) { return entry.connection == nullptr; };
  pending_.erase(std::remove_if(pending_.begin(), pending_.end(), is_gone), pending_.end());
  if (!client_stays) {
    client_.reset();
    gone();
  }
}

void ClientSlot::refuseOthers() {
  for (Entry& entry : pending_) {
    refuse(entry, kBusy);
  }
  pending_.clear();
}

void ClientSlot::refuse(Entry& entry, Reason reason) {
  reportRefusal(entry.peer, reason);
  entry.connection->reset();
}

void ClientSlot::reportRefusal(const sockaddr_in& peer, Reason reason) {
  constexpr std::array<const char*, kReasons> kTexts{
      "there is a client already, and one at a time is served",
      "it was too slow to send its first request", "it sent an invalid request",
      "too many connections have not sent a Connect request"};
  const Clock::time_point now = Clock::now();
  std::optional<PastReport>& last = past_reports_[reason];
  if (last && now - last->at < kReportPeriod) {
    last->silent++;
    return;
  }
  const unsigned silent = last ? last->silent : 0;
  last = PastReport{now};
  if (report_) {
    report_("a connection from " + textOf(peer) + " to port " + std::to_string(port()) +
            " was closed: " + kTexts[reason] +
            (silent > 0 ? "; so were " + std::to_string(silent) + " more before it." : "."));
  }
}

void ClientSlot::reportRequest(const std::string& fault) {
  const Clock::time_point now = Clock::now();
  if (request_reports_ == 0 || now - first_request_report_ >= kReportPeriod) {
    first_request_report_ = now;
    request_reports_ = 0;
  }
  if (report_ && request_reports_ < kMaxRequestReports) {
    request_reports_++;
    report_("a request of the client at " + textOf(peer()) + " was refused: " + fault);
  }
}

void ClientSlot::addDescriptors(std::vector<pollfd>& fds) const {
  if (client_) {
    addEntry(*client_, fds);
  }
  if (isCrowded(Clock::now())) {
    return;
  }
  if (accepts_left_ > 0 && listener_.accepts()) {
    fds.push_back({listener_.descriptor(), POLLIN, 0});
  }
  for (const Entry& entry : pending_) {
    addEntry(entry, fds);
  }
}

void ClientSlot::addEntry(const Entry& entry, std::vector<pollfd>& fds) const {
  const Connection& connection = *entry.connection;
  short events = POLLRDHUP;
  if (connection.hasUnsent()) {
    events |= POLLOUT;
  } else if (entry.requests_left > 0 && !connection.isFull()) {
    events |= POLLIN;
  }
  fds.push_back({connection.descriptor(), events, 0});
}

}  // namespace franka_sim::fci
