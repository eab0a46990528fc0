// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fci/peer_user.h"

#include <linux/inet_diag.h>
#include <linux/netlink.h>
#include <linux/sock_diag.h>
#include <netinet/in.h>
#include <sys/socket.h>

#include <array>
#include <cstring>

#include "fci/sockets.h"

namespace franka_sim::fci {

namespace {

struct PeerQuery {
  nlmsghdr header;
  inet_diag_req_v2 request;
};

// That of the peer's socket, whose own address is the peer's.
std::optional<PeerQuery> queryFor(int connection) noexcept {
  sockaddr_in own{};
  sockaddr_in peer{};
  socklen_t own_size = sizeof(own);
  socklen_t peer_size = sizeof(peer);
  if (::getsockname(connection, reinterpret_cast<sockaddr*>(&own), &own_size) != 0 ||
      ::getpeername(connection, reinterpret_cast<sockaddr*>(&peer), &peer_size) != 0 ||
      own.sin_family != AF_INET || peer.sin_family != AF_INET) {
    return std::nullopt;
  }
  PeerQuery query{};
  query.header.nlmsg_len = sizeof(query);
  query.header.nlmsg_type = SOCK_DIAG_BY_FAMILY;
  query.header.nlmsg_flags = NLM_F_REQUEST;
  query.request.sdiag_family = AF_INET;
  query.request.sdiag_protocol = IPPROTO_TCP;
  query.request.idiag_states = ~0U;
  query.request.id.idiag_sport = peer.sin_port;
  query.request.id.idiag_dport = own.sin_port;
  query.request.id.idiag_src[0] = peer.sin_addr.s_addr;
  query.request.id.idiag_dst[0] = own.sin_addr.s_addr;
  query.request.id.idiag_cookie[0] = INET_DIAG_NOCOOKIE;
  query.request.id.idiag_cookie[1] = INET_DIAG_NOCOOKIE;
  return query;
}

}  // namespace

std::optional<uid_t> peerUser(int connection) noexcept {
  const std::optional<PeerQuery> query = queryFor(connection);
  const Descriptor link(::socket(AF_NETLINK, SOCK_RAW | SOCK_CLOEXEC, NETLINK_SOCK_DIAG));
  if (!query || !link ||
      ::send(link.get(), &*query, sizeof(*query), 0) != static_cast<ssize_t>(sizeof(*query))) {
    return std::nullopt;
  }
  // The kernel has answered when `send` returns.
  std::array<char, 4096> answer{};
  const ssize_t size = ::recv(link.get(), answer.data(), answer.size(), MSG_DONTWAIT);
  nlmsghdr header{};
  inet_diag_msg message{};
  if (size < static_cast<ssize_t>(NLMSG_HDRLEN + sizeof(message))) {
    return std::nullopt;
  }
  std::memcpy(&header, answer.data(), sizeof(header));
  if (header.nlmsg_type != SOCK_DIAG_BY_FAMILY) {
    return std::nullopt;
  }
  std::memcpy(&message, answer.data() + NLMSG_HDRLEN, sizeof(message));
  // A socket that no process has any more has no inode, and 0 for its user.
  return message.idiag_inode != 0 ? std::optional<uid_t>(message.idiag_uid) : std::nullopt;
}

}  // namespace franka_sim::fci
