// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <arpa/inet.h>
#include <franka_core/fci/command_codec.h>
#include <franka_core/fci/reply_codec.h>
#include <franka_core/fci/state_codec.h>
#include <gtest/gtest.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <optional>
#include <vector>

namespace franka_test {

namespace codec = franka_core::fci;

constexpr int kDeadline = 30000;  // [ms]

/// A client in single steps: every step of the protocol is one call. Blocks at most 30 s.
class TestClient {
 public:
  explicit TestClient(std::uint16_t port, const char* address = "127.0.0.1")
      : tcp_(::socket(AF_INET, SOCK_STREAM, 0)), udp_(::socket(AF_INET, SOCK_DGRAM, 0)) {
    const int at_once = 1;  // sends small requests without delay
    ::setsockopt(tcp_, IPPROTO_TCP, TCP_NODELAY, &at_once, sizeof(at_once));
    sockaddr_in server{};
    server.sin_family = AF_INET;
    server.sin_port = htons(port);
    inet_pton(AF_INET, address, &server.sin_addr);
    connected_ = ::connect(tcp_, reinterpret_cast<sockaddr*>(&server), sizeof(server)) == 0;
    sockaddr_in any{};
    any.sin_family = AF_INET;
    ::bind(udp_, reinterpret_cast<sockaddr*>(&any), sizeof(any));
    socklen_t size = sizeof(any);
    ::getsockname(udp_, reinterpret_cast<sockaddr*>(&any), &size);
    udp_port_ = ntohs(any.sin_port);
  }
  ~TestClient() { close(); }
  TestClient(const TestClient&) = delete;
  TestClient& operator=(const TestClient&) = delete;

  void close() {
    if (tcp_ >= 0) {
      ::close(tcp_);
      ::close(udp_);
      tcp_ = udp_ = -1;
    }
  }

  bool connected() const { return connected_; }
  std::uint16_t udpPort() const { return udp_port_; }

  bool sendBytes(const void* data, std::size_t size) {
    return ::send(tcp_, data, size, MSG_NOSIGNAL) == static_cast<ssize_t>(size);
  }
  /// @returns the request's id.
  std::uint32_t request(const codec::Request& request) {
    codec::RequestMessage message;
    EXPECT_EQ(codec::encodeRequest(version_, next_id_, request, message), codec::CodecError::kNone);
    EXPECT_TRUE(sendBytes(message.data, message.size));
    return next_id_++;
  }
  std::uint32_t connect(std::uint16_t version) {
    version_ = version >= 3 && version <= 10 ? version : 5;
    return request(codec::ConnectRequest{version, udp_port_});
  }

  struct Answer {
    codec::Header header;
    codec::Reply reply;
    std::vector<std::uint8_t> model;
  };
  /// The next reply, read as one to `command`; empty if the connection has ended or no reply
  /// arrives within `timeout_ms`.
  std::optional<Answer> answer(codec::Command command, int timeout_ms = kDeadline) {
    std::vector<std::uint8_t> bytes;
    if (!read(bytes, codec::kHeaderSize, timeout_ms)) {
      return std::nullopt;
    }
    codec::Header header;
    codec::nextMessage({bytes.data(), bytes.size()}, codec::kMaxReplySize, header);
    if (!read(bytes, header.size, timeout_ms)) {
      return std::nullopt;
    }
    Answer answer;
    codec::Bytes model;
    EXPECT_EQ(codec::decodeReply(version_, command, {bytes.data(), bytes.size()}, answer.header,
                                 answer.reply, model),
              codec::CodecError::kNone);
    answer.model.assign(model.data, model.data + model.size);
    return answer;
  }
  /// Whether the server has ended the connection.
  bool ended(int timeout_ms = kDeadline) {
    std::vector<std::uint8_t> bytes;
    return !read(bytes, 1, timeout_ms) && ended_;
  }

  /// The next datagram; empty if none arrives.
  std::vector<std::uint8_t> datagram(int timeout_ms = kDeadline) {
    pollfd waiting{udp_, POLLIN, 0};
    if (::poll(&waiting, 1, timeout_ms) != 1) {
      return {};
    }
    std::uint8_t buffer[4096];
    socklen_t size = sizeof(robot_);
    const ssize_t received =
        ::recvfrom(udp_, buffer, sizeof(buffer), 0, reinterpret_cast<sockaddr*>(&robot_), &size);
    return {buffer, buffer + received};
  }
  /// The next state; empty if none arrives.
  std::optional<franka_core::RobotState> state(int timeout_ms = kDeadline) {
    const std::vector<std::uint8_t> bytes = datagram(timeout_ms);
    if (bytes.empty()) {
      return std::nullopt;
    }
    franka_core::RobotState state;
    EXPECT_EQ(codec::decodeState(version_, {bytes.data(), bytes.size()}, state),
              codec::CodecError::kNone);
    return state;
  }
  void sendDatagram(const void* data, std::size_t size) {
    ::sendto(udp_, data, size, 0, reinterpret_cast<sockaddr*>(&robot_), sizeof(robot_));
  }
  void command(const franka_core::RobotCommand& command) {
    codec::CommandBuffer buffer{};
    codec::encodeCommand(version_, command, buffer);
    sendDatagram(buffer.data(), codec::commandSize(version_));
  }

 private:
  bool read(std::vector<std::uint8_t>& bytes, std::size_t size, int timeout_ms) {
    while (bytes.size() < size) {
      pollfd waiting{tcp_, POLLIN, 0};
      if (::poll(&waiting, 1, timeout_ms) != 1) {
        return false;
      }
      std::uint8_t buffer[65536];
      const std::size_t chunk = std::min(sizeof(buffer), size - bytes.size());
      const ssize_t received = ::recv(tcp_, buffer, chunk, 0);
      if (received <= 0) {
        ended_ = true;
        return false;
      }
      bytes.insert(bytes.end(), buffer, buffer + received);
    }
    return true;
  }

  int tcp_, udp_;
  bool connected_{false}, ended_{false};
  std::uint16_t udp_port_{0}, version_{5};
  std::uint32_t next_id_{0};
  sockaddr_in robot_{};
};

}  // namespace franka_test
