// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The controllers, loaded as plugins by a controller manager, on a simulated robot with simulated
// time.
#include <actionlib/client/action_client.h>
#include <control_msgs/FollowJointTrajectoryAction.h>
#include <control_msgs/JointTrajectoryControllerState.h>
#include <control_msgs/QueryTrajectoryState.h>
#include <gtest/gtest.h>
#include <joint_trajectory_controller/joint_trajectory_controller.h>
#include <ros/ros.h>
#include <ros_test/controller_loop.h>
#include <rt_guard/rt_guard.h>
#include <trajectory_interface/quintic_spline_segment.h>

#include <atomic>
#include <boost/make_shared.hpp>
#include <chrono>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "test_robot.h"

namespace {

using closed_loop::kJoints;
typedef control_msgs::FollowJointTrajectoryResult Result;
typedef control_msgs::FollowJointTrajectoryGoal Goal;
typedef actionlib::ActionClient<control_msgs::FollowJointTrajectoryAction> Client;
typedef actionlib::TerminalState Terminal;

constexpr double kPeriod = 0.001;
const std::vector<std::string> kNames{"j0", "j1", "j2"};

/// A manager with one controller of each interface; time advances only by the test's steps.
class ClosedLoop : public ros_test::ControllerLoop<closed_loop::TestRobot>, public testing::Test {
 protected:
  ClosedLoop() : ControllerLoop("closed_loop") {
    nh_.setParam("robot_description", closed_loop::urdf());
  }

  ~ClosedLoop() override { nh_.deleteParam(name_); }

  void describe(const std::string& interface) {
    nh_.setParam(name_ + "/type", interface + "_controllers/JointTrajectoryController");
    nh_.setParam(name_ + "/joints", kNames);
    nh_.setParam(name_ + "/action_monitor_rate", 200.0);
    for (const std::string& joint : kNames) {
      nh_.setParam(name_ + "/gains/" + joint + "/p", interface == "effort" ? 2500.0 : 50.0);
      nh_.setParam(name_ + "/gains/" + joint + "/d", interface == "effort" ? 100.0 : 0.0);
      nh_.setParam(name_ + "/velocity_ff/" + joint, interface == "effort" ? 0.0 : 1.0);
      nh_.setParam(name_ + "/constraints/" + joint + "/trajectory", 0.05);
      nh_.setParam(name_ + "/constraints/" + joint + "/goal", 0.001);
    }
    nh_.setParam(name_ + "/constraints/goal_time", 0.5);
  }

  void start(const std::string& interface = "position") {
    describe(interface);
    ASSERT_TRUE(manager_.loadController(name_));
    ASSERT_TRUE(doSwitch({name_}, {}));
    client_ = std::make_unique<Client>(nh_, name_ + "/follow_joint_trajectory");
    until([&] { return client_->isServerConnected(); }, "the action server");
  }

  /// From the present position to `target` in `duration`, in `count` points on a cosine.
  Goal goalTo(std::vector<double> target, double duration = 1.0, int count = 100) {
    Goal goal;
    goal.trajectory.joint_names = kNames;
    for (int k = 1; k <= count; ++k) {
      trajectory_msgs::JointTrajectoryPoint point;
      const double share = double(k) / count;
      const double phase = M_PI * share;
      const double omega = M_PI / duration;
      point.time_from_start = ros::Duration(duration * share);
      for (std::size_t i = 0; i < kJoints; ++i) {
        const double way = target[i] - robot_.position_[i];
        point.positions.push_back(robot_.position_[i] + way * (1 - std::cos(phase)) / 2);
        point.velocities.push_back(way * omega * std::sin(phase) / 2);
        point.accelerations.push_back(way * omega * omega * std::cos(phase) / 2);
      }
      goal.trajectory.points.push_back(point);
    }
    return goal;
  }

  Client::GoalHandle send(const Goal& goal) { return client_->sendGoal(goal); }

