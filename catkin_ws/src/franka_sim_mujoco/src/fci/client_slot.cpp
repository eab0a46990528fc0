// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/fci/client_slot.h>

namespace franka_sim_mujoco::fci {

namespace {
constexpr std::chrono::seconds kConfirmTimeout{5};
}  // namespace

void ClientSlot::drop() noexcept {
  client_.reset();
  confirmed_ = false;
}

// True also for a client whose last request waits unread: it has ended its connection.
bool ClientSlot::clientIsGone() {
  const bool there = client_->receive();
  const bool late =
      !confirmed_ && std::chrono::steady_clock::now() - accepted_at_ > kConfirmTimeout;
  return !there || late || !client_->flush();
}

void ClientSlot::take(Connection connection, const sockaddr_in& peer) {
  client_ = std::make_unique<Connection>(std::move(connection));
  accepted_at_ = std::chrono::steady_clock::now();
  peer_ = peer;
  confirmed_ = false;
}

void ClientSlot::addDescriptors(std::vector<pollfd>& fds) const {
  if (listener_.isOpen()) {
    fds.push_back({listener_.descriptor(), POLLIN, 0});
  }
  if (client_) {
    const short events = client_->hasUnsent() ? POLLIN | POLLOUT : POLLIN;
    fds.push_back({client_->descriptor(), events, 0});
  }
}

}  // namespace franka_sim_mujoco::fci
