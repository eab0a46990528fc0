// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <joint_limits_interface/joint_limits_interface.h>
#include <rt_guard/rt_guard.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>

using namespace joint_limits_interface;
using hardware_interface::JointHandle;
using hardware_interface::JointStateHandle;

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kDt = 0.001;
constexpr double kTight = 1e-12;
const ros::Duration kPeriod(kDt);

/// The median of three: the meaning of saturation, without min and max.
double middle(double a, double b, double c) {
  std::array<double, 3> sorted{a, b, c};
  std::sort(sorted.begin(), sorted.end());
  return sorted[1];
}

class Limits : public testing::Test {
 protected:
  Limits() {
    limits_.has_position_limits = limits_.has_velocity_limits = limits_.has_effort_limits = true;
    limits_.min_position = -1.0;
    limits_.max_position = 2.0;
    limits_.max_velocity = 3.0;
    limits_.max_acceleration = 50.0;
    limits_.max_effort = 40.0;
    soft_.min_position = -0.8;
    soft_.max_position = 1.7;
    soft_.k_position = 20.0;
    soft_.k_velocity = 10.0;
  }

  /// A command limited by a handle.
  template <class Handle>
  double limited(Handle& handle, double command) {
    cmd_ = command;
    handle.enforceLimits(kPeriod);
    return cmd_;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random_);
  }

  /// Bounds of the velocity at a position, from the specification's table.
  double lowestVelocity(double q) const {
    return middle(-soft_.k_position * (q - soft_.min_position), -limits_.max_velocity,
                  limits_.max_velocity);
  }
  double highestVelocity(double q) const {
    return middle(-soft_.k_position * (q - soft_.max_position), -limits_.max_velocity,
                  limits_.max_velocity);
  }

  double pos_{0.0}, vel_{0.0}, eff_{0.0}, cmd_{0.0};
  JointHandle joint_{JointStateHandle("joint", &pos_, &vel_, &eff_), &cmd_};
  JointLimits limits_;
  SoftJointLimits soft_;
  std::mt19937 random_{1};
};

// gtest runs suites with such names first.
using LimitsDeathTest = Limits;

}  // namespace

TEST(Saturate, IsTheMedianOfThree) {
  EXPECT_EQ(2.0, internal::saturate(2.0, 1.0, 3.0));
  EXPECT_EQ(1.0, internal::saturate(0.0, 1.0, 3.0));
  EXPECT_EQ(3.0, internal::saturate(kInf, 1.0, 3.0));
  EXPECT_EQ(1.0, internal::saturate(2.0, 3.0, 1.0)) << "crossed bounds: the upper one";
  EXPECT_TRUE(std::isnan(internal::saturate(kNan, 1.0, 3.0)));
}

// ---- position, saturation ----

TEST_F(Limits, PositionSaturationWithoutLimitsHasNoEffect) {
  PositionJointSaturationHandle handle(joint_, JointLimits());
  EXPECT_EQ("joint", handle.getName());
  for (const double command : {0.0, -1e300, 1e300, 5.0}) {
    EXPECT_EQ(command, limited(handle, command));
  }
}

TEST_F(Limits, PositionSaturationWithoutVelocityLimitsClipsToTheRange) {
  limits_.has_velocity_limits = false;
  PositionJointSaturationHandle handle(joint_, limits_);
  EXPECT_EQ(-1.0, limited(handle, -1.5));
  EXPECT_EQ(2.0, limited(handle, 2.5));
  EXPECT_EQ(1.5, limited(handle, 1.5));
}

TEST_F(Limits, PositionSaturationFollowsAStepAtTheGreatestVelocity) {
  pos_ = 0.25;
  PositionJointSaturationHandle handle(joint_, limits_);
  for (int k = 1; k <= 1000; ++k) {
    const double closed_form = std::min(0.25 + k * 3.0 * kDt, 2.0);
    ASSERT_NEAR(closed_form, limited(handle, 10.0), kTight) << k;
  }
  for (int k = 1; k <= 1500; ++k) {
    const double closed_form = std::max(2.0 - k * 3.0 * kDt, -1.0);
    ASSERT_NEAR(closed_form, limited(handle, -10.0), kTight) << k;
  }
}

