// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/protocol.h>
#include <franka_core/fci/state_codec.h>

#include <atomic>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

#include "loopback_socket.h"

namespace franka_bench {

using franka_test::Socket;

/// The minimal UDP peer: answers each datagram at once by one whose first eight bytes count up.
class Echo {
 public:
  /// Waits for a datagram, answers it. @returns false if none came.
  bool answerOne(std::vector<std::uint8_t>& answer) {
    std::uint8_t buffer[4096];
    socklen_t size = sizeof(peer_);
    if (recvfrom(socket_.get(), buffer, sizeof(buffer), 0, reinterpret_cast<sockaddr*>(&peer_),
                 &size) <= 0) {
      return false;
    }
    send(answer);
    return true;
  }
  void send(std::vector<std::uint8_t>& datagram) {
    id_++;
    std::memcpy(datagram.data(), &id_, sizeof(id_));
    sendto(socket_.get(), datagram.data(), datagram.size(), 0,
           reinterpret_cast<const sockaddr*>(&peer_), sizeof(peer_));
  }
  void setPeer(const sockaddr_in& peer) { peer_ = peer; }
  bool hasDatagram() const {
    std::uint8_t byte;
    return recv(socket_.get(), &byte, 1, MSG_PEEK | MSG_DONTWAIT) >= 0;
  }
  const sockaddr_in& address() const { return socket_.address(); }

 private:
  Socket socket_{SOCK_DGRAM};
  sockaddr_in peer_{};
  std::uint64_t id_{0};
};

/// A bare UDP echo in its own thread.
class EchoServer {
 public:
  explicit EchoServer(std::size_t answer_size)
      : answer_(answer_size), thread_([this] {
          while (!stopping_) {
            echo_.answerOne(answer_);
          }
        }) {}
  ~EchoServer() {
    stopping_ = true;
    thread_.join();
  }
  const sockaddr_in& address() const { return echo_.address(); }

 private:
  Echo echo_;
  std::vector<std::uint8_t> answer_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

/// A robot reduced to the same echo: during a motion it only sends the next state for each command.
class EchoRobot {
 public:
  explicit EchoRobot(std::uint16_t version);
  ~EchoRobot();
  std::string address() const { return "127.0.0.1:" + std::to_string(listener_.port()); }

 private:
  enum class Phase { kClosed, kIdle, kMoving };
  void serve();
  void serveClient(int client);
  Phase handleRequests(int client, Phase phase);

  const std::uint16_t version_;
  Socket listener_{SOCK_STREAM};
  Echo echo_;
  std::vector<std::uint8_t> stream_;
  std::atomic<bool> stopping_{false};
  std::thread thread_;
};

}  // namespace franka_bench
