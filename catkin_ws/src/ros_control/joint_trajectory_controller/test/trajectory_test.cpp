// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Splines, messages, splicing and tolerances, without a ROS master.
#include <gtest/gtest.h>
#include <hardware_interface/joint_command_interface.h>
#include <joint_trajectory_controller/hold_trajectory_builder.h>
#include <joint_trajectory_controller/init_joint_trajectory.h>
#include <joint_trajectory_controller/stop_trajectory_builder.h>
#include <rt_guard/rt_guard.h>
#include <trajectory_interface/quintic_spline_segment.h>

#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace {

namespace jtc = joint_trajectory_controller;
typedef trajectory_interface::QuinticSplineSegment<double> Spline;
typedef jtc::JointTrajectorySegment<Spline> Segment;
typedef std::vector<std::vector<Segment>> Trajectory;
typedef jtc::InitJointTrajectoryOptions<Trajectory> Options;

Spline::State stateOf(std::vector<double> p, std::vector<double> v = {},
                      std::vector<double> a = {}) {
  Spline::State state;
  state.position = p;
  state.velocity = v;
  state.acceleration = a;
  return state;
}

class SplineTest : public testing::Test {
 protected:
  double draw(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }
  std::mt19937 random_{7};
};

// A polynomial of the segment's degree is determined by its boundary values: sampling it and
// interpolating between the samples must reproduce it.
TEST_F(SplineTest, ReproducesPolynomials) {
  for (int degree : {1, 3, 5}) {
    for (int run = 0; run < 200; ++run) {
      std::vector<double> c(6, 0.0);
      for (int i = 0; i <= degree; ++i) {
        c[i] = draw(-2, 2);
      }
      const double begin = draw(-5, 5);
      const double length = draw(0.05, 3);
      const auto exact = [&](double t, int derivative) {
        double sum = 0.0;
        for (int i = derivative; i <= degree; ++i) {
          double factor = c[i];
          for (int k = 0; k < derivative; ++k) {
            factor *= i - k;
          }
          sum += factor * std::pow(t, i - derivative);
        }
        return sum;
      };
      const auto end = [&](double t) {
        Spline::State state = stateOf({exact(t, 0)});
        if (degree > 1) {
          state.velocity = {exact(t, 1)};
        }
        if (degree > 3) {
          state.acceleration = {exact(t, 2)};
        }
        return state;
      };
      const Spline segment(begin, end(0.0), begin + length, end(length));
      Spline::State state;
      for (double share : {0.0, 0.2, 0.5, 0.93}) {
        const double t = share * length;
        segment.sample(begin + t, state);
        // The quintic's coefficients are divided by up to the fifth power of the length.
        const double tolerance = 1e-8 * std::max(1.0, std::pow(1.0 / length, 2));
        EXPECT_NEAR(exact(t, 0), state.position[0], tolerance);
        EXPECT_NEAR(exact(t, 1), state.velocity[0], tolerance);
        EXPECT_NEAR(exact(t, 2), state.acceleration[0], 100 * tolerance);
      }
    }
  }
}

TEST_F(SplineTest, MixedBoundaryValuesUseTheLowerDegree) {
  Spline::State state;
  Spline(0.0, stateOf({0.0}, {5.0}), 2.0, stateOf({1.0})).sample(1.0, state);
  EXPECT_DOUBLE_EQ(0.5, state.position[0]);
  EXPECT_DOUBLE_EQ(0.5, state.velocity[0]);
  Spline(0.0, stateOf({0.0}, {0.0}, {9.0}), 2.0, stateOf({1.0}, {0.0})).sample(1.0, state);
  EXPECT_DOUBLE_EQ(0.5, state.position[0]);
  EXPECT_DOUBLE_EQ(0.75, state.velocity[0]);
}

TEST_F(SplineTest, RestsOutsideItsTime) {
  const Spline segment(1.0, stateOf({1.0}, {1.0}), 2.0, stateOf({5.0}, {2.0}));
  Spline::State state;
  segment.sample(0.5, state);
  EXPECT_EQ(1.0, state.position[0]);
  EXPECT_EQ(0.0, state.velocity[0]);
  EXPECT_EQ(0.0, state.acceleration[0]);
  segment.sample(9.0, state);
  EXPECT_NEAR(5.0, state.position[0], 1e-12);
  EXPECT_EQ(0.0, state.velocity[0]);
}

