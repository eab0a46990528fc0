// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Every command with every status in the reply of a robot of every version.
#include <franka_core/fci/reply_codec.h>

#include <atomic>
#include <cmath>
#include <thread>

#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::CommandException;
using franka::NetworkException;
using franka::Robot;

constexpr std::array<double, 7> kSeven{1, 2, 3, 4, 5, 6, 7};
constexpr std::array<double, 6> kSix{1, 2, 3, 4, 5, 6};

/// A command, the function that sends it, and its name in the texts (protocol 3.4).
struct Call {
  Command command;
  const char* name;
  std::uint16_t first_version, last_version;
  void (*call)(Robot&);
};

const Call kCalls[] = {
    {Command::kStopMove, "Stop Move", 3, 10, [](Robot& r) { r.stop(); }},
    {Command::kGetCartesianLimit, "Get Cartesian Limit", 3, 5,
     [](Robot& r) { r.getVirtualWall(7); }},
    {Command::kSetCollisionBehavior, "Set Collision Behavior", 3, 10,
     [](Robot& r) { r.setCollisionBehavior(kSeven, kSeven, kSix, kSix); }},
    {Command::kSetJointImpedance, "Set Joint Impedance", 3, 10,
     [](Robot& r) { r.setJointImpedance(kSeven); }},
    {Command::kSetCartesianImpedance, "Set Cartesian Impedance", 3, 10,
     [](Robot& r) { r.setCartesianImpedance(kSix); }},
    {Command::kSetGuidingMode, "Set Guiding Mode", 3, 10,
     [](Robot& r) { r.setGuidingMode({true, false, true, false, true, false}, true); }},
    {Command::kSetEEToK, "Set EE to K", 3, 10, [](Robot& r) { r.setK(kPose); }},
    {Command::kSetNEToEE, "Set NE to EE", 3, 10, [](Robot& r) { r.setEE(kPose); }},
    {Command::kSetLoad, "Set Load", 3, 10,
     [](Robot& r) { r.setLoad(1.5, {0.1, 0.2, 0.3}, {1, 2, 3, 4, 5, 6, 7, 8, 9}); }},
    {Command::kSetFilters, "Set Filters", 3, 5,
     [](Robot& r) { r.setFilters(100, 200, 300, 400, 500); }},
    {Command::kAutomaticErrorRecovery, "Automatic Error Recovery", 3, 10,
     [](Robot& r) { r.automaticErrorRecovery(); }},
    {Command::kGetRobotModel, "Get Robot Model", 8, 10, [](Robot& r) { r.getRobotModel(); }},
};

/// The text after the name, typed from the table.
std::string endingOf(Command command, Status status) {
  const bool is_setter = command != Command::kStopMove &&
                         command != Command::kAutomaticErrorRecovery &&
                         command != Command::kGetRobotModel;
  switch (status) {
    case Status::kCommandNotPossibleRejected:
      return " command rejected: command not possible in the current mode (\"Idle\")!";
    case Status::kInvalidArgumentRejected:
      return std::string(" command rejected: invalid argument!") +
             (command == Command::kSetLoad
                  ? " Give mass [kg], center from the flange [m] and symmetric inertia [kg m^2] of "
                    "what the arm can carry; simulated arms take at most 10 kg, 1 m and 10 kg m^2."
                  : "");
    case Status::kRejectedDueToActivatedSafetyFunctions:
      return std::string(
                 " command rejected due to activated safety function! Please disable all safety "
                 "functions.") +
             (is_setter ? " " : "");
    case Status::kManualErrorRecoveryRequiredRejected:
      return " command rejected: manual error recovery required!";
    case Status::kReflexAborted:
      return " command aborted: motion aborted by reflex!";
    case Status::kEmergencyAborted:
      return " command aborted: User Stop pressed!";
    case Status::kAborted:
      return command == Command::kStopMove
                 ? " command rejected: command not possible in the current mode (\"Idle\")!"
                 : " command aborted!";
    default:
      ADD_FAILURE() << "a status that is not in the table";
      return "";
  }
}

using Commands = EveryVersion;

