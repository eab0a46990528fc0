// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstdint>
#include <stdexcept>

namespace franka_test {

inline sockaddr_in loopback(std::uint16_t port) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  address.sin_port = htons(port);
  return address;
}

/// A socket on 127.0.0.1 with a port of its own. Its reads time out.
class Socket {
 public:
  explicit Socket(int type, int timeout_ms = 100) : fd_(socket(AF_INET, type | SOCK_CLOEXEC, 0)) {
    socklen_t size = sizeof(address_);
    if (bind(fd_, reinterpret_cast<sockaddr*>(&address_), size) != 0 ||
        getsockname(fd_, reinterpret_cast<sockaddr*>(&address_), &size) != 0) {
      throw std::runtime_error("no socket on 127.0.0.1");
    }
    setTimeout(fd_, timeout_ms);
  }
  ~Socket() { close(fd_); }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;

  static void setTimeout(int fd, int timeout_ms) {
    const timeval timeout{timeout_ms / 1000, timeout_ms % 1000 * 1000};
    setsockopt(fd, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
  }
  int get() const { return fd_; }
  const sockaddr_in& address() const { return address_; }
  std::uint16_t port() const { return ntohs(address_.sin_port); }

 private:
  int fd_;
  sockaddr_in address_{loopback(0)};
};

}  // namespace franka_test
