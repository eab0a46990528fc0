// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/gripper_codec.h>
#include <franka_core/fci/vacuum_codec.h>
#include <poll.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "loopback_socket.h"

namespace franka_test {

/// A gripper for tests: real sockets on 127.0.0.1, port 0. It answers requests as scripted and
/// sends a state every 5 ms. For both grippers: framing and Connect are the same.
class FakeGripper {
 public:
  using Header = franka_core::fci::gripper::Header;
  using Status = franka_core::fci::gripper::Status;
  using Bytes = std::vector<std::uint8_t>;

  explicit FakeGripper(std::uint16_t version) : version_(version) {
    listen(listener_.get(), 4);
    thread_ = std::thread([this] { run(); });
  }
  ~FakeGripper() {
    ended_ = true;
    thread_.join();
  }

  std::string address() const { return "127.0.0.1:" + std::to_string(listener_.port()); }

  std::atomic<Status> answer{Status::kSuccess};
  std::atomic<bool> answers{true};  ///< else requests other than Connect and Stop wait
  std::atomic<bool> sends_states{true};
  std::atomic<bool> closes{false};  ///< closes the connection instead of replying
  std::atomic<std::uint16_t> stop_command{4};

  /// The state that it sends from now on.
  void show(Bytes state) {
    const std::lock_guard<std::mutex> lock(mutex_);
    state_ = std::move(state);
  }
  /// The received requests, except Connect.
  std::vector<Bytes> requests() {
    const std::lock_guard<std::mutex> lock(mutex_);
    return requests_;
  }

 private:
  void run() {
    while (!ended_) {
      pollfd waiting{listener_.get(), POLLIN, 0};
      if (poll(&waiting, 1, 5) == 1) {
        const int client = accept(listener_.get(), nullptr, nullptr);
        serve(client);
        close(client);
      }
    }
  }

  void serve(int client) {
    Bytes stream;
    udp_port_ = 0;
    pending_.clear();
    while (!ended_) {
      pollfd waiting{client, POLLIN, 0};
      if (poll(&waiting, 1, 5) == 1) {
        std::uint8_t buffer[256];
        const ssize_t count = recv(client, buffer, sizeof(buffer), 0);
        if (count <= 0) {
          return;
        }
        stream.insert(stream.end(), buffer, buffer + count);
      }
      Header header;
      while (franka_core::fci::gripper::nextMessage({stream.data(), stream.size()}, 64, header) ==
                 franka_core::fci::CodecError::kNone &&
             stream.size() >= header.size && header.size > 0) {
        const Bytes request(stream.begin(), stream.begin() + header.size);
        stream.erase(stream.begin(), stream.begin() + header.size);
        if (!handle(client, header, request)) {
          return;
        }
      }
      if (sends_states && udp_port_ != 0) {
        const sockaddr_in to = loopback(udp_port_);
        const std::lock_guard<std::mutex> lock(mutex_);
        sendto(datagrams_.get(), state_.data(), state_.size(), 0,
               reinterpret_cast<const sockaddr*>(&to), sizeof(to));
      }
    }
  }

  bool handle(int client, const Header& header, const Bytes& request) {
    if (header.command == 0) {
      const auto requested = static_cast<std::uint16_t>(request[10] | request[11] << 8);
      udp_port_ = static_cast<std::uint16_t>(request[12] | request[13] << 8);
      const bool agrees = requested == version_;
      reply(client, header, agrees ? 0 : 1, true);
      return agrees;
    }
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      requests_.push_back(request);
    }
    if (closes) {
      return false;
    }
    if (header.command == stop_command) {
      for (const Header& waiting : pending_) {
        reply(client, waiting, static_cast<std::uint16_t>(Status::kAborted), false);
      }
      pending_.clear();
      reply(client, header, 0, false);
    } else if (answers) {
      reply(client, header, static_cast<std::uint16_t>(answer.load()), false);
    } else {
      pending_.push_back(header);
    }
    return true;
  }

  void reply(int client, const Header& header, std::uint16_t status, bool with_version) {
    const std::uint32_t size = with_version ? 14 : 12;
    Bytes bytes;
    const auto put = [&bytes](std::uint32_t value, int count) {
      for (int i = 0; i < count; i++) {
        bytes.push_back(static_cast<std::uint8_t>(value >> (8 * i)));
      }
    };
    put(header.command, 2);
    put(header.command_id, 4);
    put(size, 4);
    put(status, 2);
    if (with_version) {
      put(version_, 2);
    }
    send(client, bytes.data(), bytes.size(), MSG_NOSIGNAL);
  }

  const std::uint16_t version_;
  Socket listener_{SOCK_STREAM};
  Socket datagrams_{SOCK_DGRAM};
  std::uint16_t udp_port_{0};
  std::vector<Header> pending_;
  std::mutex mutex_;
  Bytes state_;
  std::vector<Bytes> requests_;
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

}  // namespace franka_test
