// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The connection, and the services of a robot that rests or moves.
#include <franka/exception.h>
#include <franka/extensions.h>
#include <franka_hw/arm_connection.h>
#include <franka_hw/services.h>
#include <franka_msgs/ErrorRecoveryActionGoal.h>
#include <franka_msgs/SetJointImpedance.h>
#include <franka_msgs/SetLoad.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <future>
#include <memory>

#include "../../src/joint_limit_monitor.h"
#include "support.h"

namespace franka_hw_test {
namespace {

constexpr std::chrono::seconds kDeadline{30};

class Connection : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh)); }

  FakeArm arm_{"fr3"};
  franka_hw::FrankaHW robot_;
};

TEST_F(Connection, CanBeClosedAndOpenedAgain) {
  EXPECT_TRUE(robot_.connected());
  EXPECT_TRUE(robot_.disconnect());
  EXPECT_FALSE(robot_.connected());
  EXPECT_THROW(robot_.robot(), std::logic_error);
  EXPECT_TRUE(robot_.disconnect()) << "twice does no harm";
  robot_.connect();
  EXPECT_TRUE(robot_.connected());
  const int connections = arm_.robot.connections();
  robot_.connect();
  EXPECT_EQ(connections, arm_.robot.connections()) << "a connected robot is not connected again";
  EXPECT_NO_THROW(robot_.robot().readOnce());
}

TEST_F(Connection, WarnsOnceOfAnEndEffectorThatIsNotTheDescribedOne) {
  const auto reconnect = [&] {
    robot_.disconnect();
    robot_.connect();
  };
  const LogCatcher log;
  reconnect();
  EXPECT_EQ(std::string::npos, log.text(ros::console::levels::Warn).find("F_T_NE"));
  arm_.robot.change([](auto& state) { state.F_T_NE[14] += 0.017; });
  reconnect();
  reconnect();
  const std::string text = log.text(ros::console::levels::Warn);
  const std::size_t first = text.find("17 mm");
  ASSERT_NE(std::string::npos, first) << text;
  EXPECT_EQ(std::string::npos, text.find("17 mm", first + 1)) << text;
}

TEST(JointLimitMonitor, NamesJointsWhenOneComesNear) {
  FakeArm arm;
  const std::vector<std::string> joints = FakeArm::joints(arm.arm_id);
  std::array<std::string, 7> names;
  std::copy(joints.begin(), joints.end(), names.begin());
  urdf::Model description;
  ASSERT_TRUE(description.initString(urdfOf(arm.arm_id)));
  franka_hw::JointLimitMonitor monitor(arm.nh, arm.arm_id, names, description);
  std::array<double, 7> q{0, 0, 0, -1.5, 0, 1.5, 0};
  const auto names_at = [&](double seconds, std::size_t joint) {
    monitor.check(q, 0.1);
    const std::string text = monitor.makeWarning(ros::WallTime(100.0 + seconds));
    return text.find(names[joint]) != std::string::npos;
  };
  const auto near_end = [&](std::size_t joint) {
    return description.getJoint(names[joint])->limits->upper - 0.05;
  };
  EXPECT_FALSE(names_at(0.0, 6));
  q[6] = near_end(6);
  EXPECT_TRUE(names_at(0.5, 6));
  for (double time = 1.0; time < 20.0; time += 0.5) {
    EXPECT_FALSE(names_at(time, 6)) << time << " s: it has not moved";
  }
  q[0] = near_end(0);
  EXPECT_TRUE(names_at(20.0, 0));
  q[6] = 0.0;
  EXPECT_FALSE(names_at(22.0, 0));
  q[6] = near_end(6);
  EXPECT_FALSE(names_at(24.0, 6)) << "it was away for four seconds only";
  q[6] = 0.0;
  EXPECT_FALSE(names_at(26.0, 0));
  q[6] = near_end(6);
  EXPECT_TRUE(names_at(30.0, 6));
}

TEST_F(Connection, IsKeptWhileAControllerRuns) {
  Loop loop(robot_, arm_);
  ASSERT_TRUE(loop.switchTo({"JT"}, {}));
  const LogCatcher log;
  EXPECT_FALSE(robot_.disconnect());
  EXPECT_NE(std::string::npos, log.text().find("while a controller is active"));
  EXPECT_TRUE(robot_.connected());
  EXPECT_TRUE(eventually([&] { return loop.controller("JT").updates_since_start > 10; }));
  EXPECT_TRUE(loop.switchTo({}, {"JT"}));
  EXPECT_FALSE(robot_.controllerActive());
}

