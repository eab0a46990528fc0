// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "network/datagram_socket.h"

#include <franka/exception.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <cerrno>
#include <utility>

namespace franka::network {

DatagramSocket::DatagramSocket(std::chrono::milliseconds timeout)
    : timeout_(timeout), socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
  sockaddr_in address{};
  address.sin_family = AF_INET;
  address.sin_addr.s_addr = htonl(INADDR_ANY);
  socklen_t size = sizeof(address);
  const timeval wait{timeout.count() / 1000, timeout.count() % 1000 * 1000};
  if (socket_.get() < 0 ||
      bind(socket_.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0 ||
      getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size) != 0 ||
      setsockopt(socket_.get(), SOL_SOCKET, SO_RCVTIMEO, &wait, sizeof(wait)) != 0) {
    throw NetworkException(systemError("No UDP socket", errno));
  }
  port_ = ntohs(address.sin_port);
}

DatagramSocket::Received DatagramSocket::tryReceive(std::uint8_t* buffer,
                                                    std::size_t capacity) noexcept {
  return receiveFromRobot(buffer, capacity, MSG_DONTWAIT);
}

DatagramSocket::Received DatagramSocket::receive(std::uint8_t* buffer,
                                                 std::size_t capacity) noexcept {
  Received received{false, 0};
  const auto look = [&] {
    received = tryReceive(buffer, capacity);
    return received.any;
  };
  if (std::exchange(has_answered_, false) && spin_rule_.spin(look)) {
    return received;
  }
  return receiveFromRobot(buffer, capacity, 0);
}

DatagramSocket::Received DatagramSocket::receiveFromRobot(std::uint8_t* buffer,
                                                          std::size_t capacity,
                                                          int flags) noexcept {
  // A signal, or another sender's datagram, neither ends the wait nor extends it.
  const auto deadline = std::chrono::steady_clock::now() + timeout_;
  do {
    socklen_t address_size = sizeof(last_sender_);
    const ssize_t size = recvfrom(socket_.get(), buffer, capacity, flags | MSG_TRUNC,
                                  reinterpret_cast<sockaddr*>(&last_sender_), &address_size);
    if (size < 0 && errno != EINTR) {
      return {false, 0};
    }
    if (size >= 0 && (!has_robot_ || (last_sender_.sin_addr.s_addr == robot_.sin_addr.s_addr &&
                                      last_sender_.sin_port == robot_.sin_port))) {
      return {true, static_cast<std::size_t>(size)};
    }
  } while (std::chrono::steady_clock::now() < deadline);
  return {false, 0};
}

void DatagramSocket::accept() noexcept {
  robot_ = last_sender_;
  has_robot_ = true;
}

int DatagramSocket::answer(franka_core::fci::Bytes datagram) noexcept {
  if (!has_robot_) {
    return EDESTADDRREQ;
  }
  ssize_t sent = 0;
  do {
    sent = sendto(socket_.get(), datagram.data, datagram.size, MSG_NOSIGNAL,
                  reinterpret_cast<const sockaddr*>(&robot_), sizeof(robot_));
  } while (sent < 0 && errno == EINTR);
  has_answered_ = true;
  return sent < 0 ? errno : 0;
}

}  // namespace franka::network
