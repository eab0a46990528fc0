// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "fci/sockets.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace franka_sim::fci {

namespace {

/// An IPv4 address, or localhost: no other name, so that nothing waits for a name server.
bool readAddress(const std::string& text, in_addr& address) {
  return inet_pton(AF_INET, text == "localhost" ? "127.0.0.1" : text.c_str(), &address) == 1;
}

sockaddr_in toAddress(const std::string& address, std::uint16_t port) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_port = htons(port);
  if (!readAddress(address, result.sin_addr)) {
    throw std::runtime_error("'" + address +
                             "' is not an IPv4 address such as 127.0.0.1; give one that this "
                             "machine has.");
  }
  return result;
}

void setOption(int fd, int level, int option, int value) noexcept {
  // Options only tune the socket; a system without one still serves.
  setsockopt(fd, level, option, &value, sizeof(value));
}

[[noreturn]] void failToOpen(const std::string& what, const std::string& address,
                             std::uint16_t port, int error) {
  const std::string text = "Cannot open " + what + " " + address + ":" + std::to_string(port) +
                           ": " + std::strerror(error) + ".";
  if (error == EADDRINUSE) {
    throw AddressInUse(text +
                       " Another simulated robot runs there: end it, or give this one an address "
                       "of its own, for example 127.0.0.2.");
  }
  if (error == EADDRNOTAVAIL) {
    throw std::runtime_error(
        text +
        " This machine does not have that address; 127.0.0.1 to 127.255.255.254 always work.");
  }
  throw std::runtime_error(text);
}

Descriptor bound(int type, const std::string& what, const std::string& address,
                 std::uint16_t port) {
  const sockaddr_in name = toAddress(address, port);
  Descriptor result(::socket(AF_INET, type | SOCK_NONBLOCK | SOCK_CLOEXEC, 0));
  if (!result) {
    failToOpen(what, address, port, errno);
  }
  if (type == SOCK_STREAM) {
    setOption(result.get(), SOL_SOCKET, SO_REUSEADDR, 1);
  }
  if (::bind(result.get(), reinterpret_cast<const sockaddr*>(&name), sizeof(name)) != 0) {
    failToOpen(what, address, port, errno);
  }
  return result;
}

/// Connections queued by the system until they are accepted, if it permits so many. If this queue
/// overflows, a client retries only after a second. (Chosen here: on a busy machine a host may not
/// run for 0.1 s, in which two programs can make so many connections.)
constexpr int kBacklog = 4096;

/// Wait after running out of file descriptors (chosen here: short for a client, long for a poll
/// loop).
constexpr std::chrono::milliseconds kExhausted{100};

/// A peer that reads nothing, or is gone without a message, is disconnected after this time (chosen
/// here).
constexpr int kSilence = 5000;  // [ms]

/// Datagrams of other senders dropped per call (chosen here: bounds the time of a call).
constexpr int kMaxForeignDatagrams = 64;

/// A full buffer loses the newest datagrams. Chosen here: more than systems grant by default.
constexpr int kReceiveBuffer = 1 << 20;  // [bytes]

bool wouldBlock(int error) noexcept { return error == EAGAIN || error == EWOULDBLOCK; }

}  // namespace

bool isAddress(const std::string& text) noexcept {
  in_addr address{};
  return readAddress(text, address);
}

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
    failToOpen("the robot's TCP port", address, port, errno);
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
    // Fails if the socket still has its name, as it does unless the system chose it; or if another
    // program has it: then the socket listens at any other port.
    ::bind(socket_.get(), reinterpret_cast<const sockaddr*>(&name_), sizeof(name_));
    open_ = ::listen(socket_.get(), kBacklog) == 0;
    sockaddr_in now{};
    socklen_t size = sizeof(now);
    ::getsockname(socket_.get(), reinterpret_cast<sockaddr*>(&now), &size);
    if (open_ && now.sin_port != name_.sin_port) {
      close();
    }
  }
  return open_;
}

Descriptor Listener::accept(sockaddr_in& peer) noexcept {
  // accept4 creates a socket before it finds that no connection is pending; poll does not.
  pollfd waiting{socket_.get(), POLLIN, 0};
  if (!accepts() || ::poll(&waiting, 1, 0) <= 0) {
    return Descriptor();
  }
  socklen_t size = sizeof(peer);
  Descriptor result(::accept4(socket_.get(), reinterpret_cast<sockaddr*>(&peer), &size,
                              SOCK_NONBLOCK | SOCK_CLOEXEC));
  if (!result && (errno == EMFILE || errno == ENFILE || errno == ENOBUFS || errno == ENOMEM)) {
    exhausted_until_ = std::chrono::steady_clock::now() + kExhausted;
  }
  return result;
}

bool Listener::accepts() const noexcept {
  return open_ && (exhausted_until_ == std::chrono::steady_clock::time_point{} ||
                   std::chrono::steady_clock::now() >= exhausted_until_);
}

Connection::Connection(Descriptor socket) : socket_(std::move(socket)) {}

void Connection::watchPeer() noexcept {
  setOption(socket_.get(), IPPROTO_TCP, TCP_NODELAY, 1);
  setOption(socket_.get(), SOL_SOCKET, SO_KEEPALIVE, 1);
  setOption(socket_.get(), IPPROTO_TCP, TCP_KEEPIDLE, 1);
  setOption(socket_.get(), IPPROTO_TCP, TCP_KEEPCNT, 3);
  setOption(socket_.get(), IPPROTO_TCP, TCP_KEEPINTVL, 1);
  // Keepalive has no effect while data to the peer is unacknowledged.
  setOption(socket_.get(), IPPROTO_TCP, TCP_USER_TIMEOUT, kSilence);
}

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

