// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <franka_sim/fci/client_slot.h>

#include <algorithm>
#include <utility>

namespace franka_sim::fci {

namespace {

/// Limits hold for so long each.
constexpr std::chrono::milliseconds kMillisecond{1};

/// A connection stays for so long even where others want its place: its first request, sent right
/// behind it, may be a moment late (our choice).
constexpr std::chrono::milliseconds kGrace{5};

/// Nobody reads more lines than one of a kind in that time.
constexpr std::chrono::seconds kTellPeriod{10};

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
  newcomers_.clear();
}

void ClientSlot::serve(const ServeOne& serve_one, const Gone& gone) {
  const Clock::time_point now = Clock::now();
  if (now - millisecond_ >= kMillisecond) {
    beginMillisecond(now);
  }
  acceptNewcomers(now);
  // Before anybody is turned away: who comes back at once finds its old connection not yet taken
  // down.
  if (client_ && !serveGuest(*client_, serve_one, now)) {
    client_.reset();
    gone();
  }
  if (!client_) {
    serveNewcomers(serve_one, gone, now);
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
  for (Guest& guest : newcomers_) {
    guest.requests_left = kRequestsAtOnce;
  }
}

void ClientSlot::acceptNewcomers(Clock::time_point now) {
  while (accepts_left_ > 0) {
    if (newcomers_.size() >= kMostOfOneAddress && now - newcomers_.front().accepted_at < kGrace) {
      accepts_left_ = 0;
      return;
    }
    sockaddr_in peer{};
    Descriptor socket = listener_.accept(peer);
    if (!socket) {
      return;
    }
    accepts_left_--;
    newcomers_.push_back({std::make_unique<Connection>(std::move(socket)), peer, now, std::nullopt,
                          kRequestsAtOnce, false});
    makeRoom();
  }
}

// For the newest one.
void ClientSlot::makeRoom() {
  const auto of_its_address = [this](const Guest& guest) {
    return sameAddress(guest.peer, newcomers_.back().peer);
  };
  auto oldest = newcomers_.end();
  if (static_cast<std::size_t>(std::count_if(newcomers_.begin(), newcomers_.end(),
                                             of_its_address)) > kMostOfOneAddress) {
    oldest = std::find_if(newcomers_.begin(), newcomers_.end(), of_its_address);
  } else if (newcomers_.size() > kMostNewcomers) {
    oldest = newcomers_.begin();
  }
  if (oldest != newcomers_.end()) {
    refuse(*oldest, kTooMany);
    newcomers_.erase(oldest);
  }
}

// @returns false when the connection must end.
bool ClientSlot::serveGuest(Guest& guest, const ServeOne& serve_one, Clock::time_point now) {
  served_ = &guest;
  struct Finish {
    Guest*& served;
    ~Finish() { served = nullptr; }
  } finish{served_};
  Connection& connection = *guest.connection;
  if (!connection.flush()) {
    return false;
  }
  while (guest.requests_left > 0 && !connection.hasUnsent()) {
    // A client that has ended its connection is gone, also where its last request waits unread.
    if (!connection.receive()) {
      return false;
    }
    switch (serve_one(connection)) {
      case Served::kDone:
        guest.requests_left--;
        guest.incomplete_since.reset();
        break;
      case Served::kHeldBack:
        guest.incomplete_since.reset();
        return !connection.isFull() || !connection.peerHasClosed();
      case Served::kBroken:
        if (!connection.peerHasClosed()) {
          tellWhy(guest.peer, kNoRequest);
        }
        return false;
      case Served::kIncomplete:
        if (connection.received().size == 0) {
          return true;
        }
        guest.incomplete_since = guest.incomplete_since.value_or(now);
        if (now - *guest.incomplete_since < rules_.request) {
          return true;
        }
        refuse(guest, kLate);
        return false;
    }
  }
  return !connection.peerHasClosed();
}

void ClientSlot::serveNewcomers(const ServeOne& serve_one, const Gone& gone,
                                Clock::time_point now) {
  for (std::size_t i = 0; i < newcomers_.size();) {
    Guest& guest = newcomers_[i];
    const bool stays = serveGuest(guest, serve_one, now);
    if (guest.confirmed) {
      client_ = std::move(guest);
      newcomers_.erase(newcomers_.begin() + static_cast<std::ptrdiff_t>(i));
      if (!stays) {
        client_.reset();
        gone();
      }
      return;
    }
    const bool late = stays && now - guest.accepted_at >= rules_.confirm;
    if (late) {
      refuse(guest, kLate);
    }
    if (!stays || late) {
      newcomers_.erase(newcomers_.begin() + static_cast<std::ptrdiff_t>(i));
    } else {
      i++;
    }
  }
}

void ClientSlot::turnAway() {
  for (Guest& guest : newcomers_) {
    refuse(guest, kBusy);
  }
  newcomers_.clear();
}

void ClientSlot::refuse(Guest& guest, Reason reason) {
  tellWhy(guest.peer, reason);
  guest.connection->reset();
}

void ClientSlot::tellWhy(const sockaddr_in& peer, Reason reason) {
  constexpr std::array<const char*, kReasons> kTexts{
      "there is a client already, and one at a time is served",
      "it was too slow to say what it wants", "what it sent is no request",
      "too many connections wait without having said who they are"};
  const Clock::time_point now = Clock::now();
  std::optional<Told>& told = told_[reason];
  if (told && now - told->at < kTellPeriod) {
    told->silent++;
    return;
  }
  const unsigned silent = told ? told->silent : 0;
  told = Told{now};
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
    addGuest(*client_, fds);
  }
  for (const Guest& guest : newcomers_) {
    addGuest(guest, fds);
  }
}

void ClientSlot::addGuest(const Guest& guest, std::vector<pollfd>& fds) const {
  const Connection& connection = *guest.connection;
  short events = POLLRDHUP;
  if (connection.hasUnsent()) {
    events |= POLLOUT;
  } else if (guest.requests_left > 0 && !connection.isFull()) {
    events |= POLLIN;
  }
  fds.push_back({connection.descriptor(), events, 0});
}

}  // namespace franka_sim::fci