TEST_F(SplineTest, ZeroLengthGivesTheStartState) {
  const Spline segment(1.0, stateOf({1.0}, {3.0}, {4.0}), 1.0, stateOf({7.0}, {0.0}, {0.0}));
  Spline::State state;
  segment.sample(1.0, state);
  EXPECT_EQ(1.0, state.position[0]);
  EXPECT_EQ(3.0, state.velocity[0]);
  EXPECT_EQ(4.0, state.acceleration[0]);
}

TEST_F(SplineTest, RefusesInvalidArguments) {
  const auto expectRefusal = [](double begin, Spline::State from, double end, Spline::State to) {
    EXPECT_THROW(Spline(begin, from, end, to), std::invalid_argument);
  };
  expectRefusal(1, stateOf({0}), 0, stateOf({0}));
  expectRefusal(0, stateOf({}), 1, stateOf({0}));
  expectRefusal(0, stateOf({0}), 1, stateOf({0, 1}));
  expectRefusal(0, stateOf({0}, {1, 2}), 1, stateOf({0}));
  expectRefusal(0, stateOf({0}), 1, stateOf({0}, {1}, {1, 2}));
  expectRefusal(0, stateOf({0}), std::nan(""), stateOf({0}));
}

trajectory_msgs::JointTrajectoryPoint pointOf(double time, std::vector<double> p,
                                              std::vector<double> v = {},
                                              std::vector<double> a = {}) {
  trajectory_msgs::JointTrajectoryPoint point;
  point.time_from_start = ros::Duration(time);
  point.positions = p;
  point.velocities = v;
  point.accelerations = a;
  return point;
}

class SpliceTest : public testing::Test {
 protected:
  SpliceTest() {
    msg_.joint_names = {"b", "a"};
    msg_.points = {pointOf(1.0, {10, 1}, {0, 0}), pointOf(2.0, {20, 2}, {0, 0})};
    const Spline::State still = stateOf({0.5}, {0.0}, {0.0});
    Segment hold;
    hold.init(0.0, still, 0.0, still);
    current_ = {{hold}, {hold}};
    options_.current_trajectory = &current_;
    options_.joint_names = &names_;
    options_.other_time_base = &base_;
    options_.error_string = &error_;
  }

  Trajectory convert(double now = 100.0) {
    return jtc::initJointTrajectory<Trajectory>(msg_, ros::Time(now), options_);
  }

  static Segment::State at(const std::vector<Segment>& joint, double time) {
    Segment::State state;
    trajectory_interface::sample(joint, time, state);
    return state;
  }

  trajectory_msgs::JointTrajectory msg_;
  std::vector<std::string> names_{"a", "b"};
  std::vector<bool> wraps_{true, false};
  Trajectory current_;
  ros::Time base_{4.0};
  std::string error_;
  Options options_;
};

TEST_F(SpliceTest, LeadsFromTheCurrentTrajectoryThroughAllPoints) {
  const Trajectory result = convert();
  ASSERT_EQ(2u, result.size());
  for (int joint : {0, 1}) {
    const double scale = joint == 0 ? 1.0 : 10.0;
    EXPECT_NEAR(0.5, at(result[joint], 4.0).position[0], 1e-12);
    EXPECT_NEAR(scale, at(result[joint], 5.0).position[0], 1e-12);
    EXPECT_NEAR(2 * scale, at(result[joint], 6.0).position[0], 1e-12);
    EXPECT_EQ(0.0, at(result[joint], 7.0).velocity[0]);
  }
}

