// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// A robot with its unit, link and server. The test calls each tick.
#include <franka_core/limits.h>
#include <franka_sim/serve/sim_robot.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "../robot/arm_fixture.h"
#include "fci/robot_server.h"
#include "fci/served_models.h"
#include "test_client.h"

namespace franka_sim::fci {
namespace {

namespace codec = franka_core::fci;
using codec::Command;
using codec::Status;
using franka_core::RobotMode;
using franka_core::RobotState;
using franka_test::TestClient;

RobotServerParameters serverOf(const ProtocolRange& protocols) {
  RobotServerParameters parameters =
      makeServerParameters("127.0.0.1", protocols, test::pandaModel());
  parameters.port = 0;
  return parameters;
}

class SimRobotTest : public ::testing::Test {
 protected:
  explicit SimRobotTest(unsigned version = 10, ProtocolRange protocols = {6, 10})
      : robot(test::pandaOverFci(version), arm, serverOf(protocols), std::nullopt) {
    arm.payload = test::pandaHand();
    arm.push_frame = kHandF_T_NE;
    tick();
  }

  void tick(const std::function<void()>& between = [] {}) {
    robot.observe();
    robot.publish(1, false, false);
    between();
    robot.receiveCommand();
    robot.actuate();
    arm.step();
  }

  void connect(TestClient& client, std::uint16_t version) {
    client.connect(version);
    robot.serve(false);
    const auto answer = client.answer(Command::kConnect);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->reply.status, Status::kSuccess);
  }

  void startMotion(TestClient& client, const codec::MoveRequest& request = {}) {
    client.request(request);
    robot.serve(false);
    const auto answer = client.answer(Command::kMove);
    ASSERT_TRUE(answer);
    ASSERT_EQ(answer->reply.status, Status::kMotionStarted);
  }

  /// Answers the next state.
  static void send(TestClient& client, const std::array<double, 7>& q_c, bool finished = false) {
    const auto shown = client.state();
    ASSERT_TRUE(shown);
    franka_core::RobotCommand command;
    command.message_id = shown->message_id;
    command.q_c = q_c;
    command.motion_generation_finished = finished;
    client.command(command);
  }

  void leave(TestClient& client) {
    client.close();
    while (robot.server().hasClient()) {
      robot.serve(false);
    }
  }

  const RobotState& state() { return robot.unit().state(); }

