// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The hand and the vacuum gripper against a fake gripper, over real sockets.
#include <franka/gripper.h>
#include <franka/vacuum_gripper.h>

#include <future>

#include "fake_gripper.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

namespace hand = franka_core::fci::gripper;
namespace vacuum = franka_core::fci::vacuum;

FakeGripper::Bytes handState() {
  hand::State state;
  state.message_id = 4711;
  state.width = 0.031;
  state.max_width = 0.08;
  state.is_grasped = true;
  state.temperature = 37;
  hand::StateBuffer buffer;
  hand::encodeState(state, buffer);
  return {buffer.begin(), buffer.end()};
}

class GripperTest : public testing::Test {
 protected:
  GripperTest() : fake_(3) { fake_.show(handState()); }

  FakeGripper fake_;
};

TEST_F(GripperTest, ConnectsAndReadsItsState) {
  const franka::Gripper gripper(fake_.address());
  EXPECT_EQ(3, gripper.serverVersion());
  const franka::GripperState state = gripper.readOnce();
  EXPECT_EQ(0.031, state.width);
  EXPECT_EQ(0.08, state.max_width);
  EXPECT_TRUE(state.is_grasped);
  EXPECT_EQ(37, state.temperature);
  EXPECT_EQ(4711u, state.time.toMSec());
}

TEST(Gripper, StepsDownToAnOlderHand) {
  FakeGripper fake(2);
  EXPECT_EQ(2, franka::Gripper(fake.address()).serverVersion());
}

TEST(Gripper, ReportsTheVersionItFound) {
  FakeGripper fake(7);
  try {
    const franka::Gripper gripper(fake.address());
    FAIL();
  } catch (const franka::IncompatibleVersionException& error) {
    EXPECT_EQ(7, error.server_version);
    EXPECT_EQ(3, error.library_version);
  }
}

TEST_F(GripperTest, SendsRequestsWithTheirArguments) {
  const franka::Gripper gripper(fake_.address());
  EXPECT_TRUE(gripper.homing());
  EXPECT_TRUE(gripper.move(0.05, 0.1));
  EXPECT_TRUE(gripper.grasp(0.03, 0.05, 20.0, 0.001, 0.002));
  EXPECT_TRUE(gripper.stop());
  const auto requests = fake_.requests();
  ASSERT_EQ(4u, requests.size());
  hand::Header header;
  hand::Request request;
  ASSERT_EQ(franka_core::fci::CodecError::kNone,
            hand::decodeRequest({requests[2].data(), requests[2].size()}, header, request));
  const auto& grasp = std::get<hand::GraspRequest>(request);
  EXPECT_EQ(0.03, grasp.width);
  EXPECT_EQ(0.05, grasp.speed);
  EXPECT_EQ(20.0, grasp.force);
  EXPECT_EQ(0.001, grasp.epsilon_inner);
  EXPECT_EQ(0.002, grasp.epsilon_outer);
}

TEST_F(GripperTest, DistinguishesAllReplies) {
  const franka::Gripper gripper(fake_.address());
  fake_.answer = FakeGripper::Status::kUnsuccessful;
  EXPECT_FALSE(gripper.move(0.01, 0.1));
  fake_.answer = FakeGripper::Status::kFail;
  EXPECT_EQ("libfranka gripper: Command failed!",
            textOf<franka::CommandException>([&] { gripper.homing(); }));
  fake_.answer = FakeGripper::Status::kAborted;
  EXPECT_EQ("libfranka gripper: Command aborted!",
            textOf<franka::CommandException>([&] { gripper.homing(); }));
}

TEST_F(GripperTest, AnotherThreadCanStopIt) {
  const franka::Gripper gripper(fake_.address());
  fake_.answers = false;
  auto moving = std::async(std::launch::async, [&] {
    return textOf<franka::CommandException>([&] { gripper.move(0.0, 0.01); });
  });
  while (fake_.requests().empty()) {
    std::this_thread::yield();
  }
  EXPECT_EQ(0.031, gripper.readOnce().width);  // states go on meanwhile
  EXPECT_TRUE(gripper.stop());
  EXPECT_EQ("libfranka gripper: Command aborted!", moving.get());
}

TEST_F(GripperTest, EveryWaitTimesOut) {
  const ShortTimeouts timeouts;
  const franka::Gripper gripper(fake_.address());
  fake_.answers = false;
  EXPECT_TRUE(startsWith(textOf<franka::NetworkException>([&] { gripper.homing(); }),
                         "libfranka: Connection timeout."));
  fake_.sends_states = false;
  EXPECT_EQ("libfranka: UDP receive: Timeout", textOf<franka::NetworkException>([&] {
              while (true) {  // some may still be in transit
                gripper.readOnce();
              }
            }));
  fake_.closes = true;
  EXPECT_EQ("libfranka: server closed connection",
            textOf<franka::NetworkException>([&] { gripper.move(0.01, 0.1); }));
}

TEST_F(GripperTest, RefusesAStateOfAnotherSize) {
  FakeGripper::Bytes too_short = handState();
  too_short.pop_back();
  fake_.show(too_short);
  const franka::Gripper gripper(fake_.address());
  EXPECT_EQ("libfranka: incorrect object size",
            textOf<franka::ProtocolException>([&] { gripper.readOnce(); }));
}

TEST(VacuumGripper, SendsRequestsAndReadsStates) {
  FakeGripper fake(1);
  fake.stop_command = 3;
  vacuum::State sent;
  sent.message_id = 9;
  sent.part_present = true;
  sent.device_status = vacuum::DeviceStatus::kOrange;
  sent.actual_power = 80;
  sent.vacuum = 600;
  vacuum::StateBuffer buffer;
  vacuum::encodeState(sent, buffer);
  fake.show({buffer.begin(), buffer.end()});

  const franka::VacuumGripper gripper(fake.address());
  EXPECT_EQ(1, gripper.serverVersion());
  EXPECT_TRUE(gripper.vacuum(60, std::chrono::milliseconds(1500),
                             franka::VacuumGripper::ProductionSetupProfile::kP2));
  EXPECT_TRUE(gripper.dropOff(std::chrono::milliseconds(500)));
  EXPECT_TRUE(gripper.stop());
  const auto requests = fake.requests();
  vacuum::Header header;
  vacuum::Request request;
  ASSERT_EQ(franka_core::fci::CodecError::kNone,
            vacuum::decodeRequest({requests[0].data(), requests[0].size()}, header, request));
  const auto& received = std::get<vacuum::VacuumRequest>(request);
  EXPECT_EQ(60, received.vacuum);
  EXPECT_EQ(vacuum::Profile::kP2, received.profile);
  EXPECT_EQ(1500, received.timeout_ms);

  const franka::VacuumGripperState state = gripper.readOnce();
  EXPECT_TRUE(state.part_present);
  EXPECT_FALSE(state.part_detached);
  EXPECT_EQ(franka::VacuumGripperDeviceStatus::kOrange, state.device_status);
  EXPECT_EQ(80, state.actual_power);
  EXPECT_EQ(600, state.vacuum);

  fake.answer = FakeGripper::Status::kFail;
  EXPECT_EQ("libfranka vacuum gripper: Command failed!", textOf<franka::CommandException>([&] {
              gripper.dropOff(std::chrono::milliseconds(1));
            }));
}

}  // namespace
}  // namespace franka_test