TEST_P(Commands, EachStatusGivesItsText) {
  const auto robot = connect(fake);
  int cases = 0;
  for (const Call& call : kCalls) {
    const bool exists = GetParam() >= call.first_version && GetParam() <= call.last_version;
    for (std::size_t s = 0; exists && s < franka_core::fci::kStatusCount; s++) {
      const auto status = static_cast<Status>(s);
      if (!franka_core::fci::statusNumber(GetParam(), call.command, status)) {
        continue;
      }
      SCOPED_TRACE(std::string(call.name) + ", status " + std::to_string(s));
      fake.script([&](FakeRobot::Script& script) { script.replies[call.command] = status; });
      cases++;
      if (status == Status::kSuccess) {
        EXPECT_NO_THROW(call.call(*robot));
        continue;
      }
      EXPECT_EQ(std::string("libfranka: ") + call.name + endingOf(call.command, status),
                textOf<CommandException>([&] { call.call(*robot); }));
    }
  }
  // Nine commands with three or four statuses each, recovery and stop with five to seven.
  EXPECT_GT(cases, 35);
}

TEST_P(Commands, MissingInTheVersionAreRefusedByTheClient) {
  const auto robot = connect(fake);
  const std::size_t before = fake.requests().size();
  for (const Call& call : kCalls) {
    if (GetParam() < call.first_version || GetParam() > call.last_version) {
      const std::string text = textOf<CommandException>([&] { call.call(*robot); });
      EXPECT_TRUE(startsWith(text, std::string("libfranka: ") + call.name + " command rejected: "));
      EXPECT_NE(std::string::npos, text.find("version " + std::to_string(GetParam()))) << text;
    }
  }
  EXPECT_EQ(before, fake.requests().size());
}

TEST_P(Commands, TransmitTheirArguments) {
  const auto robot = connect(fake);
  const std::size_t before = fake.requests().size();
  robot->setCollisionBehavior({1}, {2}, {3}, {4}, {5}, {6}, {7}, {8});
  robot->setLoad(1.5, {0.1, 0.2, 0.3}, {1, 2, 3, 4, 5, 6, 7, 8, 9});
  robot->setGuidingMode({true, false, true, false, true, false}, true);
  robot->setEE(kPose);
  const auto requests = fake.requests();
  namespace fci = franka_core::fci;
  const auto& collision = std::get<fci::SetCollisionBehaviorRequest>(requests[before]);
  EXPECT_EQ(1.0, collision.lower_torques_acceleration[0]);
  EXPECT_EQ(2.0, collision.upper_torques_acceleration[0]);
  EXPECT_EQ(3.0, collision.lower_torques_nominal[0]);
  EXPECT_EQ(4.0, collision.upper_torques_nominal[0]);
  EXPECT_EQ(5.0, collision.lower_forces_acceleration[0]);
  EXPECT_EQ(6.0, collision.upper_forces_acceleration[0]);
  EXPECT_EQ(7.0, collision.lower_forces_nominal[0]);
  EXPECT_EQ(8.0, collision.upper_forces_nominal[0]);
  const auto& load = std::get<fci::SetLoadRequest>(requests[before + 1]);
  EXPECT_EQ(1.5, load.mass);
  EXPECT_EQ(0.3, load.F_x_Cload[2]);
  EXPECT_EQ(9.0, load.inertia[8]);
  const auto& guiding = std::get<fci::SetGuidingModeRequest>(requests[before + 2]);
  EXPECT_EQ((std::array<bool, 6>{true, false, true, false, true, false}), guiding.guiding_mode);
  EXPECT_TRUE(guiding.nullspace);
  EXPECT_EQ(kPose, std::get<fci::SetNEToEERequest>(requests[before + 3]).NE_T_EE);
  if (GetParam() <= 5) {
    const franka::VirtualWallCuboid wall = robot->getVirtualWall(7);
    EXPECT_EQ(7, wall.id);
    EXPECT_EQ((std::array<double, 3>{1.0, 2.0, 3.0}), wall.object_world_size);
    EXPECT_TRUE(wall.active);
    robot->setFilters(100, 200, 300, 400, 500);
    const auto filters = std::get<fci::SetFiltersRequest>(fake.requests().back());
    EXPECT_EQ(100.0, filters.joint_position);
    EXPECT_EQ(500.0, filters.controller);
  }
}

INSTANTIATE_TEST_SUITE_P(All, Commands, ::testing::ValuesIn(kVersions), versionName);

