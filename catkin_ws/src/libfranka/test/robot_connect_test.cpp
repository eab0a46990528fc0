// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Connecting: versions, addresses, and robots that do not answer.
#include <franka_core/limits.h>
#include <ros_test/eventually.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cmath>
#include <regex>

#include "network/endpoint.h"
#include "random_state.h"
#include "robot_fixture.h"

namespace franka_test {
namespace {

using franka::NetworkException;
using franka::Robot;

using Connect = EveryVersion;

TEST_P(Connect, StepsDownToTheRobotsVersion) {
  const auto robot = connect(fake);
  EXPECT_EQ(GetParam(), robot->serverVersion());
  // The newest version is offered first, then the robot's own.
  const auto requests = fake.requests();
  const auto& first = std::get<franka_core::fci::ConnectRequest>(requests[0]);
  EXPECT_EQ(10, first.version);
  EXPECT_EQ(GetParam() == 10 ? 1 : 2, fake.connections());
  EXPECT_EQ(GetParam() == 10 ? 1 : 0, fake.count(Command::kGetRobotModel));
}

TEST_P(Connect, ReadsStatesOfTheRobot) {
  fake.change([](franka_core::RobotState& s) {
    s.q = {0.5, -0.25, 1.5, -2.0, 0.125, 2.5, -0.75};
    s.robot_mode = franka_core::RobotMode::kGuiding;
  });
  const auto robot = connect(fake);
  const franka::RobotState state = robot->readOnce();
  EXPECT_EQ((std::array<double, 7>{0.5, -0.25, 1.5, -2.0, 0.125, 2.5, -0.75}), state.q);
  EXPECT_EQ(franka::RobotMode::kGuiding, state.robot_mode);
  uint64_t last = state.time.toMSec();
  int count = 0;
  robot->read([&](const franka::RobotState& s) {
    EXPECT_GT(s.time.toMSec(), last);
    last = s.time.toMSec();
    return ++count < 20;
  });
  EXPECT_EQ(20, count);
}

INSTANTIATE_TEST_SUITE_P(All, Connect, ::testing::ValuesIn(kVersions), versionName);

TEST(Reading, ReturnsAStateNewerThanTheCall) {
  FakeRobot fake(5);
  const auto robot = connect(fake);
  for (int i = 0; i < 5; i++) {
    const std::uint64_t last = fake.state().message_id;
    ASSERT_TRUE(ros_test::eventually([&] { return fake.state().message_id > last + 20; }));
    const std::uint64_t before = fake.state().message_id;
    EXPECT_GT(robot->readOnce().time.toMSec(), before);
  }
}

/// A robot that falls silent after some states that nobody has read, as test servers do.
class ReadingASilentRobot : public ::testing::Test {
 protected:
  void SetUp() override {
    const std::uint64_t last_read = robot_->readOnce().time.toMSec();
    ASSERT_TRUE(ros_test::eventually([&] { return fake_.state().message_id > last_read + 20; }));
    fake_.script([](FakeRobot::Script& s) { s.sends_states = false; });
    newest_ = fake_.state().message_id;
  }
  void expectNoOther() { EXPECT_THROW(robot_->readOnce(), NetworkException); }

