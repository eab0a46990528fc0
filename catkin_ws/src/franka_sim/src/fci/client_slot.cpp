// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <franka_sim/fci/client_slot.h>

#include <algorithm>
#include <utility>

namespace franka_sim::fci {

namespace {

/// The period of the per-millisecond limits.
constexpr std::chrono::milliseconds kMillisecond{1};

/// A connection stays at least this long, even if its place is needed. Chosen here: its first
/// request, sent right after it, may arrive a moment later.
constexpr std::chrono::milliseconds kMinimumAge{5};

/// Limits log messages to one per kind in this period.
constexpr std::chrono::seconds kReportPeriod{10};

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
  acceptPending(now);
  // Serve the client before others are refused: after a quick reconnect the old connection may
  // still look open.
  if (client_ && !serveEntry(*client_, serve_one, now)) {
    client_.reset();
    gone();
  }
  if (!client_) {
    servePending(serve_one, gone, now);
  }
  if (client_) {
    turnAway();
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

void ClientSlot::acceptPending(Clock::time_point now) {
  while (accepts_left_ > 0) {
    if (pending_.size() >= kMostOfOneAddress && now - pending_.front().accepted_at < kMinimumAge) {
      accepts_left_ = 0;
      return;
    }
    sockaddr_in peer{};
    Descriptor socket = listener_.accept(peer);
    if (!socket) {
      return;
    }
    accepts_left_--;
    pending_.push_back({std::make_unique<Connection>(std::move(socket)), peer, now, std::nullopt,
                        kRequestsAtOnce, false});
    makeRoom();
  }
}

// Makes room for the newest connection.
void ClientSlot::makeRoom() {
  const auto of_its_address = [this](const Entry& entry) {
    return sameAddress(entry.peer, pending_.back().peer);
  };
  auto oldest = pending_.end();
  if (static_cast<std::size_t>(std::count_if(pending_.begin(), pending_.end(), of_its_address)) >
      kMostOfOneAddress) {
    oldest = std::find_if(pending_.begin(), pending_.end(), of_its_address);
  } else if (pending_.size() > kMostPending) {
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
    // A client that has closed its connection is gone, even if its last request is unread.
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

void ClientSlot::servePending(const ServeOne& serve_one, const Gone& gone, Clock::time_point now) {
  for (std::size_t i = 0; i < pending_.size();) {
    Entry& entry = pending_[i];
    const bool stays = serveEntry(entry, serve_one, now);
    if (entry.confirmed) {
      client_ = std::move(entry);
      pending_.erase(pending_.begin() + static_cast<std::ptrdiff_t>(i));
      if (!stays) {
        client_.reset();
        gone();
      }
      return;
    }
    const bool late = stays && now - entry.accepted_at >= rules_.confirm;
    if (late) {
      refuse(entry, kLate);
    }
    if (!stays || late) {
      pending_.erase(pending_.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      i++;
    }
  }
}

void ClientSlot::turnAway() {
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
      "too many connections wait without having said who they are"};
  const Clock::time_point now = Clock::now();
  std::optional<Report>& last = reports_[reason];
  if (last && now - last->at < kReportPeriod) {
    last->silent++;
    return;
  }
  const unsigned silent = last ? last->silent : 0;
  last = Report{now};
  if (tell_) {
    tell_("a connection from " + textOf(peer) + " to port " + std::to_string(port()) +
          " was closed: " + kTexts[reason] +
          (silent > 0 ? "; so were " + std::to_string(silent) + " more before it." : "."));
  }
}

void ClientSlot::addDescriptors(std::vector<pollfd>& fds) const {
  if (accepts_left_ > 0 && listener_.accepts()) {
    fds.push_back({listener_.descriptor(), POLLIN, 0});
  }
  if (client_) {
    addEntry(*client_, fds);
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