// Position and velocity never jump where two trajectories are spliced.
TEST_F(SpliceTest, IsContinuousForAnyStart) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  Trajectory current = current_;
  double now = 4.0;
  for (int run = 0; run < 300; ++run) {
    now += 0.3 * (1.0 + draw(random));
    base_ = ros::Time(now);
    now = base_.toSec();
    msg_.header.stamp = ros::Time(100.0 + 0.5 * draw(random));
    msg_.points.clear();
    for (int i = 0; i < 4; ++i) {
      msg_.points.push_back(pointOf(0.6 + 0.4 * i, {draw(random), draw(random)},
                                    {draw(random), draw(random)}, {0.0, 0.0}));
    }
    current_ = current;
    const Trajectory next = convert();
    ASSERT_EQ(2u, next.size()) << error_;
    for (int joint : {0, 1}) {
      EXPECT_NEAR(at(current[joint], now).position[0], at(next[joint], now).position[0], 1e-9);
      const double step = 1e-6;
      for (const Segment& segment : next[joint]) {
        const double seam = segment.startTime();
        if (seam < now) {
          continue;
        }
        EXPECT_NEAR(at(next[joint], seam - step).position[0],
                    at(next[joint], seam + step).position[0], 1e-3);
      }
      EXPECT_NEAR(msg_.points[3].positions[1 - joint], at(next[joint], now + 9.0).position[0],
                  1e-9);
    }
    current = next;
  }
}

TEST_F(SpliceTest, KeepsTheCurrentTrajectoryUntilTheMessageStarts) {
  current_ = convert();
  base_ = ros::Time(4.5);
  msg_.header.stamp = ros::Time(101.0);
  msg_.points = {pointOf(0.5, {0, 0}, {0, 0})};
  const Trajectory result = convert(100.0);
  for (double time : {4.6, 5.0, 5.4}) {
    EXPECT_NEAR(at(current_[0], time).position[0], at(result[0], time).position[0], 1e-12);
  }
  EXPECT_NEAR(0.0, at(result[0], 6.0).position[0], 1e-12);
}

TEST_F(SpliceTest, LeavesEarlyForAFirstPointAtTheStart) {
  msg_.header.stamp = ros::Time(101.0);
  msg_.points = {pointOf(0.0, {10, 1}), pointOf(1.0, {20, 2})};
  const Trajectory result = convert();
  EXPECT_NEAR(0.5, at(result[0], 4.0).position[0], 1e-12);
  EXPECT_NEAR(0.75, at(result[0], 4.5).position[0], 1e-12);
  EXPECT_NEAR(1.0, at(result[0], 5.0).position[0], 1e-12);
}

// A planner that continues the present motion starts its message with a state on it.
TEST_F(SpliceTest, KeepsTheCurrentTrajectoryUntilAFirstPointThatLiesOnIt) {
  options_.angle_wraparound = &wraps_;
  current_ = convert();
  base_ = ros::Time(4.5);
  msg_.header.stamp = ros::Time(101.0);
  const Segment::State a = at(current_[0], 5.5);
  const Segment::State b = at(current_[1], 5.5);
  ASSERT_GT(a.velocity[0], 0.1);
  const auto begin = [&](double position_step, double velocity_step) {
    msg_.points = {pointOf(0.0, {b.position[0], a.position[0] + 2 * M_PI + position_step},
                           {b.velocity[0], a.velocity[0] + velocity_step}),
                   pointOf(1.0, {0, 2 * M_PI}, {0, 0})};
    return convert();
  };
  const Trajectory result = begin(1e-9, 1e-9);
  ASSERT_EQ(2u, result.size());
  for (int joint : {0, 1}) {
    for (double time = 4.5; time < 5.5; time += 0.05) {
      EXPECT_NEAR(at(current_[joint], time).position[0], at(result[joint], time).position[0],
                  1e-12);
    }
    const double step = 1e-7;
    EXPECT_NEAR(at(result[joint], 5.5 - step).position[0],
                at(result[joint], 5.5 + step).position[0], 1e-5);
    EXPECT_NEAR(at(result[joint], 5.5 - step).velocity[0],
                at(result[joint], 5.5 + step).velocity[0], 1e-4);
    EXPECT_NEAR(0.0, at(result[joint], 6.5).position[0], 1e-12);
  }
  // For another position or velocity that joint alone must move there.
  for (const Trajectory& detour : {begin(0.5, 0.0), begin(0.0, 0.5)}) {
    EXPECT_GT(std::abs(at(current_[0], 5.2).position[0] - at(detour[0], 5.2).position[0]), 1e-3);
    EXPECT_NEAR(at(current_[1], 5.2).position[0], at(detour[1], 5.2).position[0], 1e-12);
  }
}

