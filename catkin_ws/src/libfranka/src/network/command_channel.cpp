// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "network/command_channel.h"

#include <fcntl.h>
#include <franka/exception.h>
#include <franka/extensions.h>
#include <franka_core/fci/texts.h>
#include <franka_core/realtime_rule.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>

namespace franka {

namespace {

// Whether forked processes may use connections (allowUseAfterFork).
std::atomic<bool> allowed_after_fork{true};

}  // namespace

void allowUseAfterFork(bool allowed) noexcept { allowed_after_fork = allowed; }

}  // namespace franka

namespace franka::network {

namespace {

namespace fci = franka_core::fci;

// Delay until a waiting thread receives a reply that another thread has read.
constexpr std::chrono::milliseconds kSlice{10};

int millisecondsUntil(Clock::time_point deadline, std::chrono::milliseconds at_most) {
  const auto left = std::chrono::ceil<std::chrono::milliseconds>(deadline - Clock::now());
  return static_cast<int>(std::clamp(left, std::chrono::milliseconds(0), at_most).count());
}

// poll() until the socket is ready or the time is over; a signal does not end the wait.
bool waitFor(int socket, short events, Clock::time_point deadline) {
  pollfd entry{socket, events, 0};
  int ready = 0;
  do {
    ready = poll(&entry, 1, millisecondsUntil(deadline, std::chrono::minutes(1)));
  } while ((ready < 0 && errno == EINTR) || (ready == 0 && Clock::now() < deadline));
  return ready > 0;
}

[[noreturn]] void throwConnectError(int error, const Endpoint& endpoint) {
  if (error == ECONNREFUSED) {
    throw NetworkException(fci::kConnectionRefused);
  }
  if (error == ETIMEDOUT) {
    throw NetworkException(fci::kConnectionTimeout);
  }
  throw NetworkException(systemError("Connection failed", error) + " (" + endpoint.host + ":" +
                         std::to_string(endpoint.port) +
                         "). Please check your network connection or settings.");
}

Descriptor connectTo(const Endpoint& endpoint, Clock::time_point deadline) {
  const sockaddr_in address = resolve(endpoint);
  Descriptor socket(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0));
  if (socket.get() < 0) {
    throw NetworkException(systemError("No TCP socket", errno));
  }
  if (connect(socket.get(), reinterpret_cast<const sockaddr*>(&address), sizeof(address)) != 0) {
    if (errno != EINPROGRESS && errno != EINTR) {
      throwConnectError(errno, endpoint);
    }
    if (!waitFor(socket.get(), POLLOUT, deadline)) {
      throwConnectError(ETIMEDOUT, endpoint);
    }
    int error = 0;
    socklen_t size = sizeof(error);
    getsockopt(socket.get(), SOL_SOCKET, SO_ERROR, &error, &size);
    if (error != 0) {
      throwConnectError(error, endpoint);
    }
  }
  return socket;
}

// Without keepalives a robot without power cannot be distinguished from a silent one
// (protocol 2.2).
void enableKeepalive(int socket) {
  const auto set = [socket](int level, int option, int value) {
    setsockopt(socket, level, option, &value, sizeof(value));
  };
  set(SOL_SOCKET, SO_KEEPALIVE, 1);
  set(IPPROTO_TCP, TCP_KEEPIDLE, 1);
  set(IPPROTO_TCP, TCP_KEEPCNT, 3);
  set(IPPROTO_TCP, TCP_KEEPINTVL, 1);
  set(IPPROTO_TCP, TCP_NODELAY, 1);
}

}  // namespace

CommandChannel::CommandChannel(const Endpoint& endpoint, FindMessage find_message,
                               Clock::time_point deadline)
    : socket_(connectTo(endpoint, deadline)), process_(getpid()), find_message_(find_message) {
  enableKeepalive(socket_.get());
}

CommandChannel::~CommandChannel() {
  if (process_ == getpid()) {
    shutdown(socket_.get(), SHUT_RDWR);
  }
}

void CommandChannel::checkProcess() const {
  if (!allowed_after_fork && process_ != getpid()) {
    throw InvalidOperationException(
        "libfranka: This connection was made before the process was forked and belongs to the "
        "other process. Connect again in this one.");
  }
}

std::uint32_t CommandChannel::expect() {
  const std::lock_guard<std::mutex> lock(receive_mutex_);
  const std::uint32_t id = next_id_++;
  replies_[id];
  return id;
}