  void untilActive(Client::GoalHandle& handle) {
    until([&] { return handle.getCommState() == actionlib::CommState::ACTIVE; },
          "the goal to be accepted", 0);
  }

  /// Waits for the end of a goal by a message in transit, which the robot must not overtake.
  Result endByMessage(Client::GoalHandle& handle) {
    until([&] { return handle.getCommState() == actionlib::CommState::DONE; }, "the goal's end", 0);
    return handle.getResult() ? *handle.getResult() : Result();
  }

  /// Steps until the goal ended. @returns the result
  Result end(Client::GoalHandle& handle) {
    until([&] { return handle.getCommState() == actionlib::CommState::DONE; }, "the goal's end");
    return handle.getResult() ? *handle.getResult() : Result();
  }

  Result expectRejected(const Goal& goal, int code) {
    Client::GoalHandle handle = send(goal);
    const Result result = end(handle);
    EXPECT_EQ(code, result.error_code);
    EXPECT_FALSE(result.error_string.empty());
    EXPECT_EQ(Terminal::REJECTED, handle.getTerminalState().state_);
    return result;
  }

  double distanceTo(const std::vector<double>& target) const {
    double largest = 0.0;
    for (std::size_t i = 0; i < kJoints; ++i) {
      largest = std::max(largest, std::abs(target[i] - robot_.position_[i]));
    }
    return largest;
  }