TEST_F(SpliceTest, DropsPastPoints) {
  msg_.header.stamp = ros::Time(98.5);
  const Trajectory result = convert();
  ASSERT_FALSE(result.empty());
  EXPECT_NEAR(2.0, at(result[0], 4.5).position[0], 1e-9);
  msg_.header.stamp = ros::Time(90.0);
  EXPECT_TRUE(convert().empty());
  EXPECT_NE(std::string::npos, error_.find("8.000000s in the past")) << error_;
}

TEST_F(SpliceTest, NeedsTwoPointsWithoutACurrentTrajectory) {
  options_.current_trajectory = nullptr;
  const Trajectory result = convert();
  ASSERT_EQ(2u, result.size());
  for (const std::vector<Segment>& joint : result) {
    ASSERT_EQ(1u, joint.size());
    EXPECT_EQ(5.0, joint[0].startTime());
    EXPECT_EQ(6.0, joint[0].endTime());
  }
  // One point remains, first because the other is past, then because there is no other.
  msg_.header.stamp = ros::Time(98.5);
  EXPECT_TRUE(convert().empty());
  EXPECT_NE(std::string::npos, error_.find("makes no trajectory without a current one")) << error_;
  msg_.header.stamp = ros::Time();
  msg_.points.pop_back();
  EXPECT_TRUE(convert().empty());
}

TEST_F(SpliceTest, PartialMessagesDoNotAffectOtherJoints) {
  current_ = convert();
  msg_.joint_names = {"b"};
  msg_.points = {pointOf(1.0, {7}, {0})};
  EXPECT_TRUE(convert().empty());
  options_.allow_partial_joints_goal = true;
  const Trajectory result = convert();
  ASSERT_EQ(2u, result.size());
  for (double time = 4.0; time < 7.0; time += 0.1) {
    EXPECT_NEAR(at(current_[0], time).position[0], at(result[0], time).position[0], 1e-12);
  }
  EXPECT_NEAR(7.0, at(result[1], 5.0).position[0], 1e-12);
}

TEST_F(SpliceTest, ContinuousJointsTakeTheShorterTurn) {
  options_.angle_wraparound = &wraps_;
  msg_.points = {pointOf(1.0, {10, 0.5 + 2 * M_PI + 0.1}, {0, 0})};
  const Trajectory result = convert();
  EXPECT_NEAR(0.6, at(result[0], 5.0).position[0], 1e-9);
  EXPECT_NEAR(10.0, at(result[1], 5.0).position[0], 1e-9);
}

TEST(Wraparound, StaysWithinHalfATurnAndOnTheCircle) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> draw(-20.0, 20.0);
  for (int run = 0; run < 1000; ++run) {
    const double previous = draw(random);
    const double next = draw(random);
    const double offset = jtc::wraparoundJointOffset(previous, next, true);
    EXPECT_LE(std::abs(next + offset - previous), M_PI + 1e-9);
    EXPECT_NEAR(0.0, std::sin(offset / 2), 1e-9);
    EXPECT_EQ(0.0, jtc::wraparoundJointOffset(previous, next, false));
  }
  EXPECT_NEAR(0.0, jtc::wraparoundJointOffset(0.0, M_PI, true), 1e-9);
  EXPECT_NEAR(0.0, jtc::wraparoundJointOffset(M_PI, 0.0, true), 1e-9);
}