  test::FakeArm arm{test::pandaModel(), test::kReady};
  SimRobot robot;
};

class Panda : public SimRobotTest {
 protected:
  Panda() : SimRobotTest(5, {3, 5}) {}
};

// The client repeats "finished" until it receives the end; commands then still in transit must not
// end the motion that it starts next.
TEST_F(Panda, StartsAMotionWithoutDelayedCommandsOfTheLast) {
  for (const double delay : {1.0, 2.0}) {
    robot.link().setDelay(delay);
    TestClient client(robot.server().port());
    connect(client, 5);
    startMotion(client);
    bool again = false;
    const auto exchange = [&](bool finished) {
      if (!again && client.answer(Command::kMove, 0)) {
        again = true;
        ASSERT_TRUE(client.state());
        startMotion(client);
        return;
      }
      send(client, test::kReady, finished);
    };
    for (int i = 0; i < 1000 && !again; i++) {
      tick([&] { exchange(i > 20); });
    }
    ASSERT_TRUE(again);
    for (int i = 0; i < 10; i++) {
      tick([&] { exchange(false); });
      ASSERT_EQ(state().robot_mode, RobotMode::kMove) << delay << ", " << i;
    }
    leave(client);
    for (int i = 0; i < 2000 && state().robot_mode != RobotMode::kReflex; i++) {
      tick();
    }
    robot.unit().request(codec::AutomaticErrorRecoveryRequest{});
    for (int i = 0; i < 2000 && state().robot_mode != RobotMode::kIdle; i++) {
      tick();
    }
    ASSERT_EQ(state().robot_mode, RobotMode::kIdle);
  }
}

// A client of libfranka gives up after a second without a datagram.
TEST_F(SimRobotTest, RepeatsAStateToAStartingClientThatWaits) {
  TestClient client(robot.server().port());
  connect(client, 10);
  startMotion(client);
  robot.publish(1, true, false);
  EXPECT_FALSE(robot.repeat()) << "it has not read the state";
  const auto shown = client.state();
  ASSERT_TRUE(shown);
  EXPECT_TRUE(robot.repeat());
  EXPECT_FALSE(robot.repeat()) << "unread repeats would fill its socket";
  const auto repeated = client.state();
  ASSERT_TRUE(repeated);
  EXPECT_EQ(shown->message_id, repeated->message_id);
}

TEST_F(SimRobotTest, ReportsWhyFramesAndLoadsOfAClientAreRefused) {
  std::vector<std::string> reports;
  robot.onRefusal([&](const std::string& what) { reports.push_back(what); });
  TestClient client(robot.server().port());
  connect(client, 10);
  codec::SetNEToEERequest end_effector{franka_core::kIdentityTransform};
  end_effector.NE_T_EE[0] = 0.999;
  codec::SetEEToKRequest stiffness{franka_core::kIdentityTransform};
  stiffness.EE_T_K[3] = 0.1;
  const std::vector<std::pair<codec::Request, std::string>> cases{
      {end_effector, "NE_T_EE"},
      {stiffness, "row-major"},
      {codec::SetLoadRequest{50.0, {}, {}}, "kg"}};
  for (const auto& [request, word] : cases) {
    reports.clear();
    client.request(request);
    robot.serve(false);
    tick();
    const auto answer = client.answer(codec::commandOf(request), 1000);
    ASSERT_TRUE(answer) << word;
    EXPECT_EQ(answer->reply.status, Status::kInvalidArgumentRejected);
    ASSERT_EQ(reports.size(), 1U) << word;
    EXPECT_NE(reports[0].find(word), std::string::npos) << reports[0];
  }
  reports.clear();
  for (int i = 0; i < 200; i++) {
    client.request(end_effector);
    do {
      robot.serve(false);
      tick();
    } while (!client.answer(Command::kSetNEToEE, 1));  // after several at once one has to wait
  }
  EXPECT_LT(reports.size(), 100U);  // a client cannot fill the log
}

TEST_F(SimRobotTest, ReachesATargetSentOnceAndEndsAfterADisconnect) {
  TestClient client(robot.server().port());
  connect(client, 10);
  codec::MoveRequest request;
  request.use_async_motion_generator = true;
  request.maximum_velocity.fill(0.5);
  startMotion(client, request);
  EXPECT_TRUE(robot.asynchronous());
  std::array<double, 7> target = test::kReady;
  target[3] += 0.1;
  tick([&] { send(client, target); });
  for (int i = 0; i < 1500; i++) {
    tick();
    ASSERT_EQ(state().robot_mode, RobotMode::kMove) << i;
  }
  EXPECT_EQ(state().q_d, target);
  EXPECT_EQ(state().control_command_success_rate, 1.0);
  EXPECT_FALSE(robot.settling());
  leave(client);
  EXPECT_TRUE(robot.settling()) << "time must go on without a client";
  for (int i = 0; i < 19; i++) {
    tick();
    ASSERT_EQ(state().robot_mode, RobotMode::kMove) << i;
  }
  tick();
  EXPECT_EQ(state().robot_mode, RobotMode::kReflex);
  EXPECT_TRUE(state().reflex_reason[25]);  // communication_constraints_violation
}

TEST_F(SimRobotTest, AppliesAClientsLimitsAfterAnotherClientsMotion) {
  const auto upper = [this] { return robot.unit().limits().arm.q_max; };
  {
    TestClient first(robot.server().port());
    connect(first, 10);
    startMotion(first);
    leave(first);
  }
  TestClient second(robot.server().port());
  connect(second, 6);
  EXPECT_EQ(state().robot_mode, RobotMode::kMove);
  EXPECT_EQ(upper(), franka_core::limitsOfProtocol(10).q_max) << "a motion keeps its limits";
  for (int i = 0; i < 3000 && state().robot_mode == RobotMode::kMove; i++) {
    tick();
  }
  tick();
  EXPECT_NE(franka_core::limitsOfProtocol(6).q_max, franka_core::limitsOfProtocol(10).q_max);
  EXPECT_EQ(upper(), franka_core::limitsOfProtocol(6).q_max);
}

TEST_F(SimRobotTest, ServesEachVersionAUrdfWithItsLimits) {
  for (const std::uint16_t version : {8, 9, 10}) {
    TestClient client(robot.server().port());
    connect(client, version);
    client.request(codec::GetRobotModelRequest{});
    robot.serve(false);
    const auto answer = client.answer(Command::kGetRobotModel);
    ASSERT_TRUE(answer);
    EXPECT_EQ(std::string(answer->model.begin(), answer->model.end()),
              servedUrdf(test::pandaModel(), version))
        << version;
    leave(client);
  }
}

TEST_F(SimRobotTest, RepeatsLostCommandsAfterARestart) {
  robot.link().setLoss(0.3, 11);
  const auto lost = [this] {
    TestClient client(robot.server().port());
    connect(client, 10);
    startMotion(client);
    std::vector<double> rates;
    for (int i = 0; i < 100; i++) {
      tick([&] { send(client, test::kReady); });
      rates.push_back(state().control_command_success_rate);
    }
    EXPECT_EQ(state().robot_mode, RobotMode::kMove);
    robot.unit().request(codec::StopMoveRequest{});
    leave(client);
    return rates;
  };
  const std::vector<double> first = lost();
  robot.restart();
  tick();
  EXPECT_EQ(lost(), first);
}

TEST_F(Panda, ReportsTheLinksOfASelfCollisionOnce) {
  std::vector<std::string> reports;
  robot.onCollision([&](const std::string& what) { reports.push_back(what); });
  ASSERT_EQ(Status::kMotionStarted, robot.unit().request(torqueControl()));
  EXPECT_EQ(std::string::npos, describe(robot).find("hand"));
  const std::array<double, 7> folded{{0, -0.566, 0, -3.0, 0.085, 0.783, 0.785}};
  for (int i = 1; i <= 1000 && reports.empty(); i++) {
    std::array<double, 7> q = test::kReady;
    for (std::size_t j = 0; j < 7; j++) {
      q[j] += 1e-3 * i * (folded[j] - q[j]);
    }
    arm.put(q);
    tick();
  }
  tick();
  ASSERT_EQ(1u, reports.size());
  EXPECT_EQ("its link2 and hand came too close to each other (self_collision_avoidance_violation).",
            reports.front());
  EXPECT_NE(std::string::npos,
            describe(robot).find("self_collision_avoidance_violation (link2 and hand)"));
}

TEST_F(SimRobotTest, AResetAnswersRequestsThatWaitForRest) {
  TestClient client(robot.server().port());
  connect(client, 10);
  startMotion(client);
  std::array<double, 7> q = test::kReady;
  for (int i = 0; i < 300; i++) {
    q[0] += 1e-6 * i;
    tick([&] { send(client, q); });
  }
  ASSERT_EQ(state().robot_mode, RobotMode::kMove);
  client.request(codec::StopMoveRequest{});
  robot.serve(false);
  tick();
  ASSERT_TRUE(robot.unit().status().settling);
  EXPECT_FALSE(client.answer(Command::kMove, 0));
  // A Move that does not wait for those answers would lose them.
  client.request(codec::MoveRequest{franka_core::ControllerMode::kExternalController,
                                    franka_core::MotionGeneratorMode::kNone});
  robot.serve(false);
  arm.put(test::kReady);
  robot.restart();
  tick();
  std::vector<Status> statuses;
  for (int i = 0; i < 3; i++) {
    const auto answer = client.answer(Command::kMove);
    ASSERT_TRUE(answer) << i;
    statuses.push_back(answer->reply.status);
  }
  EXPECT_EQ(1, std::count(statuses.begin(), statuses.end(), Status::kCommandNotPossibleRejected));
  EXPECT_EQ(1, std::count(statuses.begin(), statuses.end(), Status::kPreempted));
  EXPECT_EQ(RobotMode::kIdle, state().robot_mode);
  startMotion(client);
}

TEST_F(Panda, ReportsValueAndThresholdOfACollision) {
  std::vector<std::string> reports;
  robot.onCollision([&](const std::string& what) { reports.push_back(what); });
  arm.push = {{0, 0, -60, 0, 0, 0}};
  for (int i = 0; i < 20; i++) {
    tick();
  }
  ASSERT_FALSE(reports.empty());
  for (const char* part : {"it hit an obstacle", "external", "upper threshold", "_reflex)."}) {
    EXPECT_NE(std::string::npos, reports.front().find(part)) << reports.front();
  }
  EXPECT_NE(std::string::npos, describe(robot).find("upper threshold")) << describe(robot);
}

}  // namespace
}  // namespace franka_sim::fci