bool Connection::peerHasClosed() const noexcept {
  pollfd state{socket_.get(), POLLRDHUP, 0};
  return ::poll(&state, 1, 0) > 0;  // also for a connection that was reset
}

void Connection::consume(std::size_t size) noexcept {
  filled_ -= size;
  std::memmove(buffer_, buffer_ + size, filled_);
}

// @returns false once the peer has vanished; `done` grows by the bytes that the system has taken.
bool Connection::write(Bytes message, std::size_t& done) noexcept {
  while (done < message.size) {
    const ssize_t size =
        ::send(socket_.get(), message.data + done, message.size - done, MSG_NOSIGNAL);
    if (size >= 0) {
      done += static_cast<std::size_t>(size);
    } else if (wouldBlock(errno)) {
      return true;
    } else if (errno != EINTR) {
      return false;
    }
  }
  return true;
}

bool Connection::send(Bytes message) {
  std::size_t done = 0;
  if (!hasUnsent() && !write(message, done)) {
    return false;
  }
  if (done < message.size) {
    unsent_.push_back({std::make_shared<const std::vector<std::uint8_t>>(
                           message.data + done, message.data + message.size),
                       0});
  }
  return true;
}

bool Connection::send(const Blob& bytes) {
  std::size_t done = 0;
  if (!hasUnsent() && !write({bytes->data(), bytes->size()}, done)) {
    return false;
  }
  if (done < bytes->size()) {
    unsent_.push_back({bytes, done});
  }
  return true;
}

bool Connection::flush() noexcept {
  while (hasUnsent()) {
    Unsent& next = unsent_.front();
    if (!write({next.bytes->data(), next.bytes->size()}, next.sent)) {
      return false;
    }
    if (next.sent < next.bytes->size()) {
      return true;
    }
    unsent_.erase(unsent_.begin());
  }
  return true;
}

std::size_t Connection::unsentBytes() const noexcept {
  std::size_t size = 0;
  for (const Unsent& unsent : unsent_) {
    size += unsent.bytes->size() - unsent.sent;
  }
  return size;
}

void Connection::reset() noexcept {
  const linger at_once{1, 0};
  setsockopt(socket_.get(), SOL_SOCKET, SO_LINGER, &at_once, sizeof(at_once));
  close();
}

Datagrams::Datagrams(const std::string& address)
    : socket_(bound(SOCK_DGRAM, "a UDP socket at", address, 0)) {
  setOption(socket_.get(), SOL_SOCKET, SO_RCVBUF, kReceiveBuffer);
}

void Datagrams::setPeer(const sockaddr_in& peer) noexcept {
  peer_ = peer;
  ::connect(socket_.get(), reinterpret_cast<const sockaddr*>(&peer_), sizeof(peer_));
  // A datagram of an earlier peer must not displace one of this peer.
  int error = 0;
  socklen_t size = sizeof(error);
  ::getsockopt(socket_.get(), SOL_SOCKET, SO_ERROR, &error, &size);
}

void Datagrams::send(Bytes datagram) noexcept {
  ::sendto(socket_.get(), datagram.data, datagram.size, MSG_NOSIGNAL | MSG_DONTWAIT,
           reinterpret_cast<const sockaddr*>(&peer_), sizeof(peer_));
}

std::ptrdiff_t Datagrams::receive(std::uint8_t* buffer, std::size_t capacity) noexcept {
  for (int i = 0; i < kMaxForeignDatagrams; i++) {
    sockaddr_in from{};
    socklen_t size = sizeof(from);
    const ssize_t received = ::recvfrom(socket_.get(), buffer, capacity, MSG_TRUNC | MSG_DONTWAIT,
                                        reinterpret_cast<sockaddr*>(&from), &size);
    if (received < 0) {
      // A closed port of the peer is reported once as an error.
      if (errno == EINTR || errno == ECONNREFUSED) {
        continue;
      }
      return -1;
    }
    if (from.sin_addr.s_addr == peer_.sin_addr.s_addr && from.sin_port == peer_.sin_port) {
      return received;
    }
  }
  return -1;
}

namespace {

/// As the list of sockets writes an address and a port: hexadecimal, the address as the number that
/// its bytes are on this machine.
std::string listed(std::uint32_t address, std::uint16_t port) {
  char text[16];
  std::snprintf(text, sizeof(text), "%08X:%04X", address, port);
  return text;
}

}  // namespace

// The columns of the list are in proc(5).
std::optional<bool> Datagrams::peerHasRead() const {
  const std::uint16_t port = ntohs(peer_.sin_port);
  const std::string name = listed(peer_.sin_addr.s_addr, port);
  const std::string any_address = listed(INADDR_ANY, port);
  std::ifstream sockets("/proc/net/udp");
  std::optional<bool> has_read;
  for (std::string line; std::getline(sockets, line);) {
    std::istringstream columns(line);
    std::string slot, local, remote, state, queues;  // queues: sent and received bytes
    columns >> slot >> local >> remote >> state >> queues;
    if (local == name || local == any_address) {
      const bool is_empty = queues.size() > 9 && queues.find_first_not_of('0', 9) == queues.npos;
      has_read = has_read.value_or(true) && is_empty;
    }
  }
  return has_read;
}

}  // namespace franka_sim::fci