TEST_F(SpliceTest, RefusesBadMessagesWithASentence) {
  const trajectory_msgs::JointTrajectory good = msg_;
  msg_.points.clear();
  EXPECT_TRUE(convert().empty());
  EXPECT_NE(std::string::npos, error_.find("empty trajectory"));

  msg_ = good;
  msg_.points[1].time_from_start = msg_.points[0].time_from_start;
  EXPECT_TRUE(convert().empty());
  EXPECT_NE(std::string::npos, error_.find("not strictly increasing in time."));

  msg_ = good;
  msg_.joint_names = {"a", "other"};
  EXPECT_TRUE(convert().empty());
  EXPECT_NE(std::string::npos, error_.find("It does not contain the expected joints."));
  msg_.joint_names = {"a", "a"};
  EXPECT_TRUE(convert().empty());

  msg_ = good;
  msg_.points[1].positions[0] = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(convert().empty());
  EXPECT_NE(std::string::npos, error_.find("not finite"));

  wraps_.pop_back();
  msg_ = good;
  options_.angle_wraparound = &wraps_;
  EXPECT_TRUE(convert().empty());
}

TEST_F(SpliceTest, ThrowsOnPointsOfTheWrongSize) {
  const trajectory_msgs::JointTrajectory good = msg_;
  // All points are too short in the same way: sizes match each other but not the joints.
  for (trajectory_msgs::JointTrajectoryPoint& point : msg_.points) {
    point.positions = {1.0};
    point.velocities.clear();
  }
  EXPECT_THROW(convert(), std::invalid_argument);
  msg_ = good;
  msg_.points[1].velocities.push_back(1.0);
  EXPECT_THROW(convert(), std::invalid_argument);
  msg_ = good;
  msg_.points[1].accelerations = {1.0};
  EXPECT_THROW(convert(), std::invalid_argument);
  msg_ = good;
  msg_.points[0].positions.clear();
  EXPECT_THROW(convert(), std::invalid_argument);
}

TEST_F(SpliceTest, IgnoresNumbersBeyondTheNamedJoints) {
  const Trajectory expected = convert();
  for (trajectory_msgs::JointTrajectoryPoint& point : msg_.points) {
    for (std::vector<double>* numbers :
         {&point.positions, &point.velocities, &point.accelerations}) {
      if (!numbers->empty()) {
        numbers->push_back(9.0);
      }
    }
  }
  const Trajectory found = convert();
  ASSERT_EQ(expected.size(), found.size());
  for (std::size_t i = 0; i < found.size(); ++i) {
    ASSERT_EQ(expected[i].size(), found[i].size());
    Segment::State a, b;
    trajectory_interface::sample(expected[i], expected[i].back().endTime(), a);
    trajectory_interface::sample(found[i], found[i].back().endTime(), b);
    EXPECT_EQ(a.position, b.position);
  }
}

TEST(Messages, PointsAreFoundByTime) {
  trajectory_msgs::JointTrajectory msg;
  msg.header.stamp = ros::Time(10.0);
  msg.points = {pointOf(1.0, {0}), pointOf(2.0, {0})};
  EXPECT_EQ(msg.points.end(), jtc::findPoint(msg, ros::Time(10.5)));
  EXPECT_EQ(msg.points.begin(), jtc::findPoint(msg, ros::Time(11.0)));
  EXPECT_EQ(msg.points.begin() + 1, jtc::findPoint(msg, ros::Time(99.0)));
}

TEST(SegmentOfPoints, CopiesAllQuantities) {
  const Segment::State state(pointOf(1.5, {1, 2, 3}, {4, 5, 6}), {0.5, 0, -1});
  EXPECT_EQ((std::vector<double>{1.5, 2, 2}), state.position);
  EXPECT_EQ((std::vector<double>{4, 5, 6}), state.velocity);
  EXPECT_TRUE(state.acceleration.empty());
  EXPECT_EQ(1.5, state.time_from_start);
  EXPECT_THROW(Segment::State(pointOf(0, {1, 2}), {0}), std::invalid_argument);
  EXPECT_THROW(Segment::State(pointOf(0, {1, 2}, {1})), std::invalid_argument);

  const Segment segment(ros::Time(10.0), pointOf(1.0, {1, 2}), pointOf(3.0, {5, 6}), {0.5, -0.5});
  EXPECT_EQ(11.0, segment.startTime());
  EXPECT_EQ(13.0, segment.endTime());
  Segment::State sampled;
  segment.sample(12.0, sampled);
  EXPECT_EQ((std::vector<double>{3.5, 3.5}), sampled.position);
  EXPECT_EQ(nullptr, segment.getGoalHandle());
}

