// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Uses the library with a real connection to a fake gripper whose answers the test sets.
#include <arpa/inet.h>
#include <franka_gripper/franka_gripper.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <atomic>
#include <cstdint>
#include <cstring>
#include <thread>
#include <vector>

namespace {

/// Answers every request with `status`; sends a state every few milliseconds.
class FakeHand {
 public:
  FakeHand() {
    listener_ = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(address);
    bind(listener_, reinterpret_cast<sockaddr*>(&address), size);
    listen(listener_, 1);
    getsockname(listener_, reinterpret_cast<sockaddr*>(&address), &size);
    port_ = ntohs(address.sin_port);
    datagrams_ = socket(AF_INET, SOCK_DGRAM, 0);
    thread_ = std::thread([this] { run(); });
  }
  ~FakeHand() {
    ended_ = true;
    thread_.join();
    close(listener_);
    close(datagrams_);
  }

  std::string address() const { return "127.0.0.1:" + std::to_string(port_); }

  std::atomic<std::uint16_t> status{0};  ///< 0 success, 1 refused, 2 unsuccessful
  std::vector<std::uint8_t> last;        ///< the request answered last

 private:
  void run() {
    int client = -1;
    sockaddr_in to{};
    while (!ended_) {
      pollfd waiting{client < 0 ? listener_ : client, POLLIN, 0};
      if (poll(&waiting, 1, 5) == 1) {
        if (client < 0) {
          client = accept(listener_, nullptr, nullptr);
        } else if (!answer(client, to)) {
          break;
        }
      }
      sendState(to);
    }
    close(client);
  }

  bool answer(int client, sockaddr_in& to) {
    std::array<std::uint8_t, 64> request{};
    const ssize_t size = recv(client, request.data(), request.size(), 0);
    if (size < 10) {
      return false;
    }
    const bool connects = request[0] == 0;
    std::vector<std::uint8_t> reply(request.begin(), request.begin() + 14);
    const std::uint16_t answer = connects ? 0 : status.load();
    const std::uint32_t length = connects ? 14 : 12;
    std::memcpy(&reply[6], &length, 4);
    std::memcpy(&reply[10], &answer, 2);
    if (connects) {
      std::memcpy(&reply[12], &request[10], 2);  // the requested version
      to.sin_family = AF_INET;
      to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
      std::uint16_t port;
      std::memcpy(&port, &request[12], 2);
      to.sin_port = htons(port);
    } else {
      last.assign(request.begin(), request.begin() + size);
    }
    send(client, reply.data(), length, MSG_NOSIGNAL);
    return true;
  }

  void sendState(const sockaddr_in& to) const {
    if (to.sin_port == 0) {
      return;
    }
    std::array<std::uint8_t, 23> state{};
    const double width = 0.04;
    const double max_width = 0.08;
    std::memcpy(&state[4], &width, 8);
    std::memcpy(&state[12], &max_width, 8);
    sendto(datagrams_, state.data(), state.size(), 0, reinterpret_cast<const sockaddr*>(&to),
           sizeof(to));
  }

  int listener_{-1};
  int datagrams_{-1};
  std::uint16_t port_{0};
  std::atomic<bool> ended_{false};
  std::thread thread_;
};

double number(const std::vector<std::uint8_t>& request, std::size_t index) {
  double value;
  std::memcpy(&value, &request.at(10 + 8 * index), 8);
  return value;
}

TEST(GripperLibrary, ReadsTheState) {
  FakeHand hand;
  const franka::Gripper gripper(hand.address());
  franka::GripperState state;
  ASSERT_TRUE(franka_gripper::updateGripperState(gripper, &state));
  EXPECT_EQ(0.04, state.width);
  EXPECT_EQ(0.08, state.max_width);
}

TEST(GripperLibrary, ExecutesGoals) {
  FakeHand hand;
  const franka::Gripper gripper(hand.address());
  auto move = boost::make_shared<franka_gripper::MoveGoal>();
  move->width = 0.03;
  move->speed = 0.1;
  EXPECT_TRUE(franka_gripper::move(gripper, move));
  EXPECT_EQ(3, hand.last[0]);
  EXPECT_EQ(0.03, number(hand.last, 0));
  EXPECT_EQ(0.1, number(hand.last, 1));

  auto grasp = boost::make_shared<franka_gripper::GraspGoal>();
  grasp->width = 0.02;
  grasp->epsilon.inner = 0.001;
  grasp->epsilon.outer = 0.002;
  grasp->speed = 0.05;
  grasp->force = 30.0;
  EXPECT_TRUE(franka_gripper::grasp(gripper, grasp));
  EXPECT_EQ(2, hand.last[0]);
  const std::array<double, 5> expected{{0.02, 0.001, 0.002, 0.05, 30.0}};
  for (std::size_t i = 0; i < expected.size(); i++) {
    EXPECT_EQ(expected[i], number(hand.last, i));
  }

  EXPECT_TRUE(franka_gripper::homing(gripper, boost::make_shared<franka_gripper::HomingGoal>()));
  EXPECT_EQ(1, hand.last[0]);
  EXPECT_TRUE(franka_gripper::stop(gripper, boost::make_shared<franka_gripper::StopGoal>()));
  EXPECT_EQ(4, hand.last[0]);
}

TEST(GripperLibrary, DistinguishesFailureAndRefusal) {
  FakeHand hand;
  const franka::Gripper gripper(hand.address());
  hand.status = 2;
  EXPECT_FALSE(franka_gripper::move(gripper, boost::make_shared<franka_gripper::MoveGoal>()));
  hand.status = 1;
  EXPECT_THROW(franka_gripper::move(gripper, boost::make_shared<franka_gripper::MoveGoal>()),
               franka::CommandException);
}

TEST(GripperLibrary, ReportsWhetherTheStateCanBeRead) {
  auto hand = std::make_unique<FakeHand>();
  const franka::Gripper gripper(hand->address());
  hand.reset();
  franka::GripperState state;
  bool read = true;
  for (int i = 0; i < 200 && read; i++) {  // states already sent arrive first
    read = franka_gripper::updateGripperState(gripper, &state);
  }
  EXPECT_FALSE(read);
}

}  // namespace