TEST_F(Limits, PositionHandlesStartAtTheMeasuredPositionAlsoAfterReset) {
  PositionJointSaturationHandle hard(joint_, limits_);
  pos_ = 0.5;
  EXPECT_NEAR(0.503, limited(hard, 1.0), kTight);
  pos_ = -0.5;
  EXPECT_NEAR(0.506, limited(hard, 1.0), kTight) << "the command before counts, not the position";
  hard.reset();
  EXPECT_NEAR(-0.497, limited(hard, 1.0), kTight);

  PositionJointSoftLimitsHandle soft(joint_, limits_, soft_);
  pos_ = 0.5;
  EXPECT_NEAR(0.503, limited(soft, 1.0), kTight);
  pos_ = -0.5;
  EXPECT_NEAR(0.506, limited(soft, 1.0), kTight);
  soft.reset();
  EXPECT_NEAR(-0.497, limited(soft, 1.0), kTight);
}

// ---- position, soft limits ----

TEST_F(Limits, PositionSoftLimitsApproachTheLimitExponentially) {
  pos_ = 1.7 - 0.1;  // 20/s * 0.1 rad = 2 rad/s, below the velocity limit
  PositionJointSoftLimitsHandle handle(joint_, limits_, soft_);
  for (int k = 1; k <= 500; ++k) {
    const double closed_form = 1.7 - 0.1 * std::pow(1.0 - 20.0 * kDt, k);
    ASSERT_NEAR(closed_form, limited(handle, 10.0), kTight) << k;
  }
}

TEST_F(Limits, PositionSoftLimitsMatchTheTable) {
  for (int i = 0; i < 5000; ++i) {
    pos_ = uniform(-1.5, 2.5);
    const double command = uniform(-3.0, 4.0);
    PositionJointSoftLimitsHandle handle(joint_, limits_, soft_);
    const double low = std::max(pos_ + lowestVelocity(pos_) * kDt, limits_.min_position);
    const double high = std::min(pos_ + highestVelocity(pos_) * kDt, limits_.max_position);
    const double expected = low > high ? high : middle(command, low, high);
    ASSERT_NEAR(expected, limited(handle, command), kTight) << pos_ << " " << command;
  }
}

TEST_F(Limits, PositionSoftLimitsBeyondTheHardOnesDoNotWidenThem) {
  soft_.min_position = -9.0;
  soft_.max_position = 9.0;
  PositionJointSoftLimitsHandle handle(joint_, limits_, soft_);
  pos_ = 1.999;
  EXPECT_EQ(2.0, limited(handle, 10.0));
  pos_ = -0.999;
  handle.reset();
  EXPECT_EQ(-1.0, limited(handle, -10.0));
}

TEST_F(Limits, PositionSoftLimitsWithoutPositionLimitsOnlyLimitTheVelocity) {
  limits_.has_position_limits = false;
  pos_ = 5.0;
  PositionJointSoftLimitsHandle handle(joint_, limits_, soft_);
  EXPECT_NEAR(5.003, limited(handle, 9.0), kTight);
  EXPECT_NEAR(5.0, limited(handle, -9.0), kTight);
}

// ---- effort ----

TEST_F(Limits, EffortSaturationMatchesTheTable) {
  EffortJointSaturationHandle handle(joint_, limits_);
  for (int i = 0; i < 5000; ++i) {
    pos_ = uniform(-1.5, 2.5);
    vel_ = uniform(-4.0, 4.0);
    const double command = uniform(-60.0, 60.0);
    const bool may_push_down = pos_ >= -1.0 && vel_ >= -3.0;
    const bool may_push_up = pos_ <= 2.0 && vel_ <= 3.0;
    const double expected = middle(command, may_push_down ? -40.0 : 0.0, may_push_up ? 40.0 : 0.0);
    ASSERT_EQ(expected, limited(handle, command)) << pos_ << " " << vel_ << " " << command;
  }
  limits_.has_position_limits = false;
  EffortJointSaturationHandle endless(joint_, limits_);
  pos_ = 100.0;
  vel_ = 0.0;
  EXPECT_EQ(40.0, limited(endless, 50.0));
}

