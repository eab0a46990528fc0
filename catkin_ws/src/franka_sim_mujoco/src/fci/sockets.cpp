// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <arpa/inet.h>
#include <fcntl.h>
#include <franka_sim_mujoco/fci/sockets.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <stdexcept>
#include <utility>

namespace franka_sim_mujoco::fci {

namespace {

sockaddr_in toAddress(const std::string& address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (inet_pton(AF_INET, address.c_str(), &result.sin_addr) != 1) {
    throw std::runtime_error("'" + address +
                             "' is not an IPv4 address such as 127.0.0.1; give one that this "
                             "machine has.");
  }
  return result;
}

void setOption(int fd, int level, int option, int value) noexcept {
  // Options tune; a system without one still serves.
  setsockopt(fd, level, option, &value, sizeof(value));
}

std::runtime_error cannotOpen(const std::string& what, const std::string& address,
                              std::uint16_t port, int error) {
  std::string text = "Cannot open " + what + " " + address + ":" + std::to_string(port) + ": " +
                     std::strerror(error) + ".";
  if (error == EADDRINUSE) {
    text +=
        " Another simulated robot runs there: end it, or give this one an address of its own, "
        "for example 127.0.0.2.";
  } else if (error == EADDRNOTAVAIL) {
    text += " This machine does not have that address; 127.0.0.1 to 127.255.255.254 always work.";
  }
  return std::runtime_error(text);
}

Descriptor bound(int type, const std::string& what, const std::string& address,
                 std::uint16_t port) {
  const sockaddr_in name = toAddress(address, port);
  Descriptor result(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!result) {
    throw cannotOpen(what, address, port, errno);
  }
  if (type == SOCK_STREAM) {
    setOption(result.get(), SOL_SOCKET, SO_REUSEADDR, 1);
  }
  if (::bind(result.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
    throw cannotOpen(what, address, port, errno);
  }
  return result;
}

constexpr int kBacklog = 8;

bool wouldBlock(int error) noexcept { return error == EAGAIN || error == EWOULDBLOCK; }

}  // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    close();
    fd_ = std::exchange(other.fd_, -1);
  }
  return *this;
}

void Descriptor::close() noexcept {
  if (fd_ >= 0) {
    ::close(std::exchange(fd_, -1));
  }
}

Listener::Listener(const std::string& address, std::uint16_t port)
    : socket_(bound(SOCK_STREAM, "the robot's TCP port", address, port)) {
  if (::listen(socket_.get(), kBacklog) != 0) {
    throw cannotOpen("the robot's TCP port", address, port, errno);
  }
  socklen_t size = sizeof(name_);
  ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&name_), &size);
  port_ = ntohs(name_.sin_port);
}

void Listener::close() noexcept {
  if (std::exchange(open_, false)) {
    ::shutdown(socket_.get(), SHUT_RDWR);
  }
}

bool Listener::open() noexcept {
  if (!open_) {
    // Fails where the socket still has its name, as it does where the system did not choose it.
    ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&name_), sizeof(name_));
    open_ = ::listen(socket_.get(), kBacklog) == 0;
  }
  return open_;
}

Descriptor Listener::accept(sockaddr_in& peer) noexcept {
  socklen_t size = sizeof(peer);
  Descriptor result(::accept4(socket_.get(), reinterpret_cast<sockaddr*>(&peer), &size,
                              SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (result) {
    // A peer that vanishes without a word is noticed after about 4 s.
    setOption(result.get(), IPPROTO_TCP, TCP_NODELAY, 1);
    setOption(result.get(), SOL_SOCKET, SO_KEEPALIVE, 1);
    setOption(result.get(), IPPROTO_TCP, TCP_KEEPIDLE, 1);
    setOption(result.get(), IPPROTO_TCP, TCP_KEEPCNT, 3);
    setOption(result.get(), IPPROTO_TCP, TCP_KEEPINTVL, 1);
  }
  return result;
}

Connection::Connection(Descriptor socket) : socket_(std::move(socket)) {}

bool Connection::receive() noexcept {
  while (open() && filled_ < kCapacity) {
    const ssize_t size = ::recv(socket_.get(), buffer_ + filled_, kCapacity - filled_, 0);
    if (size > 0) {
      filled_ += static_cast<std::size_t>(size);
    } else if (size < 0 && errno == EINTR) {
      continue;
    } else {
      return size < 0 && wouldBlock(errno);
    }
  }
  return open();
}

void Connection::consume(std::size_t size) noexcept {
  filled_ -= size;
  std::memmove(buffer_, buffer_ + size, filled_);
}

bool Connection::send(Bytes message) {
  std::size_t done = 0;
  while (!hasUnsent() && done < message.size) {
    const ssize_t size =
        ::send(socket_.get(), message.data + done, message.size - done, MSG_NOSIGNAL);
    if (size >= 0) {
      done += static_cast<std::size_t>(size);
    } else if (wouldBlock(errno)) {
      break;
    } else if (errno != EINTR) {
      return false;
    }
  }
  unsent_.insert(unsent_.end(), message.data + done, message.data + message.size);
  return true;
}

bool Connection::flush() noexcept {
  while (hasUnsent()) {
    const ssize_t size =
        ::send(socket_.get(), unsent_.data() + sent_, unsent_.size() - sent_, MSG_NOSIGNAL);
    if (size >= 0) {
      sent_ += static_cast<std::size_t>(size);
    } else if (wouldBlock(errno)) {
      return true;
    } else if (errno != EINTR) {
      return false;
    }
  }
  unsent_.clear();
  sent_ = 0;
  return true;
}

void Connection::reset() noexcept {
  const linger at_once{1, 0};
  setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  close();
}

Datagrams::Datagrams(const std::string& address)
    : socket_(bound(SOCK_DGRAM, "a UDP socket at", address, 0)) {}

void Datagrams::send(Bytes datagram) noexcept {
  ::sendto(socket_.get(), datagram.data, datagram.size, MSG_NOSIGNAL | MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&peer_), sizeof(peer_));
}

std::ptrdiff_t Datagrams::receive(std::uint8_t* buffer, std::size_t capacity) noexcept {
  for (;;) {
    sockaddr_in from{};
    socklen_t size = sizeof(from);
    const ssize_t received = ::recvfrom(socket_.get(), buffer, capacity, MSG_TRUNC | MSG_DONTWAIT,
                                        reinterpret_cast<sockaddr*>(&from), &size);
    if (received < 0) {
      // A peer that has closed its port is reported once in between.
      if (errno == EINTR || errno == ECONNREFUSED) {
        continue;
      }
      return -1;
    }
    if (from.sin_addr.s_addr == peer_.sin_addr.s_addr && from.sin_port == peer_.sin_port) {
      return received;
    }
  }
}

}  // namespace franka_sim_mujoco::fci
