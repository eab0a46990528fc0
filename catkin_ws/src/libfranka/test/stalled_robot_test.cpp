// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Robots and hands on this machine that stand still for longer than Timeouts::state, as on a busy
// machine, and ones that are gone.
#include <franka/gripper.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "fake_gripper.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kStall{250};

/// A client that waits for kStall only because the robot is on its own machine.
franka::Timeouts shorterThanTheStall() {
  franka::Timeouts timeouts;
  timeouts.state = milliseconds(50);
  timeouts.silence = std::chrono::minutes(10);
  return timeouts;
}

class StalledRobot : public ::testing::TestWithParam<std::uint16_t> {
 protected:
  /// The robot stands still before it sends the state after the next `after` ones.
  /// @param in_motion counted from the next Move
  void stall(int after, bool in_motion) {
    stalled = false;
    const int moves = fake.count(Command::kMove);
    fake.script([=](FakeRobot::Script& script) {
      script.transmit = [=, left = after](const FakeRobot::Datagram& state) mutable {
        const bool counts = !in_motion || fake.count(Command::kMove) > moves;
        if (counts && left-- == 0) {
          std::this_thread::sleep_for(kStall);  // the fault itself
          stalled = true;
        }
        return std::vector<FakeRobot::Datagram>{state};
      };
    });
  }

  const ScopedTimeouts timeouts{shorterThanTheStall()};
  std::atomic<bool> stalled{false};
  FakeRobot fake{GetParam()};
};

TEST_P(StalledRobot, IsWaitedForByReadOnce) {
  const auto robot = connect(fake);
  stall(1, false);
  while (!stalled) {
    ASSERT_NO_THROW(robot->readOnce());
  }
}

TEST_P(StalledRobot, IsWaitedForAtTheStartOfAMotion) {
  // From the first state after MotionStarted to the first ones after a command.
  for (int after = 0; after < 6; after++) {
    const auto robot = connect(fake);
    stall(after, true);
    int cycles = 0;
    EXPECT_NO_THROW(robot->control([&](const franka::RobotState&, franka::Duration) {
      franka::Torques torques({0, 0, 0, 0, 0, 0, 0});
      return ++cycles == 20 ? franka::MotionFinished(torques) : torques;
    })) << after;
    EXPECT_EQ(20, cycles) << after;
    EXPECT_TRUE(stalled) << after;
  }
}

INSTANTIATE_TEST_SUITE_P(NewestOfEachRobot, StalledRobot,
                         ::testing::Values(std::uint16_t{5}, std::uint16_t{10}), versionName);

/// Ends a fake that sends no more states while its device reads.
template <typename Fake, typename Device>
void expectClosedWhileReading(std::unique_ptr<Fake> fake, Device& device) {
  std::thread killer([&fake] {
    std::this_thread::sleep_for(kStall);  // the fault itself
    fake.reset();
  });
  EXPECT_EQ(kClosed, textOf<franka::NetworkException>([&device] {
              while (true) {  // some may still be in transit
                device.readOnce();
              }
            }));
  killer.join();
}

TEST(DeadRobot, IsNoticedAtOnce) {
  const ScopedTimeouts timeouts(shorterThanTheStall());
  auto fake = std::make_unique<FakeRobot>(10);
  const auto robot = connect(*fake);
  fake->script([](FakeRobot::Script& script) { script.sends_states = false; });
  expectClosedWhileReading(std::move(fake), *robot);
}

FakeGripper::Bytes anyHandState() {
  franka_core::fci::gripper::StateBuffer buffer;
  franka_core::fci::gripper::encodeState({}, buffer);
  return {buffer.begin(), buffer.end()};
}

TEST(StalledHand, IsWaitedFor) {
  const ScopedTimeouts timeouts(shorterThanTheStall());
  FakeGripper fake(3);
  fake.show(anyHandState());
  const franka::Gripper gripper(fake.address());
  fake.sends_states = false;
  std::thread waker([&] {
    std::this_thread::sleep_for(kStall);  // the fault itself
    fake.sends_states = true;
  });
  do {  // some may still be in transit
    EXPECT_NO_THROW(gripper.readOnce());
  } while (!fake.sends_states);
  waker.join();
}

TEST(DeadHand, IsNoticedAtOnce) {
  const ScopedTimeouts timeouts(shorterThanTheStall());
  auto fake = std::make_unique<FakeGripper>(3);
  fake->show(anyHandState());
  const franka::Gripper gripper(fake->address());
  fake->sends_states = false;
  expectClosedWhileReading(std::move(fake), gripper);
}

}  // namespace
}  // namespace franka_test