/// Two joints moved by tests.
struct Joints {
  Joints() {
    for (std::size_t i = 0; i < 2; ++i) {
      handles.emplace_back(hardware_interface::JointStateHandle("j" + std::to_string(i),
                                                                &position[i], &velocity, &effort),
                           &command);
    }
  }
  double position[2]{1.0, -2.0};
  double velocity{0.7};
  double effort{0.0};
  double command{0.0};
  std::vector<hardware_interface::JointHandle> handles;
};

typedef jtc::HoldTrajectoryBuilder<Spline, hardware_interface::PositionJointInterface> HoldBuilder;
typedef jtc::StopTrajectoryBuilder<Spline> StopBuilder;

/// A trajectory of two joints with a segment each.
Trajectory allocated() { return Trajectory(2, std::vector<Segment>(1)); }

TEST(Builders, HoldAtTheJointPositions) {
  Joints joints;
  HoldBuilder hold(joints.handles);
  Trajectory trajectory = allocated();
  ASSERT_TRUE(hold.setStartTime(3.0)->buildTrajectory(&trajectory));
  joints.position[1] = 5.0;
  ASSERT_TRUE(hold.setStartTime(4.0)->buildTrajectory(&trajectory));
  ASSERT_EQ(2u, trajectory.size());
  for (std::size_t i : {0, 1}) {
    ASSERT_EQ(1u, trajectory[i].size());
    EXPECT_EQ(4.0, trajectory[i][0].startTime());
    EXPECT_EQ(4.0, trajectory[i][0].endTime());
    Segment::State sampled;
    trajectory_interface::sample(trajectory[i], 4.0, sampled);
    EXPECT_EQ(joints.position[i], sampled.position[0]);
    EXPECT_EQ(0.0, sampled.velocity[0]);
    EXPECT_EQ(0.0, sampled.acceleration[0]);
  }
}

TEST(Builders, HoldRefusesAnIncompleteTrajectory) {
  Joints joints;
  HoldBuilder hold(joints.handles);
  hold.setStartTime(1.0);
  for (Trajectory incomplete : {Trajectory(), Trajectory(1, allocated()[0]), Trajectory(2),
                                Trajectory(3, allocated()[0])}) {
    const std::size_t joint_count = incomplete.size();
    EXPECT_FALSE(hold.buildTrajectory(&incomplete)) << joint_count;
    EXPECT_EQ(joint_count, incomplete.size());
  }
}

TEST(Builders, ReadTheCallersGoalPointerWhenTheyBuild) {
  Joints joints;
  HoldBuilder hold(joints.handles);
  Segment::RealtimeGoalHandle::GoalHandle gh;
  Segment::RealtimeGoalHandlePtr goal;
  hold.setStartTime(1.0)->setGoalHandle(goal);
  goal.reset(new Segment::RealtimeGoalHandle(gh));
  EXPECT_EQ(1, goal.use_count());
  Trajectory trajectory = allocated();
  ASSERT_TRUE(hold.buildTrajectory(&trajectory));
  EXPECT_EQ(goal, trajectory[0][0].getGoalHandle());
  EXPECT_EQ(3, goal.use_count());
}

TEST(Builders, StopWithinTheTimeGiven) {
  Segment::State state(1);
  state.position = {1.0};
  state.velocity = {2.0};
  Trajectory trajectory;
  Segment::State sampled;
  StopBuilder stop(0.5, state);
  ASSERT_TRUE(stop.setStartTime(3.0)->buildTrajectory(&trajectory));
  for (double t : {0.0, 0.1, 0.25, 0.5}) {
    // Uniform deceleration: v(t) = v0 (1 - t/D), p(t) = p0 + v0 (t - t^2 / 2D).
    trajectory_interface::sample(trajectory[0], 3.0 + t, sampled);
    EXPECT_NEAR(1.0 + 2.0 * (t - t * t), sampled.position[0], 1e-12);
    EXPECT_NEAR(2.0 * (1.0 - 2.0 * t), sampled.velocity[0], 1e-12);
  }
  trajectory_interface::sample(trajectory[0], 9.0, sampled);
  EXPECT_NEAR(1.5, sampled.position[0], 1e-12);
}

