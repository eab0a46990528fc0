// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The fake robot, tested with plain sockets and hand-written bytes.
#include "fake_robot.h"

#include <gtest/gtest.h>

#include <cstring>

namespace franka_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A client without any of our code.
class Client {
 public:
  explicit Client(const FakeRobot& robot) {
    const std::string address = robot.address();
    const int port = std::stoi(address.substr(address.find(':') + 1));
    const sockaddr_in server = loopback(static_cast<std::uint16_t>(port));
    EXPECT_EQ(0, connect(tcp_.get(), reinterpret_cast<const sockaddr*>(&server), sizeof(server)));
  }

  void send(const Bytes& bytes) {
    EXPECT_EQ(static_cast<ssize_t>(bytes.size()),
              ::send(tcp_.get(), bytes.data(), bytes.size(), 0));
  }
  Bytes receive(std::size_t size) {
    Bytes bytes(size);
    const ssize_t got = recv(tcp_.get(), bytes.data(), size, MSG_WAITALL);
    bytes.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return bytes;
  }
  Bytes receiveState() {
    Bytes bytes(4096);
    socklen_t size = sizeof(robot_);
    const ssize_t got = recvfrom(udp_.get(), bytes.data(), bytes.size(), 0,
                                 reinterpret_cast<sockaddr*>(&robot_), &size);
    bytes.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return bytes;
  }
  void answer(const Bytes& command) {
    sendto(udp_.get(), command.data(), command.size(), 0,
           reinterpret_cast<const sockaddr*>(&robot_), sizeof(robot_));
  }
  void connectTo(std::uint8_t version) {
    send({0, 0, 0, 0, 0, 0, 0, 0, 16, 0, 0, 0, version, 0,
          static_cast<std::uint8_t>(udp_.port() & 0xff),
          static_cast<std::uint8_t>(udp_.port() >> 8)});
  }

 private:
  Socket tcp_{SOCK_STREAM, 30000}, udp_{SOCK_DGRAM, 30000};
  sockaddr_in robot_{};
};

std::uint64_t idOf(const Bytes& datagram) {
  std::uint64_t id = 0;
  std::memcpy(&id, datagram.data(), sizeof(id));
  return id;
}

// Move with external torques and joint velocities, command id 1.
Bytes moveRequest() {
  Bytes request{1, 0, 0, 0, 1, 0, 0, 0, 68, 0, 0, 0, 2, 0, 0, 0, 1, 0, 0, 0};
  request.resize(68);
  return request;
}

TEST(FakeRobot, RunsAMotionInLockStep) {
  FakeRobot robot(5);
  Client client(robot);
  client.connectTo(5);
  client.receive(15);
  client.receiveState();
  client.send(moveRequest());
  EXPECT_EQ(Bytes({1, 0, 0, 0, 1, 0, 0, 0, 13, 0, 0, 0, 1}), client.receive(13));
  Bytes state;
  do {
    state = client.receiveState();
    ASSERT_EQ(2373u, state.size());
  } while (state[2280] != 2);
  EXPECT_EQ(2, state[2281]);  // external controller
  EXPECT_EQ(2, state[2364]);  // Move
  for (int i = 0; i < 100; i++) {
    Bytes command(370);
    std::memcpy(command.data(), state.data(), 8);
    command[313] = i == 99 ? 1 : 0;
    client.answer(command);
    const Bytes next = client.receiveState();
    ASSERT_EQ(idOf(state) + 1, idOf(next));
    state = next;
  }
  EXPECT_EQ(0, state[2280]);
  EXPECT_EQ(1, state[2364]);
  EXPECT_EQ(Bytes({1, 0, 0, 0, 1, 0, 0, 0, 13, 0, 0, 0, 0}), client.receive(13));
  EXPECT_EQ(100u, robot.exchanges().size());
}

}  // namespace
}  // namespace franka_test
