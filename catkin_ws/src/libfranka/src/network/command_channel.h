// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/decode_error.h>
#include <franka_core/fci/protocol.h>
#include <sys/types.h>

#include <atomic>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <vector>

#include "network/endpoint.h"

namespace franka::network {

using Clock = std::chrono::steady_clock;

/// The TCP connection to a robot or gripper: requests out, replies in.
///
/// Replies belong to requests by their id. They are kept until requested, also if another thread
/// reads them from the socket; two replies to one request are queued. Unexpected replies (see
/// expect, forget) are dropped. All functions end in bounded time. Thread-safe.
///
/// A forked process cannot end the connection of the one that made it, and can be kept from using
/// it (allowUseAfterFork).
class CommandChannel {
 public:
  /// Finds the first message of the stream: its id and size (see fci::nextMessage).
  using FindMessage = franka_core::fci::CodecError (*)(franka_core::fci::Bytes stream,
                                                       std::uint32_t& id, std::size_t& size);
  using Message = std::vector<std::uint8_t>;

  /// Time limit for sending one request.
  static constexpr std::chrono::seconds kSendTimeout{5};

  /// Connects. A server that dies or vanishes is detected within 4 s (TCP keepalive).
  /// @throws NetworkException if there is no connection by `deadline`.
  CommandChannel(const Endpoint& endpoint, FindMessage find_message, Clock::time_point deadline);
  ~CommandChannel();
  CommandChannel(const CommandChannel&) = delete;
  CommandChannel& operator=(const CommandChannel&) = delete;

  /// A new request's id, starting at 0; its replies are kept from now on.
  std::uint32_t expect();
  /// Drops all present and future replies to this id.
  void discardReplies(std::uint32_t id) noexcept;
  /// @throws InvalidOperationException in a process that was forked after the connection was made,
  /// if allowUseAfterFork forbids it.
  void checkProcess() const;
  /// Sends one request. @throws InvalidOperationException as checkProcess.
  /// @throws NetworkException if the connection is lost or takes no bytes for kSendTimeout.
  void send(franka_core::fci::Bytes request);

  /// The next reply to this request if it has arrived.
  /// @throws NetworkException if the server has closed the connection and all replies are read.
  /// @throws ProtocolException if the stream cannot be read.
  std::optional<Message> tryReceive(std::uint32_t id);
  /// Waits for the next reply to this request.
  /// @param watch called every 10 ms while waiting; may throw to end the wait.
  /// @returns nothing if none has come by `deadline`. @throws as tryReceive.
  std::optional<Message> receive(std::uint32_t id, Clock::time_point deadline,
                                 const std::function<void()>& watch = {});

  /// Whether the server has closed the connection or vanished, as far as visible without reading
  /// earlier data. One system call. Real-time safe.
  bool closedByServer() const noexcept;

  /// Whether the server is on this machine (see franka_core::isLoopback). Real-time safe.
  bool serverIsLoopback() const noexcept;

 private:
  void readAvailable();
  void sortStream();
  std::optional<Message> take(std::uint32_t id);

  Descriptor socket_;
  pid_t process_;
  FindMessage find_message_;

  std::mutex send_mutex_;
  std::mutex receive_mutex_;
  std::atomic<std::uint32_t> next_id_{0};
  std::map<std::uint32_t, std::vector<Message>> replies_;  // one entry per expected id
  std::vector<std::uint8_t> stream_;
  std::optional<franka_core::fci::CodecError> broken_;
  bool closed_{false};
};

}  // namespace franka::network
