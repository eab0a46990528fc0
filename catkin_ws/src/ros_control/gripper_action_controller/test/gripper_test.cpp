// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The controllers, loaded as plugins by a controller manager, on a simulated gripper with simulated
// time.
#include <actionlib/client/action_client.h>
#include <control_msgs/GripperCommandAction.h>
#include <gtest/gtest.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_effort_limit_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/ros.h>
#include <ros_test/controller_loop.h>
#include <rt_guard/rt_guard.h>

#include <algorithm>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace {

typedef actionlib::ActionClient<control_msgs::GripperCommandAction> Client;
typedef actionlib::TerminalState Terminal;

/// A finger of 1 kg that cannot pass an obstacle.
class Gripper : public hardware_interface::RobotHW {
 public:
  Gripper() {
    const hardware_interface::JointStateHandle state("finger", &position_, &velocity_, &effort_);
    position_interface_.registerHandle(hardware_interface::JointHandle(state, &position_command_));
    effort_interface_.registerHandle(hardware_interface::JointHandle(state, &effort_command_));
    registerInterface(&position_interface_);
    limit_interface_.registerHandle(
        hardware_interface::JointEffortLimitHandle("finger", &max_effort_));
    registerInterface(&effort_interface_);
    registerInterface(&limit_interface_);
  }

  void move(double dt) {
    const double before = position_;
    if (by_effort_) {
      velocity_ += effort_command_ * dt;
      position_ += velocity_ * dt;
    } else {
      // At most 0.1 m/s.
      position_ += std::clamp(position_command_ - position_, -0.1 * dt, 0.1 * dt);
    }
    position_ = std::max(position_, obstacle_);
    velocity_ = (position_ - before) / dt;
  }

  double position_{0.04};
  double velocity_{0.0};
  double effort_{0.0};
  double position_command_{0.04};
  double effort_command_{0.0};
  double max_effort_{0.0};
  double obstacle_{-1.0};
  bool by_effort_{false};

 private:
  hardware_interface::PositionJointInterface position_interface_;
  hardware_interface::EffortJointInterface effort_interface_;
  hardware_interface::JointEffortLimitInterface limit_interface_;
};

class GripperTest : public ros_test::ControllerLoop<Gripper>,
                    public testing::TestWithParam<const char*> {
 protected:
  GripperTest() : ControllerLoop("gripper_test") {
    robot_.by_effort_ = std::string(GetParam()) == "effort";
    nh_.setParam("gripper/type", std::string(GetParam()) + "_controllers/GripperActionController");
    nh_.setParam("gripper/joint", "finger");
    nh_.setParam("gripper/goal_tolerance", 0.001);
    nh_.setParam("gripper/stall_timeout", 0.2);
    nh_.setParam("gripper/action_monitor_rate", 200.0);
    nh_.setParam("gripper/max_effort", 30.0);
    nh_.setParam("gripper/gains/finger/p", 400.0);
    nh_.setParam("gripper/gains/finger/d", 40.0);
  }
  ~GripperTest() override { nh_.deleteParam("gripper"); }

  void start() {
    ASSERT_TRUE(manager_.loadController("gripper"));
    ASSERT_TRUE(doSwitch({"gripper"}, {}));
    client_ = std::make_unique<Client>(nh_, "gripper/gripper_cmd");
    until([&] { return client_->isServerConnected(); }, "the action server");
  }

  Client::GoalHandle send(double position, double max_effort = 20.0) {
    control_msgs::GripperCommandGoal goal;
    goal.command.position = position;
    goal.command.max_effort = max_effort;
    return client_->sendGoal(goal);
  }

  /// Waits, without steps, until the controller has accepted a goal.
  void untilActive(Client::GoalHandle& handle) {
    until([&] { return handle.getCommState() == actionlib::CommState::ACTIVE; }, "acceptance", 0);
  }

  /// @param cycles between two checks; 0 if the goal ends by a message in transit, which the finger
  /// must not overtake
  control_msgs::GripperCommandResult end(Client::GoalHandle& handle, int cycles = 1) {
    until([&] { return handle.getCommState() == actionlib::CommState::DONE; }, "the goal's end",
          cycles);
    EXPECT_FALSE(handle.getTerminalState().getText().empty());
    return handle.getResult() ? *handle.getResult() : control_msgs::GripperCommandResult();
  }

  static Terminal::StateEnum how(const Client::GoalHandle& handle) {
    return handle.getTerminalState().state_;
  }

  std::unique_ptr<Client> client_;
};

INSTANTIATE_TEST_SUITE_P(All, GripperTest, testing::Values("position", "effort"));

TEST_P(GripperTest, ReachesItsGoal) {
  start();
  Client::GoalHandle handle = send(0.01);
  const control_msgs::GripperCommandResult result = end(handle);
  EXPECT_EQ(Terminal::SUCCEEDED, how(handle));
  EXPECT_TRUE(result.reached_goal);
  EXPECT_FALSE(result.stalled);
  EXPECT_NEAR(0.01, result.position, 0.001);
}