TEST_F(Limits, EffortSoftLimitsMatchTheTable) {
  EffortJointSoftLimitsHandle handle(joint_, limits_, soft_);
  for (int i = 0; i < 5000; ++i) {
    pos_ = uniform(-1.5, 2.5);
    vel_ = uniform(-4.0, 4.0);
    const double command = uniform(-60.0, 60.0);
    const double low = middle(10.0 * (lowestVelocity(pos_) - vel_), -40.0, 40.0);
    const double high = middle(10.0 * (highestVelocity(pos_) - vel_), -40.0, 40.0);
    ASSERT_NEAR(middle(command, low, high), limited(handle, command), kTight);
  }
}

// ---- velocity ----

TEST_F(Limits, VelocitySaturationClips) {
  VelocityJointSaturationHandle handle(joint_, limits_);
  EXPECT_EQ(3.0, limited(handle, 5.0));
  EXPECT_EQ(-3.0, limited(handle, -5.0));
  EXPECT_EQ(1.0, limited(handle, 1.0));
}

TEST_F(Limits, VelocitySaturationRampsAtTheGreatestAcceleration) {
  limits_.has_acceleration_limits = true;
  vel_ = 2.0;  // has no effect
  VelocityJointSaturationHandle handle(joint_, limits_);
  for (int k = 1; k <= 100; ++k) {
    ASSERT_NEAR(std::min(k * 50.0 * kDt, 3.0), limited(handle, 5.0), kTight) << k;
  }
  for (int k = 1; k <= 200; ++k) {
    ASSERT_NEAR(std::max(3.0 - k * 50.0 * kDt, -3.0), limited(handle, -5.0), kTight) << k;
  }
}

TEST_F(Limits, VelocitySoftLimitsMatchTheTable) {
  for (int i = 0; i < 5000; ++i) {
    limits_.has_acceleration_limits = i % 2 == 0;
    VelocityJointSoftLimitsHandle handle(joint_, limits_, soft_);
    pos_ = uniform(-1.5, 2.5);
    vel_ = uniform(-3.0, 3.0);
    const double command = uniform(-5.0, 5.0);
    double low = lowestVelocity(pos_);
    double high = highestVelocity(pos_);
    if (limits_.has_acceleration_limits) {
      low = std::max(low, vel_ - 50.0 * kDt);
      high = std::min(high, vel_ + 50.0 * kDt);
    }
    const double expected = low > high ? high : middle(command, low, high);
    ASSERT_NEAR(expected, limited(handle, command), kTight) << pos_ << " " << vel_;
  }
}

TEST_F(Limits, VelocitySoftLimitsNeedNoLimitsAtAll) {
  VelocityJointSoftLimitsHandle handle(joint_, JointLimits(), soft_);
  EXPECT_EQ(1e6, limited(handle, 1e6));
}

// ---- all ----

TEST_F(Limits, NanCommandPassesAndIsNotStored) {
  limits_.has_acceleration_limits = true;
  PositionJointSaturationHandle position(joint_, limits_);
  PositionJointSoftLimitsHandle position_soft(joint_, limits_, soft_);
  VelocityJointSaturationHandle velocity(joint_, limits_);
  EXPECT_NEAR(0.003, limited(position, 1.0), kTight);
  EXPECT_TRUE(std::isnan(limited(position, kNan)));
  EXPECT_NEAR(0.006, limited(position, 1.0), kTight);
  EXPECT_NEAR(0.003, limited(position_soft, 1.0), kTight);
  EXPECT_TRUE(std::isnan(limited(position_soft, kNan)));
  EXPECT_NEAR(0.006, limited(position_soft, 1.0), kTight);
  EXPECT_NEAR(0.05, limited(velocity, 1.0), kTight);
  EXPECT_TRUE(std::isnan(limited(velocity, kNan)));
  EXPECT_NEAR(0.1, limited(velocity, 1.0), kTight);
  EXPECT_NEAR(0.1 - 0.05, limited(velocity, -kInf), kTight);
}

