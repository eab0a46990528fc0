// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The fake robot, tested with plain sockets and hand-written bytes.
#include "fake_robot.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>

namespace franka_test {
namespace {

using Bytes = std::vector<std::uint8_t>;

sockaddr_in toAddress(const std::string& address) {
  sockaddr_in result{};
  result.sin_family = AF_INET;
  result.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  result.sin_port =
      htons(static_cast<std::uint16_t>(std::stoi(address.substr(address.find(':') + 1))));
  return result;
}

/// A client without any of our code.
class Client {
 public:
  explicit Client(const FakeRobot& robot) {
    const sockaddr_in address = toAddress(robot.address());
    tcp_ = socket(AF_INET, SOCK_STREAM, 0);
    udp_ = socket(AF_INET, SOCK_DGRAM, 0);
    const timeval timeout{30, 0};
    setsockopt(tcp_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
    setsockopt(udp_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
    EXPECT_EQ(0, connect(tcp_, reinterpret_cast<const sockaddr*>(&address), sizeof(address)));
    sockaddr_in own{};
    own.sin_family = AF_INET;
    socklen_t size = sizeof(own);
    bind(udp_, reinterpret_cast<sockaddr*>(&own), sizeof(own));
    getsockname(udp_, reinterpret_cast<sockaddr*>(&own), &size);
    udp_port_ = ntohs(own.sin_port);
  }
  ~Client() {
    close(tcp_);
    close(udp_);
  }

  void send(const Bytes& bytes) {
    EXPECT_EQ(static_cast<ssize_t>(bytes.size()), ::send(tcp_, bytes.data(), bytes.size(), 0));
  }
  Bytes receive(std::size_t size) {
    Bytes bytes(size);
    const ssize_t got = recv(tcp_, bytes.data(), size, MSG_WAITALL);
    bytes.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return bytes;
  }
  Bytes receiveState() {
    Bytes bytes(4096);
    socklen_t size = sizeof(robot_);
    const ssize_t got =
        recvfrom(udp_, bytes.data(), bytes.size(), 0, reinterpret_cast<sockaddr*>(&robot_), &size);
    bytes.resize(got < 0 ? 0 : static_cast<std::size_t>(got));
    return bytes;
  }
  void answer(const Bytes& command) {
    sendto(udp_, command.data(), command.size(), 0, reinterpret_cast<const sockaddr*>(&robot_),
           sizeof(robot_));
  }
  void connectTo(std::uint8_t version) {
    send({0, 0, 0, 0, 0, 0, 0, 0, 16, 0, 0, 0, version, 0,
          static_cast<std::uint8_t>(udp_port_ & 0xff), static_cast<std::uint8_t>(udp_port_ >> 8)});
  }

 private:
  int tcp_, udp_;
  std::uint16_t udp_port_{0};
  sockaddr_in robot_{};
};

std::uint64_t idOf(const Bytes& datagram) {
  std::uint64_t id = 0;
  std::memcpy(&id, datagram.data(), sizeof(id));
  return id;
}

TEST(FakeRobot, AnswersConnectAndSendsStates) {
  const std::size_t sizes[] = {2085, 2341, 2373, 2373, 2373, 2373, 2373, 1377};
  for (std::uint8_t version = 3; version <= 10; version++) {
    FakeRobot robot(version);
    Client client(robot);
    client.connectTo(version);
    EXPECT_EQ(Bytes({0, 0, 0, 0, 0, 0, 0, 0, 15, 0, 0, 0, 0, version, 0}), client.receive(15));
    const Bytes first = client.receiveState();
    EXPECT_EQ(sizes[version - 3], first.size());
    EXPECT_GE(idOf(first), 1u);
    EXPECT_EQ(idOf(first) + 1, idOf(client.receiveState()));
  }
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

TEST(FakeRobot, MisbehavesAsScripted) {
  FakeRobot robot(5);
  robot.script([](FakeRobot::Script& s) {
    s.abort_after = 1;
    s.abort_errors = {14};
    s.repeated[FakeRobot::Command::kMove] = 1;
  });
  Client client(robot);
  client.connectTo(5);
  client.receive(15);
  Bytes state = client.receiveState();
  client.send(moveRequest());
  EXPECT_EQ(26u, client.receive(26).size());  // the first reply, twice
  do {
    state = client.receiveState();
    ASSERT_EQ(2373u, state.size());
  } while (state[2280] != 2);
  Bytes command(370);
  std::memcpy(command.data(), state.data(), 8);
  client.answer(command);
  do {
    state = client.receiveState();
    ASSERT_EQ(2373u, state.size());
  } while (state[2280] == 2);
  EXPECT_EQ(4, state[2364]);             // Reflex
  EXPECT_EQ(1, state[2323 + 14]);        // reflex_reason
  EXPECT_EQ(6, client.receive(13)[12]);  // ReflexAborted
  robot.script([](FakeRobot::Script& s) { s.fatal.insert(FakeRobot::Command::kStopMove); });
  client.send({2, 0, 0, 0, 2, 0, 0, 0, 12, 0, 0, 0});
  client.receive(13);  // the repeated reply
  EXPECT_TRUE(client.receive(1).empty());
}

}  // namespace
}  // namespace franka_test
