// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The whole simulated robot over real sockets, in lock-step.
#include <franka_core/fci/gripper_codec.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_pushes.h>
#include <ros_test/eventually.h>

#include <optional>
#include <random>

#include "simulated_robots.h"
#include "test_client.h"

namespace franka_sim::fci {
namespace {

namespace codec = franka_core::fci;
using codec::Command;
using codec::Status;
using franka_core::RobotMode;
using franka_test::TestClient;

void connect(TestClient& client, std::uint16_t version = 5) {
  client.connect(version);
  const auto answer = client.answer(Command::kConnect);
  ASSERT_TRUE(answer);
  ASSERT_EQ(answer->reply.status, Status::kSuccess);
}

std::uint64_t hashOfARun(unsigned delays) {
  SimulatedRobots simulated(std::vector<Place>{{5}});
  {
    franka::Robot robot(simulated.address(), franka::RealtimeConfig::kIgnore);
    std::mt19937 engine(delays);
    for (const double angle : {0.2, -0.2}) {
      swing(robot, angle, [&](int) {
        if (delays != 0 && engine() % 50 == 0) {
          const std::chrono::microseconds pause(engine() % 3000);
          std::this_thread::sleep_for(pause);  // the fault itself
        }
      });
    }
    robot.setLoad(0, {}, {});  // answered after the world has come to rest
  }
  simulated.finish();
  return simulated.hash();
}

TEST(LockStep, RepeatsBitForBitForAnyPausesOfTheClient) {
  const std::uint64_t first = hashOfARun(0);
  for (unsigned delays = 1; delays <= 4; delays++) {
    EXPECT_EQ(hashOfARun(delays), first) << delays;
  }
}

/// The first state in that mode; empty if there is none in time.
std::optional<franka_core::RobotState> stateIn(TestClient& client, RobotMode mode) {
  std::optional<franka_core::RobotState> state;
  const bool found = ros_test::eventually(
      [&] {
        state = client.state();
        return !state || state->robot_mode == mode;
      },
      std::chrono::microseconds(0));
  return found ? state : std::nullopt;
}

TEST(LockStep, AClientThatDiesBeforeItsFirstCommandEndsItsMotion) {
  SimulatedRobots simulated(std::vector<Place>{{5}});
  {
    TestClient client(simulated.port());
    connect(client);
    client.request(codec::MoveRequest{});
    ASSERT_EQ(client.answer(Command::kMove)->reply.status, Status::kMotionStarted);
  }
  TestClient next(simulated.port());
  connect(next);
  const auto state = stateIn(next, RobotMode::kReflex);
  ASSERT_TRUE(state) << "the robot is left in Move";
  EXPECT_TRUE(state->errors[25]);  // communication_constraints_violation
  next.request(codec::AutomaticErrorRecoveryRequest{});
  const auto recovered = next.answer(Command::kAutomaticErrorRecovery);
  ASSERT_TRUE(recovered);
  EXPECT_EQ(recovered->reply.status, Status::kSuccess);
}

TEST(LockStep, AnArmThatCoastsInGuidingDoesNotDeferRequests) {
  SimulatedRobots simulated(std::vector<Place>{{5}});
  TestClient client(simulated.port());
  connect(client);
  simulated.between([](SimRobot& robot, World& world, Host& host) {
    robot.unit().request(Guiding{true});
    pushBody(world, "panda_link5", {0, 8, 0}, {}, 100);
    host.runFree(100);
  });
  for (int i = 0; i < 3; i++) {
    client.request(codec::SetLoadRequest{});
    const auto answer = client.answer(Command::kSetLoad);
    ASSERT_TRUE(answer);
    EXPECT_EQ(answer->reply.status, Status::kSuccess);
  }
  double fastest = 0.0;
  std::uint64_t ticks = 0;
  simulated.between([&](SimRobot& robot, World&, Host& host) {
    for (const double dq : robot.unit().state().dq) {
      fastest = std::max(fastest, std::abs(dq));
    }
    ticks = host.ticks();
  });
  EXPECT_GT(fastest, 1e-3) << "the arm came to rest by itself: the test is void";
  const auto begin = client.state();
  ASSERT_TRUE(begin);
  for (int i = 0; i < 50; i++) {
    ASSERT_TRUE(client.state());
  }
  simulated.between([&](SimRobot&, World&, Host& host) { EXPECT_EQ(ticks, host.ticks()); });
}

double width(SimulatedRobots& simulated) {
  double width = 0.0;
  simulated.between([&](SimRobot&, World& world, Host&) {
    const HandMeasurement hand = world.hand("panda", "panda").measure();
    width = hand.q[0] + hand.q[1];
  });
  return width;
}

TEST(LockStep, AHandFinishesItsCommandAfterItsClientDies) {
  namespace hand = franka_core::fci::gripper;
  SimulatedRobots simulated(std::vector<Place>{{5}});
  {
    TestClient client(simulated.gripperPort());
    hand::RequestMessage message;
    hand::encodeRequest(0, hand::ConnectRequest{3, client.udpPort()}, message);
    ASSERT_TRUE(client.sendBytes(message.data, message.size));
    hand::encodeRequest(1, hand::MoveRequest{0.06, 0.02}, message);
    ASSERT_TRUE(client.sendBytes(message.data, message.size));
    EXPECT_TRUE(ros_test::eventually([&] { return width(simulated) > 0.005; }));
  }
  EXPECT_TRUE(ros_test::eventually([&] { return std::abs(width(simulated) - 0.06) < 1e-3; }));
}

}  // namespace
}  // namespace franka_sim::fci