TEST_F(Connection, LossEndsTheMotionWithAMessage) {
  const franka::Timeouts patient = franka::timeouts();
  franka::Timeouts timeouts = patient;
  timeouts.state = std::chrono::seconds(3);
  franka::setTimeouts(timeouts);
  robot_.disconnect();
  robot_.connect();
  franka::setTimeouts(patient);
  Loop loop(robot_, arm_);
  arm_.robot.script([](auto& script) { script.close_after = 50; });
  ASSERT_TRUE(loop.switchTo({"JT"}, {}));
  ASSERT_TRUE(eventually([&] { return !loop.errors().empty(); }));
  EXPECT_NE(std::string::npos, loop.errors()[0].find("libfranka")) << loop.errors()[0];
  // As the node does: the connection is dropped, and the controllers can still be stopped.
  robot_.armConnection().disconnect();
  EXPECT_FALSE(robot_.connected());
  EXPECT_TRUE(loop.switchTo({}, {"JT"}));
}

TEST(ReadPatiently, GivesUpARestingRobotAfterThreeAttemptsOrSeconds) {
  std::chrono::steady_clock::time_point now;
  int attempts = 0;
  /// Whether a robot is read whose first attempts end in this timeout.
  const auto isRead = [&](int silent, std::chrono::milliseconds timeout) {
    attempts = 0;
    const auto read = [&] {
      if (++attempts <= silent) {
        now += timeout;
        throw franka::NetworkException("silence");
      }
      return franka::RobotState();
    };
    try {
      franka_hw::ArmConnection::readPatiently(read, [&] { return now; });
      return true;
    } catch (const franka::NetworkException&) {
      return false;
    }
  };
  EXPECT_TRUE(isRead(2, std::chrono::milliseconds(1000)));
  EXPECT_FALSE(isRead(3, std::chrono::milliseconds(100)));
  EXPECT_EQ(3, attempts);
  EXPECT_FALSE(isRead(1, std::chrono::milliseconds(5000)));
  EXPECT_EQ(1, attempts);
}

TEST_F(Connection, ARefusedRecoveryStopsNoController) {
  franka_hw::ArmConnection& connection = robot_.armConnection();
  int tasks = 0;
  connection.beforeRecovery([&] { tasks++; });
  arm_.robot.change([](auto& state) { state.robot_mode = franka_core::RobotMode::kUserStopped; });
  arm_.robot.script([](auto& script) {
    script.replies[Command::kAutomaticErrorRecovery] =
        franka_core::fci::Status::kCommandNotPossibleRejected;
  });
  connection.fail();
  EXPECT_THROW(connection.recover(), franka::CommandException);
  EXPECT_EQ(0, tasks);
  EXPECT_TRUE(connection.hasOwnError());
  arm_.robot.script([](auto& script) { script.replies.clear(); });
  EXPECT_NO_THROW(connection.recover());
  EXPECT_EQ(1, tasks);
  EXPECT_FALSE(connection.hasOwnError());
}

TEST_F(Connection, LossDoesNotWaitForARecoveryUnderWay) {
  franka_hw::ArmConnection& connection = robot_.armConnection();
  std::promise<void> begins, ends;
  connection.beforeRecovery([&, end = ends.get_future().share()] {
    begins.set_value();
    end.wait();  // for the loop, as for a switch of controllers
  });
  connection.offer(arm_.robot_nh, arm_.arm_id);
  connection.fail();
  ros::Publisher goal =
      arm_.robot_nh.advertise<franka_msgs::ErrorRecoveryActionGoal>("error_recovery/goal", 1);
  ASSERT_TRUE(eventually([&] { return goal.getNumSubscribers() > 0; }));
  goal.publish(franka_msgs::ErrorRecoveryActionGoal());
  ASSERT_EQ(std::future_status::ready, begins.get_future().wait_for(kDeadline));

  arm_.robot.script([](auto& script) { script.fatal = {Command::kSetLoad}; });
  EXPECT_THROW(robot_.robot().setLoad(0.0, {}, {}), franka::NetworkException);
  auto loop = std::async(std::launch::async, [&] {
    franka::RobotState state;
    return connection.readAtRest(state);
  });
  EXPECT_EQ(std::future_status::ready, loop.wait_for(kDeadline));
  EXPECT_EQ(franka_hw::ArmState::kLostInError, connection.state());
  ends.set_value();
  EXPECT_FALSE(loop.get());
  connection.connect();
  EXPECT_TRUE(connection.connected());
  EXPECT_TRUE(connection.hasOwnError()) << "the recovery was one of the lost robot";
}