TEST(Builders, AttachTheGoalUntilReset) {
  Segment::State state(2);
  Joints joints;
  HoldBuilder hold(joints.handles);
  StopBuilder stop(0.5, state);
  Segment::RealtimeGoalHandle::GoalHandle gh;
  Segment::RealtimeGoalHandlePtr goal(new Segment::RealtimeGoalHandle(gh));
  for (jtc::TrajectoryBuilder<Spline>* builder :
       {static_cast<jtc::TrajectoryBuilder<Spline>*>(&hold),
        static_cast<jtc::TrajectoryBuilder<Spline>*>(&stop)}) {
    Trajectory trajectory = allocated();
    EXPECT_FALSE(builder->buildTrajectory(&trajectory)) << "without a start time";
    EXPECT_FALSE(builder->setStartTime(1.0)->buildTrajectory(nullptr));
    ASSERT_TRUE(builder->setGoalHandle(goal)->buildTrajectory(&trajectory));
    EXPECT_EQ(goal, trajectory[1][0].getGoalHandle());
    builder->reset();
    EXPECT_FALSE(builder->buildTrajectory(&trajectory));
    ASSERT_TRUE(builder->setStartTime(1.0)->buildTrajectory(&trajectory));
    EXPECT_EQ(nullptr, trajectory[1][0].getGoalHandle());
  }
}

TEST(Builders, BuildAgainWithoutAllocating) {
  Segment::State state(2);
  Joints joints;
  HoldBuilder hold(joints.handles);
  StopBuilder stop(0.5, state);
  Trajectory held = allocated();
  Trajectory stopped;
  hold.setStartTime(1.0)->buildTrajectory(&held);
  stop.setStartTime(1.0)->buildTrajectory(&stopped);
  rt_guard::Scope scope;
  hold.setStartTime(2.0)->buildTrajectory(&held);
  stop.setStartTime(2.0)->buildTrajectory(&stopped);
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}

TEST(Tolerances, CheckAndOverride) {
  Spline::State error = stateOf({0.2}, {0.0}, {0.0});
  typedef jtc::StateTolerances<double> Tolerances;
  EXPECT_TRUE(jtc::checkStateTolerancePerJoint(error, Tolerances(0.3)));
  EXPECT_FALSE(jtc::checkStateTolerancePerJoint(error, Tolerances(0.1)));
  EXPECT_TRUE(jtc::checkStateTolerancePerJoint(error, Tolerances(0.0)));
  EXPECT_FALSE(jtc::checkStateTolerance(error, {Tolerances(0.1)}, true));
  error.position[0] = std::nan("");
  EXPECT_FALSE(jtc::checkStateTolerancePerJoint(error, Tolerances(0.3)));

  jtc::SegmentTolerances<double> all(2);
  all.state_tolerance[1] = Tolerances(1, 2, 3);
  all.goal_time_tolerance = 4;
  control_msgs::FollowJointTrajectoryGoal goal;
  goal.path_tolerance.resize(2);
  goal.path_tolerance[0].name = "b";
  goal.path_tolerance[0].position = 0.5;
  goal.path_tolerance[0].velocity = -1.0;
  goal.path_tolerance[1].name = "unknown";
  goal.goal_time_tolerance = ros::Duration(-1.0);
  jtc::updateSegmentTolerances(goal, {"a", "b"}, all);
  EXPECT_EQ(0.5, all.state_tolerance[1].position);
  EXPECT_EQ(0.0, all.state_tolerance[1].velocity);
  EXPECT_EQ(3.0, all.state_tolerance[1].acceleration);
  EXPECT_EQ(0.0, all.goal_time_tolerance);
  goal.goal_time_tolerance = ros::Duration(5.0);
  jtc::updateSegmentTolerances(goal, {"a", "b"}, all);
  EXPECT_EQ(5.0, all.goal_time_tolerance);
}

}  // namespace
