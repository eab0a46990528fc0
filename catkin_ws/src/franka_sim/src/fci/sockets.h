// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>
#include <netinet/in.h>

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

/// @file
/// The server's sockets. None of them blocks. Each is called by one thread.

namespace franka_sim::fci {

using franka_core::fci::Bytes;

/// Bytes that several messages share without a copy, such as a model.
using Blob = std::shared_ptr<const std::vector<std::uint8_t>>;

/// Whether a text is an IPv4 address such as 127.0.0.1, of this machine or another.
bool isAddress(const std::string& text) noexcept;

/// Closes its file descriptor when it is destroyed.
class Descriptor {
 public:
  Descriptor() = default;
  explicit Descriptor(int fd) noexcept : fd_(fd) {}
  ~Descriptor() { close(); }
  Descriptor(Descriptor&& other) noexcept : fd_(other.fd_) { other.fd_ = -1; }
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int get() const noexcept { return fd_; }
  explicit operator bool() const noexcept { return fd_ >= 0; }
  void close() noexcept;

 private:
  int fd_{-1};
};

/// Another program has that address and port.
class AddressInUse : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Waits for connections on one address of this machine.
class Listener {
 public:
  /// @param port 0: the system chooses.
  /// @throws std::runtime_error with a sentence that names address, port and cause; AddressInUse.
  Listener(const std::string& address, std::uint16_t port);

  std::uint16_t port() const noexcept { return port_; }
  int descriptor() const noexcept { return socket_.get(); }
  /// The next connection and where it comes from; an empty descriptor when there is none, or when
  /// this process can open no more of them.
  Descriptor accept(sockaddr_in& peer) noexcept;
  /// Whether accept() can take a pending connection, so that a poll is useful.
  bool accepts() const noexcept;

  /// When closed, connections are refused; the port stays reserved for this listener.
  bool isOpen() const noexcept { return open_; }
  void close() noexcept;
  /// @returns false when another program has taken the port meanwhile.
  bool open() noexcept;

 private:
  Descriptor socket_;
  sockaddr_in name_{};
  std::chrono::steady_clock::time_point exhausted_until_{};
  bool open_{true};
  std::uint16_t port_{0};
};

/// One TCP connection. Requests collect in a buffer of fixed size; bytes that the peer does not
/// take at once are kept and sent by later calls of flush.
class Connection {
 public:
  explicit Connection(Descriptor socket);

  /// From now on a peer that is gone without a message, or reads nothing, is detected after 5 s,
  /// and no message waits for the acknowledgment of another one. (Six system calls, which
  /// connections that say nothing are not worth.)
  void watchPeer() noexcept;

  int descriptor() const noexcept { return socket_.get(); }
  bool open() const noexcept { return static_cast<bool>(socket_); }
  bool hasUnsent() const noexcept { return !unsent_.empty(); }
  /// Bytes that are kept for the peer, shared ones included.
  std::size_t unsentBytes() const noexcept;
  /// Whether the buffer is full: nothing is received until something is consumed.
  bool isFull() const noexcept { return filled_ == kCapacity; }

  /// Reads available bytes. @returns false once the peer has closed or vanished.
  bool receive() noexcept;
  /// The same without reading: correct even while received bytes are still unread.
  bool peerHasClosed() const noexcept;
  /// Bytes that have been received and not consumed.
  Bytes received() const noexcept { return {buffer_, filled_}; }
  void consume(std::size_t size) noexcept;

  /// Sends, or keeps for later. Allocates only if the peer is slower than the messages.
  /// @returns false once the peer has vanished.
  bool send(Bytes message);
  /// The same for shared bytes, which are kept without a copy.
  bool send(const Blob& bytes);
  bool flush() noexcept;

  void close() noexcept { socket_.close(); }
  /// Closes with a reset instead of an end, so that the peer detects it at once.
  void reset() noexcept;

 private:
  static constexpr std::size_t kCapacity = 4096;  // larger than the largest request

  struct Unsent {
    Blob bytes;
    std::size_t sent;
  };

  bool write(Bytes message, std::size_t& done) noexcept;

  Descriptor socket_;
  std::uint8_t buffer_[kCapacity];
  std::size_t filled_{0};
  std::vector<Unsent> unsent_;
};

/// A UDP socket on one address, with one peer at a time.
class Datagrams {
 public:
  /// @throws std::runtime_error with a sentence.
  explicit Datagrams(const std::string& address);

  int descriptor() const noexcept { return socket_.get(); }
  /// From now on the system drops datagrams of other senders.
  void setPeer(const sockaddr_in& peer) noexcept;
  /// Real-time safe. A datagram that the system does not accept is lost, as on a wire.
  void send(Bytes datagram) noexcept;
  /// The next datagram from the peer's address; others are dropped, a limited number per call.
  /// @returns its size, which may be larger than `capacity`; -1 when there is none.
  std::ptrdiff_t receive(std::uint8_t* buffer, std::size_t capacity) noexcept;
  /// Whether the peer, a socket of this machine, has read every datagram; nothing if the system
  /// does not list it: it belongs to another network namespace. Not real-time safe.
  std::optional<bool> peerHasRead() const;

 private:
  Descriptor socket_;
  sockaddr_in peer_{};
};

}  // namespace franka_sim::fci