TEST_P(GripperTest, StallsAtAnObstacleAndKeepsPressing) {
  start();
  robot_.obstacle_ = 0.02;
  Client::GoalHandle handle = send(0.0, 5.0);
  untilActive(handle);
  const ros::Time begin = time_;
  const control_msgs::GripperCommandResult result = end(handle);
  EXPECT_EQ(Terminal::ABORTED, how(handle));
  EXPECT_TRUE(result.stalled);
  EXPECT_FALSE(result.reached_goal);
  EXPECT_NEAR(0.02, result.position, 1e-9);
  // It took at least the motion time and then the timeout.
  EXPECT_GT((time_ - begin).toSec(), 0.2);
  steps(100);
  if (robot_.by_effort_) {
    EXPECT_DOUBLE_EQ(-5.0, robot_.effort_command_);
    EXPECT_DOUBLE_EQ(-5.0, result.effort);
  } else {
    EXPECT_DOUBLE_EQ(0.0, robot_.position_command_);
  }
}

/// Only for positions: the hardware has no other way to learn it.
TEST_P(GripperTest, GivesTheMaximumEffortOfAGoalToTheHardware) {
  start();
  robot_.obstacle_ = 0.02;
  Client::GoalHandle handle = send(0.0, 5.0);
  end(handle);
  steps(1);
  EXPECT_DOUBLE_EQ(robot_.by_effort_ ? 0.0 : 5.0, robot_.max_effort_);
  Client::GoalHandle unlimited = send(0.03, 0.0);
  end(unlimited);
  steps(1);
  EXPECT_DOUBLE_EQ(0.0, robot_.max_effort_);
  Client::GoalHandle last = send(0.0, 7.0);
  untilActive(last);
  steps(1);
  ASSERT_TRUE(doSwitch({}, {"gripper"}));
  EXPECT_DOUBLE_EQ(0.0, robot_.max_effort_);
}

TEST_P(GripperTest, CancelHolds) {
  start();
  Client::GoalHandle handle = send(0.0);
  untilActive(handle);
  steps(50);
  handle.cancel();
  end(handle, 0);
  EXPECT_EQ(Terminal::PREEMPTED, how(handle));
  steps(2000);
  EXPECT_GT(robot_.position_, 0.005);
  EXPECT_NEAR(0.0, robot_.velocity_, 1e-6);
}

TEST_P(GripperTest, AnotherGoalPreempts) {
  start();
  Client::GoalHandle first = send(0.0);
  untilActive(first);
  steps(20);
  Client::GoalHandle second = send(0.03);
  end(first, 0);
  EXPECT_EQ(Terminal::PREEMPTED, how(first));
  EXPECT_NEAR(0.03, end(second).position, 0.001);
  EXPECT_EQ(Terminal::SUCCEEDED, how(second));
}

TEST_P(GripperTest, RefusesImpossibleGoals) {
  start();
  for (const auto& [position, effort] :
       std::vector<std::pair<double, double>>{{std::numeric_limits<double>::quiet_NaN(), 1.0},
                                              {0.0, std::numeric_limits<double>::infinity()},
                                              {0.0, -1.0}}) {
    Client::GoalHandle handle = send(position, effort);
    end(handle);
    EXPECT_EQ(Terminal::REJECTED, how(handle));
  }
  EXPECT_DOUBLE_EQ(0.04, robot_.position_);
}

TEST_P(GripperTest, StoppingCancelsAndRefusesUntilTheNextStart) {
  start();
  robot_.obstacle_ = 0.02;
  Client::GoalHandle handle = send(0.0);
  untilActive(handle);
  steps(20);
  ASSERT_TRUE(doSwitch({}, {"gripper"}));
  end(handle);
  EXPECT_EQ(Terminal::PREEMPTED, how(handle));
  Client::GoalHandle refused = send(0.0);
  end(refused);
  EXPECT_EQ(Terminal::REJECTED, how(refused));
  ASSERT_TRUE(doSwitch({"gripper"}, {}));
  Client::GoalHandle again = send(0.03);
  end(again);
  EXPECT_EQ(Terminal::SUCCEEDED, how(again));
}

TEST_P(GripperTest, NeitherAllocatesNorLocks) {
  start();
  robot_.obstacle_ = 0.02;
  Client::GoalHandle handle = send(0.0);
  untilActive(handle);
  rt_guard::Scope scope;
  steps(2000);
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

TEST_P(GripperTest, RefusesInvalidParameters) {
  nh_.setParam("gripper/stall_timeout", -1.0);
  EXPECT_FALSE(manager_.loadController("gripper"));
  nh_.setParam("gripper/stall_timeout", 1.0);
  nh_.setParam("gripper/joint", "thumb");
  EXPECT_FALSE(manager_.loadController("gripper"));
  nh_.deleteParam("gripper/joint");
  EXPECT_FALSE(manager_.loadController("gripper"));
  nh_.setParam("gripper/joint", "finger");
  nh_.deleteParam("gripper/gains");
  EXPECT_EQ(!robot_.by_effort_, manager_.loadController("gripper"));
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "gripper_test");
  ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(3);
  spinner.start();
  return RUN_ALL_TESTS();
}
