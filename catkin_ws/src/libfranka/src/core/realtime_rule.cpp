// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/realtime_rule.h>
#include <netdb.h>
#include <netinet/in.h>

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <stdexcept>

namespace franka_core {

namespace {

constexpr const char* kRealtimeVariable = "FRANKA_REALTIME";

bool isLoopback(const in_addr& address) noexcept {
  const std::uint32_t value = ntohl(address.s_addr);
  return value == INADDR_ANY || value >> 24 == IN_LOOPBACKNET;
}

bool isLoopback(const in6_addr& address) noexcept {
  if (IN6_IS_ADDR_V4MAPPED(&address)) {
    in_addr mapped{};
    std::copy_n(address.s6_addr + 12, 4, reinterpret_cast<std::uint8_t*>(&mapped.s_addr));
    return isLoopback(mapped);
  }
  return IN6_IS_ADDR_LOOPBACK(&address) || IN6_IS_ADDR_UNSPECIFIED(&address);
}

// `host`, `host:port`, `[host]:port` or a bare IPv6 address, which has more than one colon.
std::string hostOf(const std::string& address) {
  if (!address.empty() && address.front() == '[') {
    return address.substr(1, address.find(']') - 1);
  }
  const bool is_ipv6 = std::count(address.begin(), address.end(), ':') > 1;
  return is_ipv6 ? address : address.substr(0, address.find(':'));
}

}  // namespace

bool isLoopback(const sockaddr& address) noexcept {
  switch (address.sa_family) {
    case AF_INET:
      return isLoopback(reinterpret_cast<const sockaddr_in&>(address).sin_addr);
    case AF_INET6:
      return isLoopback(reinterpret_cast<const sockaddr_in6&>(address).sin6_addr);
    default:
      return false;
  }
}

bool isLoopback(const std::string& address) {
  addrinfo hints{};
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  const bool is_known = getaddrinfo(hostOf(address).c_str(), nullptr, &hints, &found) == 0;
  const std::unique_ptr<addrinfo, decltype(&freeaddrinfo)> owner(found, freeaddrinfo);
  for (const addrinfo* entry = found; entry != nullptr; entry = entry->ai_next) {
    if (!isLoopback(*entry->ai_addr)) {
      return false;
    }
  }
  return is_known;
}

RealtimeRule realtimeRule(bool enforce, bool is_loopback, bool has_realtime_kernel) {
  if (!enforce || !is_loopback) {
    return {enforce, ""};
  }
  const char* variable = std::getenv(kRealtimeVariable);
  const std::string choice = variable != nullptr ? variable : "";
  if (choice == "enforce") {
    return {true, ""};
  }
  if (choice == "ignore") {
    return {false, ""};
  }
  if (!choice.empty()) {
    throw std::invalid_argument(std::string("The environment variable ") + kRealtimeVariable +
                                " is \"" + choice +
                                "\", but must be enforce or ignore. Without it, simulated robots "
                                "(on loopback addresses) need no real-time kernel.");
  }
  if (has_realtime_kernel) {
    return {true, ""};
  }
  return {false, std::string("The running kernel has no real-time support. The robot is on a "
                             "loopback address, so it counts as simulated and is controlled all "
                             "the same; commands may come late under load. (") +
                     kRealtimeVariable + "=enforce refuses this, " + kRealtimeVariable +
                     "=ignore switches this warning off.)"};
}

}  // namespace franka_core