void CommandChannel::discardReplies(std::uint32_t id) noexcept {
  const std::lock_guard<std::mutex> lock(receive_mutex_);
  replies_.erase(id);
}

void CommandChannel::send(fci::Bytes request) {
  checkProcess();
  const std::lock_guard<std::mutex> lock(send_mutex_);
  const Clock::time_point deadline = Clock::now() + kSendTimeout;
  std::size_t sent = 0;
  while (sent < request.size) {
    const ssize_t result =
        ::send(socket_.get(), request.data + sent, request.size - sent, MSG_NOSIGNAL);
    if (result >= 0) {
      sent += static_cast<std::size_t>(result);
    } else if (errno == EPIPE || errno == ECONNRESET) {
      throw NetworkException(fci::kServerClosed);
    } else if (errno == EAGAIN && !waitFor(socket_.get(), POLLOUT, deadline)) {
      throw NetworkException(fci::kConnectionTimeout);
    } else if (errno != EAGAIN && errno != EINTR) {
      throw NetworkException(systemError("TCP send", errno));
    }
  }
}

void CommandChannel::readAvailable() {
  std::uint8_t buffer[16384];
  while (!closed_) {
    const ssize_t result = recv(socket_.get(), buffer, sizeof(buffer), MSG_DONTWAIT);
    if (result > 0) {
      stream_.insert(stream_.end(), buffer, buffer + result);
      sortStream();
    } else if (result == 0 || errno == ECONNRESET || errno == ETIMEDOUT) {
      closed_ = true;
    } else if (errno == EAGAIN) {
      return;
    } else if (errno != EINTR) {
      throw NetworkException(systemError("TCP receive", errno));
    }
  }
}

void CommandChannel::sortStream() {
  std::size_t begin = 0;
  while (!broken_) {
    std::uint32_t id = 0;
    std::size_t size = 0;
    const fci::CodecError error =
        find_message_({stream_.data() + begin, stream_.size() - begin}, id, size);
    if (error == fci::CodecError::kIncomplete) {
      break;
    }
    if (error != fci::CodecError::kNone) {
      broken_ = error;
      break;
    }
    const auto entry = replies_.find(id);
    if (entry != replies_.end()) {
      const auto first = stream_.begin() + static_cast<std::ptrdiff_t>(begin);
      entry->second.emplace_back(first, first + static_cast<std::ptrdiff_t>(size));
    }
    begin += size;
  }
  stream_.erase(stream_.begin(), stream_.begin() + static_cast<std::ptrdiff_t>(begin));
}

std::optional<CommandChannel::Message> CommandChannel::take(std::uint32_t id) {
  const auto entry = replies_.find(id);
  if (entry == replies_.end() || entry->second.empty()) {
    return std::nullopt;
  }
  Message message = std::move(entry->second.front());
  entry->second.erase(entry->second.begin());
  return message;
}

std::optional<CommandChannel::Message> CommandChannel::tryReceive(std::uint32_t id) {
  const std::lock_guard<std::mutex> lock(receive_mutex_);
  std::optional<Message> message = take(id);
  if (!message) {
    readAvailable();
    message = take(id);
  }
  if (!message && broken_) {
    throw ProtocolException(std::string("libfranka: What the robot sends cannot be read: ") +
                            fci::describe(*broken_));
  }
  if (!message && closed_) {
    throw NetworkException(fci::kServerClosed);
  }
  return message;
}

std::optional<CommandChannel::Message> CommandChannel::receive(std::uint32_t id,
                                                               Clock::time_point deadline,
                                                               const std::function<void()>& watch) {
  while (true) {
    std::optional<Message> message = tryReceive(id);
    const Clock::time_point now = Clock::now();
    if (message || now >= deadline) {
      return message;
    }
    waitFor(socket_.get(), POLLIN, std::min(deadline, now + kSlice));
    if (watch) {
      watch();
    }
  }
}

bool CommandChannel::closedByServer() const noexcept {
  std::uint8_t byte = 0;
  const ssize_t size = recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT);
  return size == 0 || (size < 0 && errno != EAGAIN && errno != EINTR);
}

bool CommandChannel::serverIsLoopback() const noexcept {
  sockaddr_storage address{};
  socklen_t size = sizeof(address);
  return getpeername(socket_.get(), reinterpret_cast<sockaddr*>(&address), &size) == 0 &&
         franka_core::isLoopback(reinterpret_cast<const sockaddr&>(address));
}

}  // namespace franka::network
