// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim_mujoco/fci/sockets.h>
#include <poll.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace franka_sim_mujoco::fci {

/// The TCP port of a server that takes one client at a time. A second client is turned away: its
/// connection is reset, so that it fails at once instead of waiting. A connection that has not been
/// confirmed within 5 s makes room for others.
class ClientSlot {
 public:
  /// @throws std::runtime_error with a sentence when the port cannot be opened.
  ClientSlot(const std::string& address, std::uint16_t port) : listener_(address, port) {}

  std::uint16_t port() const noexcept { return listener_.port(); }
  /// The connection, or null.
  Connection* client() noexcept { return client_.get(); }
  const sockaddr_in& peer() const noexcept { return peer_; }
  bool confirmed() const noexcept { return confirmed_; }
  /// The client has said who it is.
  void confirm() noexcept { confirmed_ = true; }
  void drop() noexcept;

  /// Whether anybody can connect; closed, the port refuses. The client that is there stays.
  void setOpen(bool open) noexcept {
    open ? static_cast<void>(listener_.open()) : listener_.close();
  }

  /// Accepts and reads.
  /// @param serve_one takes one request off the connection and sets its second argument if there
  /// was one; returns false when the connection must end.
  /// @param dropped is called when the client has gone.
  template <typename ServeOne, typename Dropped>
  void serve(ServeOne&& serve_one, Dropped&& dropped) {
    serveClient(serve_one, dropped);
    sockaddr_in peer{};
    for (Descriptor socket = listener_.accept(peer); socket; socket = listener_.accept(peer)) {
      // Who comes back at once finds its old connection not yet taken down.
      serveClient(serve_one, dropped);
      Connection connection(std::move(socket));
      if (client_) {
        connection.reset();
        continue;
      }
      take(std::move(connection), peer);
      serveClient(serve_one, dropped);
    }
  }

  /// Adds the listener's and the client's socket.
  void addDescriptors(std::vector<pollfd>& fds) const;

 private:
  template <typename ServeOne, typename Dropped>
  void serveClient(ServeOne& serve_one, Dropped& dropped) {
    bool progressed = true;
    while (client_ && progressed) {
      progressed = false;
      if (clientIsGone() || !serve_one(*client_, progressed)) {
        drop();
        dropped();
      }
    }
  }
  bool clientIsGone();
  void take(Connection connection, const sockaddr_in& peer);

  Listener listener_;
  std::unique_ptr<Connection> client_;
  std::chrono::steady_clock::time_point accepted_at_{};
  sockaddr_in peer_{};
  bool confirmed_{false};
};

}  // namespace franka_sim_mujoco::fci
