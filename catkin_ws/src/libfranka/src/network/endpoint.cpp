// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "network/endpoint.h"

#include <franka/exception.h>
#include <netdb.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cstring>
#include <memory>

namespace franka::network {

namespace {

std::uint16_t parsePort(const std::string& text, const std::string& address) {
  const bool digits =
      !text.empty() && text.size() <= 5 &&
      std::all_of(text.begin(), text.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  const int port = digits ? std::stoi(text) : 0;
  if (port < 1 || port > 65535) {
    throw NetworkException("libfranka: \"" + text + "\" in the address \"" + address +
                           "\" is not a port. Please give an IP address or host name, and after a "
                           "colon, if at all, a number from 1 to 65535.");
  }
  return static_cast<std::uint16_t>(port);
}

}  // namespace

Endpoint parseEndpoint(const std::string& address, std::uint16_t default_port) {
  const std::size_t colon = address.find(':');
  Endpoint endpoint{address.substr(0, colon), default_port};
  if (endpoint.host.empty()) {
    throw NetworkException("libfranka: The address \"" + address +
                           "\" names no host. Please give the robot's IP address or host name.");
  }
  if (colon != std::string::npos) {
    endpoint.port = parsePort(address.substr(colon + 1), address);
  }
  return endpoint;
}

sockaddr_in resolve(const Endpoint& endpoint) {
  addrinfo hints{};
  hints.ai_family = AF_INET;
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const int error = getaddrinfo(endpoint.host.c_str(), nullptr, &hints, &found);
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  if (error != 0 || found == nullptr) {
    throw NetworkException("libfranka: No IPv4 address for \"" + endpoint.host +
                           "\": " + gai_strerror(error) +
                           ". Please check the robot's address and your name resolution.");
  }
  sockaddr_in address{};
  std::memcpy(&address, found->ai_addr, sizeof(address));
  address.sin_port = htons(endpoint.port);
  return address;
}

Descriptor::~Descriptor() {
  if (fd_ >= 0) {
    close(fd_);
  }
}

std::string systemError(const char* what, int error) {
  return std::string("libfranka: ") + what + ": " + std::strerror(error);
}

}  // namespace franka::network