TEST_F(Connection, RunsTheServicesOfARestingRobot) {
  franka_hw::ServiceContainer services;
  franka_hw::setupServices(robot_.robot(), robot_.armConnection().mutex(), arm_.robot_nh, services);
  franka_msgs::SetLoad load;
  load.request.mass = 0.75;
  load.request.F_x_center_load = {0.01, 0.02, 0.03};
  ASSERT_TRUE(ros::service::call(arm_.robot_nh.resolveName("set_load"), load));
  EXPECT_TRUE(load.response.success) << load.response.error;
  const auto requests = arm_.robot.requests();
  const auto* sent = std::get_if<franka_core::fci::SetLoadRequest>(&requests.back());
  ASSERT_NE(nullptr, sent);
  EXPECT_EQ(0.75, sent->mass);

  arm_.robot.script([](auto& script) {
    script.replies[Command::kSetLoad] = franka_core::fci::Status::kInvalidArgumentRejected;
  });
  ASSERT_TRUE(ros::service::call(arm_.robot_nh.resolveName("set_load"), load));
  EXPECT_FALSE(load.response.success);
  EXPECT_FALSE(load.response.error.empty());
}

TEST_F(Connection, SettersThatWaitDuringADisconnectAreRefused) {
  auto services = std::make_unique<franka_hw::ServiceContainer>();
  franka_hw::setupServices(robot_.robot(), robot_.robotMutex(), arm_.robot_nh, *services);
  franka_msgs::SetLoad load;
  const ros_test::LogCatcher log;
  std::unique_lock<std::mutex> lock(robot_.robotMutex());
  auto waits = std::async(std::launch::async, [&] {
    return ros::service::call(arm_.robot_nh.resolveName("set_load"), load);
  });
  EXPECT_EQ(std::future_status::timeout, waits.wait_for(std::chrono::milliseconds(100)));
  services.reset();
  lock.unlock();
  // The client hears of the end of the service before that of its request.
  EXPECT_FALSE(waits.get());
  EXPECT_TRUE(eventually([&] { return log.text().find("set_load failed") != std::string::npos; }));
  EXPECT_EQ(0, arm_.robot.count(Command::kSetLoad));
}

TEST_F(Connection, SettersOfABusyRobotAreRefused) {
  franka_hw::ServiceContainer services;
  franka_hw::setupServices(robot_.robot(), robot_.robotMutex(), arm_.robot_nh, services);
  const std::lock_guard<std::mutex> lock(robot_.robotMutex());
  franka_msgs::SetLoad load;
  ASSERT_TRUE(ros::service::call(arm_.robot_nh.resolveName("set_load"), load));
  EXPECT_FALSE(load.response.success);
  EXPECT_NE(std::string::npos, load.response.error.find("busy")) << load.response.error;
  EXPECT_EQ(0, arm_.robot.count(Command::kSetLoad));
}

TEST_F(Connection, ReadOnlyLoopDoesNotBlockSwitches) {
  franka_hw::ServiceContainer services;
  franka_hw::setupServices(robot_.robot(), robot_.robotMutex(), arm_.robot_nh, services);
  // As in loops of users and of the original: the robot is locked again microseconds after its
  // release.
  Loop loop(robot_, arm_, false);
  for (int i = 0; i < 10; i++) {
    ASSERT_TRUE(loop.switchTo({"JP"}, {})) << i;
    ASSERT_TRUE(eventually([&] { return loop.controller("JP").updates_since_start > 3; }));
    ASSERT_TRUE(loop.switchTo({}, {"JP"})) << i;
    franka_msgs::SetLoad load;
    ASSERT_TRUE(ros::service::call(arm_.robot_nh.resolveName("set_load"), load));
    // Such a loop may block setters, because a mutex is not fair; but then they report an error.
    EXPECT_TRUE(load.response.success || !load.response.error.empty()) << i;
  }
}

TEST_F(Connection, SettersOfAMovingRobotAreRefused) {
  franka_hw::ServiceContainer services;
  franka_hw::setupServices(robot_.robot(), robot_.armConnection().mutex(), arm_.robot_nh, services);
  Loop loop(robot_, arm_);
  ASSERT_TRUE(loop.switchTo({"JP"}, {}));
  ASSERT_TRUE(eventually([&] { return loop.controller("JP").updates_since_start > 10; }));
  franka_msgs::SetJointImpedance impedance;
  impedance.request.joint_stiffness.fill(1000.0);
  ASSERT_TRUE(ros::service::call(arm_.robot_nh.resolveName("set_joint_impedance"), impedance));
  EXPECT_FALSE(impedance.response.success);
  EXPECT_NE(std::string::npos, impedance.response.error.find("Stop that controller"));
  EXPECT_EQ(0, arm_.robot.count(Command::kSetJointImpedance));
  EXPECT_TRUE(loop.controller("JP").isRunning()) << "the motion goes on";
  EXPECT_TRUE(loop.errors().empty());

  ASSERT_TRUE(loop.switchTo({}, {"JP"}));
  ASSERT_TRUE(ros::service::call(arm_.robot_nh.resolveName("set_joint_impedance"), impedance));
  EXPECT_TRUE(impedance.response.success) << impedance.response.error;
}

}  // namespace
}  // namespace franka_hw_test