// Which frames are accepted is tested without a robot: typed_transform_test.cpp.
TEST(CommandFrames, AreSentAsExactOnesOrRefused) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  namespace fci = franka_core::fci;
  robot->setEE({0.707, 0.707, 0, 0, -0.707, 0.707, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1});
  const auto sent = std::get<fci::SetNEToEERequest>(fake.requests().back()).NE_T_EE;
  EXPECT_NEAR(M_SQRT1_2, sent[0], 1e-15);
  EXPECT_EQ(0.3, sent[14]);
  robot->setK({0.707, 0.707, 0, 0, -0.707, 0.707, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1});
  EXPECT_EQ(sent, std::get<fci::SetEEToKRequest>(fake.requests().back()).EE_T_K);
  const std::size_t before = fake.requests().size();
  const std::array<double, 16> row_major{0, -1, 0, 0.1, 1, 0, 0, 0.2, 0, 0, 1, 0.3, 0, 0, 0, 1};
  for (const std::string& text : {textOf<CommandException>([&] { robot->setEE(row_major); }),
                                  textOf<CommandException>([&] { robot->setK(row_major); })}) {
    EXPECT_NE(std::string::npos, text.find("row-major")) << text;
  }
  EXPECT_EQ(before, fake.requests().size());
}

TEST(CommandText, NamesThePresentMode) {
  FakeRobot fake(5);
  fake.change([](franka_core::RobotState& s) { s.robot_mode = franka_core::RobotMode::kReflex; });
  fake.script([](FakeRobot::Script& s) {
    s.replies[Command::kSetLoad] = Status::kCommandNotPossibleRejected;
  });
  const auto robot = connect(fake);
  const std::string text = textOf<CommandException>([&] { robot->setLoad(0, {}, {}); });
  EXPECT_NE(std::string::npos, text.find("(\"Reflex\")")) << text;
  EXPECT_NE(std::string::npos, text.find("automaticErrorRecovery")) << text;
}

TEST(CommandFaults, MissingAndInvalidRepliesThrow) {
  const ShortTimeouts timeouts;
  FakeRobot fake(5);
  auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) {
    s.unanswered = {Command::kSetLoad};
    s.garbled = {Command::kSetEEToK};
    s.repeated = {{Command::kSetNEToEE, 2}};
  });
  const std::string text = textOf<NetworkException>([&] { robot->setLoad(0, {}, {}); });
  EXPECT_TRUE(startsWith(text, "libfranka: Connection timeout.")) << text;
  EXPECT_NE(std::string::npos, text.find("Set Load within 1.5 s")) << text;
  EXPECT_TRUE(startsWith(textOf<franka::ProtocolException>([&] { robot->setK(kPose); }),
                         "libfranka: Unexpected response while handling Set EE to K command!"));
  // The connection continues, and repeated replies have no effect.
  EXPECT_NO_THROW(robot->setEE(kPose));
  EXPECT_NO_THROW(robot->setJointImpedance(kSeven));
  EXPECT_NO_THROW(robot->setEE(kPose));

  fake.script([](FakeRobot::Script& s) { s.sends_states = false; });
  EXPECT_TRUE(startsWith(textOf<NetworkException>([&] { robot->setLoad(0, {}, {}); }),
                         "libfranka: UDP receive: Timeout"));

  fake.script([](FakeRobot::Script& s) { s.fatal = {Command::kSetFilters}; });
  EXPECT_EQ("libfranka: server closed connection",
            textOf<NetworkException>([&] { robot->setFilters(1, 2, 3, 4, 5); }));
  EXPECT_EQ("libfranka: server closed connection",
            textOf<NetworkException>([&] { robot->setEE(kPose); }));
  EXPECT_EQ("libfranka: server closed connection",
            textOf<NetworkException>([&] { robot->readOnce(); }));
}

TEST(CommandReply, MayBeLarge) {
  FakeRobot fake(8);
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) { s.urdf.assign(3 << 20, 'x'); });
  EXPECT_EQ(std::string(3 << 20, 'x'), robot->getRobotModel());
}

TEST(CommandThreads, SettersFromManyThreadsGetTheirOwnReplies) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  fake.script([](FakeRobot::Script& s) {
    s.replies[Command::kSetEEToK] = Status::kInvalidArgumentRejected;
  });
  std::atomic<int> refused{0}, accepted{0};
  std::vector<std::thread> threads;
  for (int t = 0; t < 4; t++) {
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; i++) {
        if (t % 2 == 0) {
          try {
            robot->setK(kPose);
          } catch (const CommandException&) {
            refused++;
          }
        } else {
          robot->setEE(kPose);
          accepted++;
        }
      }
    });
  }
  for (std::thread& thread : threads) {
    thread.join();
  }
  EXPECT_EQ(100, refused);
  EXPECT_EQ(100, accepted);
}

}  // namespace
}  // namespace franka_test