  const std::string name_{"trajectory"};
  const std::vector<double> target_{0.6, 0.3, -0.4};
  std::unique_ptr<Client> client_;
};

class EveryInterface : public ClosedLoop, public testing::WithParamInterface<const char*> {};

TEST_P(EveryInterface, ReachesAGoalOfHundredPoints) {
  start(GetParam());
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  const Result result = end(handle);
  EXPECT_EQ(Result::SUCCESSFUL, result.error_code) << result.error_string;
  EXPECT_EQ(Terminal::SUCCEEDED, handle.getTerminalState().state_);
  EXPECT_LT(distanceTo(target_), 0.001);
}

TEST_P(EveryInterface, NeitherAllocatesNorLocks) {
  start(GetParam());
  Client::GoalHandle handle = send(goalTo(target_, 1.0));
  untilActive(handle);
  rt_guard::Scope scope;
  steps(900);
  robot_.frozen_ = true;  // includes a violated tolerance
  steps(1500);
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

INSTANTIATE_TEST_SUITE_P(All, EveryInterface,
                         testing::Values("position", "velocity", "effort", "pos_vel",
                                         "pos_vel_acc"));

TEST_F(ClosedLoop, HoldsAfterAPathToleranceIsViolated) {
  start();
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  steps(100);
  robot_.frozen_ = true;
  const Result result = end(handle);
  EXPECT_EQ(Result::PATH_TOLERANCE_VIOLATED, result.error_code);
  EXPECT_EQ(Terminal::ABORTED, handle.getTerminalState().state_);
  // The joint with the longest path is the first to lag too far behind.
  EXPECT_EQ(0u, result.error_string.find("j2 path error -0.05")) << result.error_string;

  const closed_loop::TestRobot::Values stopped = robot_.position_;
  robot_.frozen_ = false;
  steps(2000);
  for (std::size_t i = 0; i < kJoints; ++i) {
    EXPECT_DOUBLE_EQ(stopped[i], robot_.position_[i]);
  }

  robot_.largest_step_ = 0.0;
  Client::GoalHandle again = send(goalTo(target_));
  EXPECT_EQ(Result::SUCCESSFUL, end(again).error_code);
  // The cosine's top speed is 0.7 * pi / 2 per second.
  EXPECT_LT(robot_.largest_step_, 1.05 * 0.7 * M_PI / 2 * kPeriod);
}

TEST_F(ClosedLoop, WaitsForTheGoalToleranceAndThenFails) {
  start();
  Goal goal = goalTo(target_);
  goal.path_tolerance.resize(3);
  for (std::size_t i = 0; i < kJoints; ++i) {
    goal.path_tolerance[i].name = kNames[i];
    goal.path_tolerance[i].position = -1.0;
  }
  Client::GoalHandle handle = send(goal);
  untilActive(handle);
  steps(500);
  robot_.frozen_ = true;
  const ros::Time before = time_;
  const Result result = end(handle);
  EXPECT_EQ(Result::GOAL_TOLERANCE_VIOLATED, result.error_code);
  EXPECT_NE(std::string::npos, result.error_string.find(" goal error "));
  EXPECT_GE((time_ - before).toSec(), 0.999);
}

TEST_F(ClosedLoop, AnotherGoalPreempts) {
  start();
  Client::GoalHandle first = send(goalTo(target_));
  untilActive(first);
  steps(300);
  const Goal back = goalTo({0.0, 0.0, 0.0});
  Client::GoalHandle second = send(back);
  const Result ended = endByMessage(first);
  EXPECT_EQ(Terminal::PREEMPTED, first.getTerminalState().state_);
  EXPECT_FALSE(ended.error_string.empty());
  EXPECT_EQ(Result::SUCCESSFUL, end(second).error_code);
  EXPECT_LT(distanceTo({0.0, 0.0, 0.0}), 0.001);
}

TEST_F(ClosedLoop, ATopicCommandPreempts) {
  start();
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  steps(200);
  ros::Publisher publisher =
      nh_.advertise<trajectory_msgs::JointTrajectory>(name_ + "/command", 1, true);
  publisher.publish(goalTo({0.0, 0.1, 0.2}).trajectory);
  endByMessage(handle);
  EXPECT_EQ(Terminal::PREEMPTED, handle.getTerminalState().state_);
  until([&] { return distanceTo({0.0, 0.1, 0.2}) < 1e-6; }, "the end of the topic's trajectory");
}

TEST_F(ClosedLoop, CancelHolds) {
  start();
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  steps(300);
  handle.cancel();
  const Result result = endByMessage(handle);
  EXPECT_EQ(Terminal::PREEMPTED, handle.getTerminalState().state_);
  EXPECT_FALSE(result.error_string.empty());
  steps(1);
  const closed_loop::TestRobot::Values stopped = robot_.position_;
  EXPECT_GT(distanceTo(target_), 0.01);
  steps(1000);
  for (std::size_t i = 0; i < kJoints; ++i) {
    EXPECT_DOUBLE_EQ(stopped[i], robot_.position_[i]);
  }
}

TEST_F(ClosedLoop, CancelBrakesWithinTheStopDuration) {
  nh_.setParam(name_ + "/stop_trajectory_duration", 0.2);
  start();
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  steps(500);
  const double speed = std::abs(robot_.velocity_[2]);  // of the fastest joint
  robot_.largest_step_ = 0.0;
  handle.cancel();
  endByMessage(handle);
  steps(300);
  EXPECT_NEAR(0.0, robot_.velocity_[2], 1e-9);
  EXPECT_LT(robot_.largest_step_, 1.05 * speed * kPeriod);
}

TEST_F(ClosedLoop, MalformedGoalsAreRejectedAndMoveNothing) {
  start();
  const closed_loop::TestRobot::Values before = robot_.position_;
  const Goal good = goalTo(target_);

  Goal goal = good;
  const std::vector<std::pair<std::vector<std::string>, std::string>> wrong_joints{
      {{},
       ": j0 j1 j2. Name them all, or set the controller's parameter allow_partial_joints_goal"},
      {{"j0", "j1"}, ": j2. Name them all"},
      {{"j0", "j1", "j9"}, "names 'j9', which is not a joint"},
      {{"j0", "j9"}, "Its joints are j0 j1 j2."},
      {{"j0", "j1", "j1"}, "'j1' more than once"},
      {{"j0", "j1", "j2", "j3"}, "'j3'"}};
  for (const auto& [names, sentence] : wrong_joints) {
    goal.trajectory.joint_names = names;
    const std::string text = expectRejected(goal, Result::INVALID_JOINTS).error_string;
    EXPECT_NE(std::string::npos, text.find(sentence)) << text;
  }

  goal = good;
  std::swap(goal.trajectory.points[3], goal.trajectory.points[4]);
  expectRejected(goal, Result::INVALID_GOAL);
  goal = good;
  goal.trajectory.points[7].positions.clear();
  expectRejected(goal, Result::INVALID_GOAL);
  goal = good;
  goal.trajectory.header.stamp = ros::Time(1.0);
  expectRejected(goal, Result::INVALID_GOAL);
  goal.trajectory.header.stamp = ros::Time(4000000000.0);
  expectRejected(goal, Result::INVALID_GOAL);

  EXPECT_EQ(before, robot_.position_);
}

TEST_F(ClosedLoop, GoalWithoutPointsHolds) {
  start();
  Goal goal;
  goal.trajectory.joint_names = kNames;
  Client::GoalHandle handle = send(goal);
  EXPECT_EQ(Result::SUCCESSFUL, end(handle).error_code);
  EXPECT_EQ(Terminal::SUCCEEDED, handle.getTerminalState().state_);
}

TEST_F(ClosedLoop, GoalsToAStoppedRobotAreRejectedWithItsReason) {
  start();
  robot_.stopped_ = true;
  EXPECT_EQ("The robot is stopped.",
            expectRejected(goalTo(target_), Result::INVALID_GOAL).error_string);
  robot_.stopped_ = false;
  Client::GoalHandle handle = send(goalTo(target_));
  EXPECT_EQ(Result::SUCCESSFUL, end(handle).error_code);
}

TEST_F(ClosedLoop, StoppingCancelsAndRefuses) {
  start();
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  steps(100);
  ASSERT_TRUE(doSwitch({}, {name_}));
  const Result result = end(handle);
  EXPECT_EQ(Terminal::PREEMPTED, handle.getTerminalState().state_);
  EXPECT_NE(std::string::npos, result.error_string.find("stopped"));
  EXPECT_EQ("Can't accept new commands. Controller is not running.",
            expectRejected(goalTo(target_), Result::INVALID_GOAL).error_string);
}

// A goal sent right after the switch must not be replaced by the hold of the start.
TEST_F(ClosedLoop, ResetEndsTheGoalAndAcceptsTheNext) {
  start();
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  steps(300);
  // As after a reflex: the loop restarts its controllers within one cycle.
  time_ += ros::Duration(kPeriod);
  manager_.update(time_, ros::Duration(kPeriod), true);
  robot_.move(kPeriod);
  const closed_loop::TestRobot::Values held = robot_.position_;
  EXPECT_NE(std::string::npos, endByMessage(handle).error_string.find("stopped"));
  steps(100);
  for (std::size_t i = 0; i < kJoints; ++i) {
    EXPECT_NEAR(held[i], robot_.position_[i], 1e-9);
  }
  Client::GoalHandle next = send(goalTo(target_));
  EXPECT_EQ(Result::SUCCESSFUL, end(next).error_code);
}

TEST_F(ClosedLoop, AGoalRightAfterASwitchIsFollowed) {
  start();
  for (int run = 0; run < 20; ++run) {
    ASSERT_TRUE(doSwitch({}, {name_}));
    ASSERT_TRUE(doSwitch({name_}, {}));
    const std::vector<double> target{0.01 * run, 0.0, 0.1};
    Client::GoalHandle handle = send(goalTo(target, 0.1, 5));
    ASSERT_EQ(Result::SUCCESSFUL, end(handle).error_code) << run;
    ASSERT_LT(distanceTo(target), 0.001) << run;
  }
}

// Goals arrive faster than they finish, while the loop runs: each ends, and none is lost. No more
// than actionlib's server queues (50): of callbacks that wait for a processor it drops the oldest.
TEST_F(ClosedLoop, ManyGoalsInSequence) {
  start();
  std::vector<Client::GoalHandle> handles;
  for (int run = 0; run < 40; ++run) {
    handles.push_back(send(goalTo({0.1 + 0.001 * run, -0.2, 0.3}, 0.3, 3)));
    const int count = (run * 37) % 60;
    for (int i = 0; i < count; ++i) {
      step();
      std::this_thread::yield();
    }
    if (run % 7 == 0) {
      handles.back().cancel();
    }
  }
  for (Client::GoalHandle& handle : handles) {
    end(handle);
  }
  EXPECT_EQ(Terminal::SUCCEEDED, handles.back().getTerminalState().state_);
}

/// Spline whose computation in callbacks can take ticks of the loop.
struct SlowSegment : trajectory_interface::QuinticSplineSegment<double> {
  SlowSegment() = default;
  SlowSegment(double start, const State& from, double end, const State& to)
      : QuinticSplineSegment(start, from, end, to) {
    if (meanwhile) {
      std::exchange(meanwhile, nullptr)();
    }
  }
  static std::function<void()> meanwhile;  ///< called once, by the next computation
};
std::function<void()> SlowSegment::meanwhile;

/// A controller without a manager, whose loop and callbacks share one thread.
class SlowController : public joint_trajectory_controller::JointTrajectoryController<
                           SlowSegment, hardware_interface::PositionJointInterface> {
 public:
  explicit SlowController(const ros::NodeHandle& nh) : nh_(nh) {
    EXPECT_TRUE(init(robot_.get<hardware_interface::PositionJointInterface>(), nh_, nh_));
    starting(time_);
  }

  void steps(int count) {
    for (int i = 0; i < count; ++i) {
      time_ += ros::Duration(kPeriod);
      update(time_, ros::Duration(kPeriod));
      robot_.move(kPeriod);
    }
  }

  /// Passes a message to the loop, which makes `ticks` while the trajectory is computed.
  void command(const trajectory_msgs::JointTrajectory& message, int ticks) {
    SlowSegment::meanwhile = [this, ticks] { steps(ticks); };
    EXPECT_TRUE(updateTrajectoryCommand(
        boost::make_shared<trajectory_msgs::JointTrajectory>(message), RealtimeGoalHandlePtr()));
  }

  closed_loop::TestRobot robot_;
  ros::Time time_{100.0};

 private:
  ros::NodeHandle nh_;
};

/// A message to `target` that begins at a time, in points after 0.1, 0.2 and 0.3 s.
/// @param derivatives how many the points have: 0 to 2
trajectory_msgs::JointTrajectory threePoints(const ros::Time& begin, double target,
                                             int derivatives) {
  trajectory_msgs::JointTrajectory message;
  message.header.stamp = begin;
  message.joint_names = kNames;
  for (int k = 1; k <= 3; ++k) {
    trajectory_msgs::JointTrajectoryPoint point;
    point.time_from_start = ros::Duration(0.1 * k);
    point.positions.assign(kJoints, target * k / 3);
    point.velocities.assign(derivatives > 0 ? kJoints : 0, k < 3 ? target / 0.3 : 0.0);
    point.accelerations.assign(derivatives > 1 ? kJoints : 0, 0.0);
    message.points.push_back(point);
  }
  return message;
}

class SlowCallbacks : public ClosedLoop, public testing::WithParamInterface<std::tuple<int, int>> {
 protected:
  /// Positions in 41 ticks, from the one in which the loop gets the second of two messages.
  /// @param wait ticks before the message comes
  /// @param ticks that its computation takes
  /// @param third whether another message comes before the last tick
  std::vector<closed_loop::TestRobot::Values> path(int wait, int ticks, bool third) {
    const int derivatives = std::get<1>(GetParam());
    SlowController controller(ros::NodeHandle(nh_, name_));
    controller.command(threePoints(controller.time_, 0.3, derivatives), 0);
    controller.steps(47);
    const trajectory_msgs::JointTrajectory second =
        threePoints(controller.time_, -0.2, derivatives);
    controller.steps(wait);
    controller.command(second, ticks);
    std::vector<closed_loop::TestRobot::Values> result;
    while (result.size() < 41) {
      if (third && result.size() == 40) {
        controller.command(threePoints(controller.time_, 0.0, derivatives), 0);
      }
      controller.steps(1);
      result.push_back(controller.robot_.position_);
    }
    return result;
  }

  static void expectEqual(const std::vector<closed_loop::TestRobot::Values>& expected,
                          const std::vector<closed_loop::TestRobot::Values>& actual) {
    for (std::size_t i = 0; i < expected.size(); ++i) {
      for (std::size_t joint = 0; joint < kJoints; ++joint) {
        ASSERT_NEAR(expected[i][joint], actual[i][joint], 1e-12) << "tick " << i;
      }
    }
  }
};

// However many ticks a computation takes: once the loop has the trajectory, it moves as if the
// callbacks had got the message then and taken no time.
TEST_P(SlowCallbacks, JoinWithoutAJump) {
  const int ticks = std::get<0>(GetParam());
  describe("position");
  const auto slow = path(0, ticks, false);
  expectEqual(path(ticks, 0, false), slow);
  // A third trajectory begins on the present motion, passage included.
  expectEqual(path(0, ticks, true), slow);
}

INSTANTIATE_TEST_SUITE_P(All, SlowCallbacks,
                         testing::Combine(testing::Values(0, 1, 13, 60), testing::Values(0, 1, 2)));

// A trajectory that is over before the loop gets it is not jumped to. One for a certain time is
// given up, the other one begins again.
TEST_F(ClosedLoop, ATrajectoryThatIsOverIsNotJumpedTo) {
  describe("position");
  SlowController slow(ros::NodeHandle(nh_, name_));
  for (const ros::Time& begin : {slow.time_, ros::Time()}) {
    slow.command(threePoints(begin, 0.3, 2), 400);
    slow.steps(1);
    EXPECT_LT(slow.robot_.largest_step_, 1e-9);
  }
  const auto arrived = [&] {
    slow.steps(1);
    return std::abs(slow.robot_.position_[0] - 0.3) < 1e-9;
  };
  ASSERT_TRUE(ros_test::eventually(arrived, std::chrono::microseconds(20)));
}

// The other joints hold since before the loop gets the trajectory, but may still move: they stop
// with it, and it is neither refused nor computed again.
TEST_F(ClosedLoop, APartialGoalRightAfterACancelIsFollowed) {
  nh_.setParam(name_ + "/allow_partial_joints_goal", true);
  describe("position");
  SlowController slow(ros::NodeHandle(nh_, name_));
  slow.command(threePoints(slow.time_, 0.3, 2), 0);
  slow.steps(150);
  const double top = slow.robot_.largest_step_;
  slow.command(trajectory_msgs::JointTrajectory(), 0);  // hold, replaced before the loop gets it
  trajectory_msgs::JointTrajectory partial = threePoints(slow.time_, 0.3, 2);
  partial.joint_names = {"j1"};
  for (trajectory_msgs::JointTrajectoryPoint& point : partial.points) {
    point.positions.resize(1);
    point.velocities.resize(1);
    point.accelerations.resize(1);
  }
  const closed_loop::TestRobot::Values held = slow.robot_.position_;  // up to one step further
  slow.command(partial, 0);
  slow.steps(301);
  EXPECT_NEAR(0.3, slow.robot_.position_[1], 1e-9);
  EXPECT_NEAR(held[0], slow.robot_.position_[0], top);
  EXPECT_NEAR(held[2], slow.robot_.position_[2], top);
  EXPECT_LT(slow.robot_.largest_step_, 1.2 * top);
}

TEST_F(ClosedLoop, OnlyContinuousJointsWrapAround) {
  start();
  // One turn further: the continuous joint is already there, the others have to move.
  const std::vector<double> target{robot_.position_[0] + 2 * M_PI, robot_.position_[1] + 2 * M_PI,
                                   robot_.position_[2] + 2 * M_PI};
  const double before = robot_.position_[2];
  Goal goal = goalTo(target, 4.0, 1);
  Client::GoalHandle handle = send(goal);
  EXPECT_EQ(Result::SUCCESSFUL, end(handle).error_code);
  EXPECT_NEAR(target[0], robot_.position_[0], 0.001);
  EXPECT_NEAR(target[1], robot_.position_[1], 0.001);
  EXPECT_NEAR(before, robot_.position_[2], 0.001);
}

TEST_F(ClosedLoop, PublishesItsState) {
  std::atomic<int> states{0};
  control_msgs::JointTrajectoryControllerState last;
  const auto count = [&](const control_msgs::JointTrajectoryControllerState::ConstPtr& state) {
    last = *state;
    ++states;
  };
  ros::Subscriber subscriber = nh_.subscribe<control_msgs::JointTrajectoryControllerState>(
      name_ + "/state", 100,
      boost::function<void(const control_msgs::JointTrajectoryControllerState::ConstPtr&)>(count));
  start();
  until([&] { return states > 3; }, "states");
  subscriber.shutdown();
  EXPECT_EQ(kNames, last.joint_names);
  EXPECT_NEAR(0.1, last.actual.positions.at(0), 1e-12);
  EXPECT_NEAR(0.1, last.desired.positions.at(0), 1e-12);
  EXPECT_EQ(kJoints, last.error.velocities.size());

  ros::ServiceClient query =
      nh_.serviceClient<control_msgs::QueryTrajectoryState>(name_ + "/query_state");
  Client::GoalHandle handle = send(goalTo(target_));
  untilActive(handle);
  const ros::Time begin = time_ + ros::Duration(kPeriod);
  steps(300);
  control_msgs::QueryTrajectoryState state;
  state.request.time = begin + ros::Duration(0.5);
  ASSERT_TRUE(query.call(state));
  EXPECT_EQ(kNames, state.response.name);
  // Half of a cosine.
  EXPECT_NEAR(0.35, state.response.position.at(0), 0.002);
  EXPECT_NEAR(0.5 * M_PI / 2, state.response.velocity.at(0), 0.005);
  state.request.time = ros::Time(1.0);
  EXPECT_FALSE(query.call(state));
}

TEST_F(ClosedLoop, RefusesInvalidParameters) {
  const auto refused = [&](const std::string& parameter, const XmlRpc::XmlRpcValue& value,
                           const std::string& interface = "position") {
    describe(interface);
    nh_.setParam(name_ + "/" + parameter, value);
    const bool loaded = manager_.loadController(name_);
    nh_.deleteParam(name_);
    return !loaded;
  };
  XmlRpc::XmlRpcValue twice;
  twice[0] = "j0";
  twice[1] = "j0";
  XmlRpc::XmlRpcValue unknown;
  unknown[0] = "j9";
  XmlRpc::XmlRpcValue number;
  number[0] = 3;
  EXPECT_TRUE(refused("joints", XmlRpc::XmlRpcValue("j0")));
  EXPECT_TRUE(refused("joints", number));
  EXPECT_TRUE(refused("joints", twice));
  EXPECT_TRUE(refused("joints", unknown));
  EXPECT_TRUE(refused("state_publish_rate", XmlRpc::XmlRpcValue(-1.0)));
  EXPECT_TRUE(refused("action_monitor_rate", XmlRpc::XmlRpcValue(0.0)));
  EXPECT_TRUE(refused("stop_trajectory_duration", XmlRpc::XmlRpcValue(-0.1)));
  EXPECT_TRUE(refused("gains", XmlRpc::XmlRpcValue(1.0), "effort"));
  EXPECT_FALSE(refused("state_publish_rate", XmlRpc::XmlRpcValue(0.0)));
}

}  // namespace

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "closed_loop_test");
  ros::NodeHandle keep_alive;
  ros::AsyncSpinner spinner(3);
  spinner.start();
  return RUN_ALL_TESTS();
}