  const ShortTimeouts timeouts_;
  FakeRobot fake_{5};
  std::unique_ptr<Robot> robot_ = connect(fake_);
  std::uint64_t newest_{0};
};

TEST_F(ReadingASilentRobot, ReturnsTheNewestStateOnce) {
  EXPECT_EQ(newest_, robot_->readOnce().time.toMSec());
  expectNoOther();
}

TEST_F(ReadingASilentRobot, CallsBackWithTheNewestState) {
  std::vector<std::uint64_t> times;
  robot_->read([&](const franka::RobotState& state) {
    times.push_back(state.time.toMSec());
    return false;
  });
  EXPECT_EQ(std::vector<std::uint64_t>{newest_}, times);
  expectNoOther();
}

TEST_F(ReadingASilentRobot, ReturnsAStateThatArrivedWithAReply) {
  robot_->setEE(kPose);
  robot_->stop();
  EXPECT_EQ(newest_, robot_->readOnce().time.toMSec());
  expectNoOther();
}

TEST(ConnectVersion, UnknownOnesAreRefusedWithASentence) {
  for (std::uint16_t version : {std::uint16_t{2}, std::uint16_t{11}}) {
    FakeRobot fake(5);
    fake.script([version](FakeRobot::Script& s) { s.reported_version = version; });
    try {
      connect(fake);
      FAIL() << "no exception";
    } catch (const franka::IncompatibleVersionException& error) {
      EXPECT_EQ(version, error.server_version);
      EXPECT_EQ(10, error.library_version);
      const std::string text = error.what();
      EXPECT_NE(std::string::npos, text.find("(server version: " + std::to_string(version) +
                                             ", library version: 10)"));
      EXPECT_NE(std::string::npos, text.find(version == 2 ? "older" : "newer")) << text;
      EXPECT_NE(std::string::npos, text.find("system")) << text;
    }
    EXPECT_EQ(1, fake.connections());
  }
}

TEST(ConnectVersion, ARefusalOfTheRobotsOwnVersionEndsTheAttempt) {
  FakeRobot fake(7);
  fake.script([](FakeRobot::Script& s) {
    s.replies[Command::kConnect] = Status::kIncompatibleLibraryVersion;
  });
  const std::string text = textOf<franka::IncompatibleVersionException>([&] { connect(fake); });
  EXPECT_NE(std::string::npos, text.find("FR3 with system 5.5.0")) << text;
  EXPECT_EQ(2, fake.connections());
}

TEST(ConnectAddress, IsParsed) {
  using franka::network::parseEndpoint;
  EXPECT_EQ("10.0.0.1", parseEndpoint("10.0.0.1", 1337).host);
  EXPECT_EQ(1337, parseEndpoint("10.0.0.1", 1337).port);
  EXPECT_EQ(1400, parseEndpoint("robot.lab:1400", 1337).port);
  EXPECT_EQ(65535, parseEndpoint("robot.lab:65535", 1337).port);
  for (const char* bad : {"", ":1337", "robot:", "robot:0", "robot:65536", "robot:13x", "robot:-1",
                          "robot:1:2", "robot:999999999999"}) {
    EXPECT_THROW(parseEndpoint(bad, 1337), NetworkException) << bad;
  }
  EXPECT_THROW(Robot("no.such.host.invalid", franka::RealtimeConfig::kIgnore), NetworkException);
}

TEST(ConnectNetwork, RefusedConnectionIsReported) {
  std::string address;
  {
    FakeRobot fake(5);
    address = fake.address();
  }
  EXPECT_EQ(
      "libfranka: Connection to FCI refused. Please install FCI feature or enable FCI mode in "
      "Desk.",
      textOf<NetworkException>([&] { Robot(address, franka::RealtimeConfig::kIgnore); }));
}

// A robot that serves another client: the connection waits in the queue.
TEST(ConnectNetwork, SilentRobotTimesOut) {
  const ShortTimeouts timeouts;
  FakeRobot fake(5);
  const auto robot = connect(fake);
  const std::string text = textOf<NetworkException>([&] { connect(fake); });
  EXPECT_TRUE(startsWith(text,
                         "libfranka: Connection timeout. Please check your network connection or "
                         "settings."))
      << text;
  EXPECT_NE(std::string::npos, text.find("no other program")) << text;
}

TEST(ConnectNetwork, LossAtEveryStepIsReported) {
  const ShortTimeouts timeouts;
  for (std::uint16_t version : {std::uint16_t{5}, std::uint16_t{10}}) {
    FakeRobot fake(version);
    fake.script([](FakeRobot::Script& s) { s.fatal = {Command::kConnect}; });
    EXPECT_EQ("libfranka: server closed connection",
              textOf<NetworkException>([&] { connect(fake); }));
    fake.script([](FakeRobot::Script& s) {
      s.fatal = {};
      s.garbled = {Command::kConnect};
    });
    EXPECT_TRUE(startsWith(textOf<franka::ProtocolException>([&] { connect(fake); }),
                           "libfranka: Unexpected response while handling Connect command!"));
    fake.script([](FakeRobot::Script& s) {
      s.garbled = {};
      s.sends_states = false;
    });
    EXPECT_EQ("libfranka: UDP receive: Timeout", textOf<NetworkException>([&] { connect(fake); }));
  }
  FakeRobot fake(10);
  fake.script([](FakeRobot::Script& s) { s.fatal = {Command::kGetRobotModel}; });
  EXPECT_EQ("libfranka: server closed connection",
            textOf<NetworkException>([&] { connect(fake); }));
  fake.script([](FakeRobot::Script& s) { s.fatal.clear(); });
  EXPECT_EQ(10, connect(fake)->serverVersion());
}

TEST(ConnectNetwork, ConnectsAThousandTimes) {
  FakeRobot fake(10);
  for (int i = 0; i < 1000; i++) {
    ASSERT_EQ(10, connect(fake)->serverVersion()) << i;
  }
  EXPECT_EQ(1000, fake.connections());
}

TEST(ConnectObject, StaysConnectedWhenMoved) {
  FakeRobot fake(5), other(10);
  Robot robot(fake.address(), franka::RealtimeConfig::kIgnore);
  Robot moved(std::move(robot));
  EXPECT_EQ(5, moved.serverVersion());
  moved = Robot(other.address(), franka::RealtimeConfig::kIgnore);
  EXPECT_EQ(10, moved.serverVersion());
  EXPECT_EQ(franka::RobotMode::kIdle, moved.readOnce().robot_mode);
}

// The exit status of a function in a forked process: 0 if it returns.
template <typename Function>
int inForkedProcess(Function function) {
  const pid_t process = fork();
  if (process == 0) {
    try {
      function();
      _exit(0);
    } catch (const franka::InvalidOperationException&) {
      _exit(1);
    } catch (const std::exception&) {
      _exit(2);
    }
  }
  int status = 0;
  waitpid(process, &status, 0);
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(ConnectFork, ForkedProcessMayUseConnectionButNotEndIt) {
  FakeRobot fake(5);
  auto robot = connect(fake);
  const int connections = fake.connections();
  const auto use = [&robot] {
    robot->readOnce();
    robot->setCollisionBehavior(kTorques, kTorques, kTwist, kTwist);
    robot.reset();
  };
  EXPECT_EQ(0, inForkedProcess(use));
  EXPECT_EQ(franka::RobotMode::kIdle, robot->readOnce().robot_mode);
  franka::allowUseAfterFork(false);
  const int refused = inForkedProcess(use);
  franka::allowUseAfterFork(true);
  EXPECT_EQ(1, refused);
  EXPECT_EQ(1, fake.count(Command::kSetCollisionBehavior));
  EXPECT_EQ(connections, fake.connections());
}

TEST(ConnectTimeouts, MustBePositive) {
  franka::Timeouts timeouts;
  timeouts.state = std::chrono::milliseconds(0);
  EXPECT_THROW(franka::setTimeouts(timeouts), std::invalid_argument);
  EXPECT_EQ(std::chrono::milliseconds(1000), franka::timeouts().state);
}

std::vector<std::uint8_t> urdf(bool with_extension) {
  const std::string plain = readData("fr3_hand.urdf");
  const std::string extended = std::regex_replace(
      plain, std::regex("</joint>"),
      "<position_based_velocity_limits velocity_offset=\"0.3\" deceleration_limit=\"6\"/></joint>");
  const std::string& text = with_extension ? extended : plain;
  return {text.begin(), text.end()};
}

// The rules of these limits are tested without a robot: rate_limiting_test.cpp.
TEST(ConnectLimits, DependOnTheRobotAndItsDescription) {
  struct Case {
    std::uint16_t version;
    std::vector<std::uint8_t> urdf;
    std::size_t joint;
    double q;           // [rad]
    double upper;       // [rad/s]
    double lower_at_0;  // [rad/s]
  };
  const Case cases[] = {
      {5, {}, 0, 0.0, 2.175 - 1e-3 - 3e-3 * (15 - 1e-3), -2.129003},
      {7, {}, 0, 2.7, -0.30 + std::sqrt(12.0 * (2.7501 - 2.7)) - 1e-3, -2.619},
      {10, urdf(true), 2, 2.45, -0.3 + std::sqrt(12.0 * (2.4937 - 2.45)) - 1e-3, -1.499},
      {10, urdf(false), 0, 2.8, -0.6599 + std::sqrt(12.0 * (2.9007 - 2.8)) - 1e-3, -2.619},
  };
  for (const Case& test : cases) {
    FakeRobot fake(test.version);
    fake.script([&test](FakeRobot::Script& s) { s.urdf = test.urdf; });
    const auto robot = connect(fake);
    std::array<double, 7> q{};
    q[test.joint] = test.q;
    EXPECT_NEAR(test.upper, robot->getUpperJointVelocityLimits(q)[test.joint], 1e-12);
    q[test.joint] = 0.0;
    EXPECT_NEAR(test.lower_at_0, robot->getLowerJointVelocityLimits(q)[test.joint], 1e-12);
  }
  FakeRobot refuses(10);
  refuses.script([](FakeRobot::Script& s) {
    s.replies[Command::kGetRobotModel] = Status::kCommandNotPossibleRejected;
  });
  EXPECT_NEAR(2.619, connect(refuses)->getUpperJointVelocityLimits({})[0], 1e-12);
}

}  // namespace
}  // namespace franka_test