TEST_F(Limits, MissingLimitsAreRefused) {
  using Error = JointLimitsInterfaceException;
  JointLimits only_effort;
  only_effort.has_effort_limits = true;
  EXPECT_THROW(PositionJointSoftLimitsHandle(joint_, only_effort, soft_), Error);
  EXPECT_THROW(EffortJointSaturationHandle(joint_, only_effort), Error);
  EXPECT_THROW(EffortJointSoftLimitsHandle(joint_, only_effort, soft_), Error);
  EXPECT_THROW(VelocityJointSaturationHandle(joint_, only_effort), Error);
  JointLimits only_velocity;
  only_velocity.has_velocity_limits = true;
  EXPECT_THROW(EffortJointSaturationHandle(joint_, only_velocity), Error);
  EXPECT_THROW(EffortJointSoftLimitsHandle(joint_, only_velocity, soft_), Error);
}

TEST_F(LimitsDeathTest, ZeroPeriodAsserts) {
  limits_.has_acceleration_limits = true;
  PositionJointSoftLimitsHandle position(joint_, limits_, soft_);
  VelocityJointSaturationHandle velocity(joint_, limits_);
  EXPECT_DEATH(position.enforceLimits(ros::Duration(0.0)), ".*");
  EXPECT_DEATH(velocity.enforceLimits(ros::Duration(0.0)), ".*");
}

TEST_F(Limits, InterfaceLimitsAllJointsWithoutAllocating) {
  double other_cmd = 0.0;
  const JointHandle other(JointStateHandle("other", &pos_, &vel_, &eff_), &other_cmd);
  PositionJointSoftLimitsInterface positions;
  PositionJointSaturationInterface saturated;
  EffortJointSoftLimitsInterface efforts;
  EffortJointSaturationInterface efforts_hard;
  VelocityJointSaturationInterface velocities;
  VelocityJointSoftLimitsInterface velocities_soft;
  positions.registerHandle({joint_, limits_, soft_});
  positions.registerHandle({other, limits_, soft_});
  saturated.registerHandle({other, limits_});
  efforts.registerHandle({other, limits_, soft_});
  efforts_hard.registerHandle({other, limits_});
  velocities.registerHandle({other, limits_});
  velocities_soft.registerHandle({other, limits_, soft_});

  EXPECT_EQ("other", positions.getHandle("other").getName());
  EXPECT_THROW(positions.getHandle("nobody"), JointLimitsInterfaceException);

  cmd_ = other_cmd = 1.0;
  positions.enforceLimits(kPeriod);
  EXPECT_NEAR(0.003, cmd_, kTight);
  EXPECT_NEAR(0.003, other_cmd, kTight);
  pos_ = 1.0;
  cmd_ = 2.0;
  positions.reset();
  positions.enforceLimits(kPeriod);
  EXPECT_NEAR(1.003, cmd_, kTight);
  other_cmd = 2.0;
  saturated.enforceLimits(kPeriod);
  EXPECT_NEAR(1.003, other_cmd, kTight);
  pos_ = 0.0;
  other_cmd = 2.0;
  saturated.reset();
  saturated.enforceLimits(kPeriod);
  EXPECT_NEAR(0.003, other_cmd, kTight);

  rt_guard::Scope scope;
  for (int i = 0; i < 100; ++i) {
    positions.enforceLimits(kPeriod);
    positions.reset();
    saturated.enforceLimits(kPeriod);
    efforts.enforceLimits(kPeriod);
    efforts_hard.enforceLimits(kPeriod);
    velocities.enforceLimits(kPeriod);
    velocities_soft.enforceLimits(kPeriod);
  }
  EXPECT_EQ(0u, scope.allocations());
  EXPECT_EQ(0u, scope.locks());
}
