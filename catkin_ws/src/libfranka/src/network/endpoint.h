// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <netinet/in.h>

#include <cstdint>
#include <string>
#include <utility>

namespace franka::network {

/// Address of a server.
struct Endpoint {
  std::string host;
  std::uint16_t port;
};

/// Parses `host` or `host:port`.
/// @param default_port port if none is given.
/// @throws NetworkException with a sentence if the host is empty or the port no port.
Endpoint parseEndpoint(const std::string& address, std::uint16_t default_port);

/// The IPv4 address of an endpoint. May call the system's name resolver.
/// @throws NetworkException if there is none.
sockaddr_in resolve(const Endpoint& endpoint);

/// Owns a file descriptor.
class Descriptor {
 public:
  explicit Descriptor(int fd = -1) noexcept : fd_(fd) {}
  Descriptor(Descriptor&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
  Descriptor& operator=(Descriptor&& other) noexcept {
    std::swap(fd_, other.fd_);
    return *this;
  }
  ~Descriptor();

  int get() const noexcept { return fd_; }

 private:
  int fd_;
};

/// "libfranka: <what>: <text of errno>".
std::string systemError(const char* what, int error);

}  // namespace franka::network
