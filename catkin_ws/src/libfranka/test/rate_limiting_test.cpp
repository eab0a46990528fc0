// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/joint_velocity_limits.h>
#include <franka/rate_limiting.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>
#include <stdexcept>

#include "off_rotation.h"

namespace {

using franka::kDeltaT;
using franka::limitRate;
using Six = std::array<double, 6>;
using Seven = std::array<double, 7>;
using Pose = std::array<double, 16>;

constexpr double kV = 2.0, kA = 10.0, kJ = 5000.0;
constexpr double kNotANumber = std::numeric_limits<double>::quiet_NaN();
// Rounding of a difference quotient over 1 ms, twice.
constexpr double kRounding = 1e-8;

Pose identity() { return {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}; }

TEST(LimitRate, TorquesChangeNoFasterThanAllowed) {
  Seven rates;
  rates.fill(1000.0);
  const Seven last{1, 1, 1, 1, 1, 1, 1};
  const Seven limited = limitRate(rates, {1.5, 3.0, -3.0, 1.0, 2.0, 0.0, 1.25}, last);
  const Seven expected{1.5, 2.0, 0.0, 1.0, 2.0, 0.0, 1.25};
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_DOUBLE_EQ(expected[i], limited[i]) << i;
  }
  EXPECT_THROW(limitRate(rates, Seven{0, 0, 0, kNotANumber, 0, 0, 0}, last), std::invalid_argument);
}

// A step to a velocity beyond the limit: first jerk, then acceleration, then velocity limits apply,
// and the limit is reached without overshoot.
TEST(LimitRate, FollowsAStepWithinAllDerivatives) {
  for (double desired : {5.0, -5.0, 1.0}) {
    double v = 0.0, a = 0.0;
    for (int k = 0; k < 2000; k++) {
      const double next = limitRate(kV, kA, kJ, desired, v, a);
      const double next_a = (next - v) / kDeltaT;
      EXPECT_LE(std::abs(next), kV + 1e-12);
      EXPECT_LE(std::abs(next_a), kA + kRounding);
      EXPECT_LE(std::abs(next_a - a) / kDeltaT, kJ + 1e4 * kRounding);
      v = next;
      a = next_a;
    }
    EXPECT_NEAR(std::max(-kV, std::min(kV, desired)), v, 1e-6);
  }
}

TEST(LimitRate, PositionsAreIntegratedVelocities) {
  double p = 0.0, v = 0.0, a = 0.0;
  for (int k = 0; k < 1000; k++) {
    const double next = limitRate(kV, kA, kJ, 100.0, p, v, a);
    EXPECT_DOUBLE_EQ(p + kDeltaT * limitRate(kV, kA, kJ, (100.0 - p) / kDeltaT, v, a), next);
    const double next_v = (next - p) / kDeltaT;
    a = (next_v - v) / kDeltaT;
    v = next_v;
    p = next;
  }
  EXPECT_NEAR(kV, v, 1e-6);
  EXPECT_THROW(limitRate(kV, kA, kJ, kNotANumber, 0.0, 0.0, 0.0), std::invalid_argument);
}

TEST(LimitRate, JointsAreLimitedOneByOne) {
  Seven v, a, j, zero{};
  v.fill(kV);
  a.fill(kA);
  j.fill(kJ);
  v[3] = 1e-4;
  const Seven desired{5, -5, 0.001, 5, 0, 0.01, -0.01};
  const Seven limited = limitRate(v, a, j, desired, zero, zero);
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_EQ(limitRate(v[i], a[i], j[i], desired[i], 0.0, 0.0), limited[i]);
  }
  EXPECT_LE(limited[3], 1e-4);
  const Seven positions = limitRate(v, a, j, desired, zero, zero, zero);
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_EQ(limitRate(v[i], a[i], j[i], desired[i], 0.0, 0.0, 0.0), positions[i]);
  }
}

// Linear and angular part each along its own line, bounded by norm.
TEST(LimitRate, TwistsAreBoundedByNorm) {
  const Six desired{3.0, 4.0, 0.0, 0.0, -6.0, 8.0};
  Six v{}, a{};
  for (int k = 0; k < 2000; k++) {
    const Six next = limitRate(kV, kA, kJ, 1.0, 20.0, 8000.0, desired, v, a);
    Six next_a, jerk;
    for (std::size_t i = 0; i < 6; i++) {
      next_a[i] = (next[i] - v[i]) / kDeltaT;
      jerk[i] = (next_a[i] - a[i]) / kDeltaT;
    }
    const auto norm = [](const Six& x, std::size_t at) {
      return std::hypot(x[at], x[at + 1], x[at + 2]);
    };
    EXPECT_LE(norm(next, 0), kV + 1e-12);
    EXPECT_LE(norm(next_a, 0), kA + kRounding);
    EXPECT_LE(norm(jerk, 0), kJ + 1e4 * kRounding);
    EXPECT_LE(norm(next, 3), 1.0 + 1e-12);
    EXPECT_LE(norm(next_a, 3), 20.0 + kRounding);
    EXPECT_LE(norm(jerk, 3), 8000.0 + 1e4 * kRounding);
    v = next;
    a = next_a;
  }
  EXPECT_NEAR(0.6 * kV, v[0], 1e-6);
  EXPECT_NEAR(0.8 * kV, v[1], 1e-6);
  EXPECT_NEAR(-0.6, v[4], 1e-6);
  EXPECT_NEAR(0.8, v[5], 1e-6);
  EXPECT_EQ(Six{}, limitRate(kV, kA, kJ, kV, kA, kJ, Six{}, Six{}, Six{}));
  EXPECT_THROW(limitRate(kV, kA, kJ, kV, kA, kJ, Six{0, 0, 0, 0, 0, kNotANumber}, Six{}, Six{}),
               std::invalid_argument);
}

TEST(LimitRate, PosesFollowAtTheAllowedTwist) {
  Pose desired = identity();
  Eigen::Map<Eigen::Matrix4d> target(desired.data());
  target.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, 2) / 3.0).toRotationMatrix();
  target.topRightCorner<3, 1>() << 10.0, 0.0, 0.0;
  Pose pose = identity();
  Six v{}, a{};
  for (int k = 0; k < 600; k++) {
    const Pose next = limitRate(kV, kA, kJ, 1.0, 20.0, 8000.0, desired, pose, v, a);
    const Eigen::Map<const Eigen::Matrix4d> from(pose.data()), to(next.data());
    const Eigen::AngleAxisd step(
        Eigen::Matrix3d(to.topLeftCorner<3, 3>() * from.topLeftCorner<3, 3>().transpose()));
    const Eigen::Vector3d w = step.angle() / kDeltaT * step.axis();
    const Six next_v{(next[12] - pose[12]) / kDeltaT, 0.0, 0.0, w.x(), w.y(), w.z()};
    for (std::size_t i = 0; i < 6; i++) {
      a[i] = (next_v[i] - v[i]) / kDeltaT;
    }
    v = next_v;
    pose = next;
    EXPECT_LE(w.norm(), 0.99 * 1.0 + kRounding);
  }
  EXPECT_NEAR(kV, v[0], 1e-6);
  // At full speed about the desired axis, at 99 % of the rotational limit.
  EXPECT_NEAR(0.99 / 3.0, v[3], 1e-6);
  EXPECT_NEAR(0.99 * 2.0 / 3.0, v[4], 1e-6);
  const Eigen::Map<const Eigen::Matrix4d> end(pose.data());
  EXPECT_LT((end.topLeftCorner<3, 3>() * end.topLeftCorner<3, 3>().transpose() -
             Eigen::Matrix3d::Identity())
                .norm(),
            1e-12);
}

TEST(LimitRate, RefusesInvalidPoses) {
  Pose wrong = identity();
  wrong[0] = 1.1;
  EXPECT_THROW(limitRate(kV, kA, kJ, kV, kA, kJ, wrong, identity(), Six{}, Six{}),
               std::invalid_argument);
  wrong[0] = kNotANumber;
  EXPECT_THROW(limitRate(kV, kA, kJ, kV, kA, kJ, wrong, identity(), Six{}, Six{}),
               std::invalid_argument);
  EXPECT_EQ(identity(), limitRate(kV, kA, kJ, kV, kA, kJ, identity(), identity(), Six{}, Six{}));
}

// The functions of libfranka 0.11 and later, which have separate lower velocity limits; the numbers
// are results of 0.21.2 for these arguments.
TEST(LimitRate, VelocitiesAndPositionsStayBetweenTwoVelocityLimits) {
  EXPECT_DOUBLE_EQ(-0.948001, limitRate(2.0, -1.0, 9.9, 4999.0, -0.5, -0.95, -3.0));
  EXPECT_DOUBLE_EQ(0.409042001, limitRate(2.0, -1.0, 9.9, 4999.0, 0.4, 0.41, -0.95, -3.0));
  // Beyond a joint's lower end the lower limit is only the margin.
  EXPECT_DOUBLE_EQ(-0.098505151515151518, limitRate(2.0, 0.001, 9.9, 4999.0, -0.5, -0.2, 0.0));
  EXPECT_THROW(limitRate(2.0, -1.0, 9.9, 4999.0, kNotANumber, 0.0, 0.0), std::invalid_argument);
  EXPECT_THROW(limitRate(2.0, -1.0, 9.9, 4999.0, kNotANumber, 0.0, 0.0, 0.0),
               std::invalid_argument);
}

TEST(LimitRate, SevenJointsStayBetweenTwoVelocityLimits) {
  const Seven q{2.8, 0.0, 0.0, -1.5,
                0.0, 0.5, 0.0};  // joint 1 near its upper, 6 beyond its lower end
  const Seven upper = franka::computeUpperLimitsJointVelocity(q);
  const Seven lower = franka::computeLowerLimitsJointVelocity(q);
  const Seven acceleration = {9.9, 9.9, 9.9, 9.9, 9.9, 9.9, 9.9};
  const Seven jerk = {4999, 4999, 4999, 4999, 4999, 4999, 4999};
  const Seven desired{1.0, -1.0, 0.1, -0.1, 5.0, -5.0, 0.0};
  const Seven last{0.1, -0.2, 0.1, -0.1, 1.0, -0.2, 0.3};
  const Seven last_a{1.0, -1.0, 0.0, 0.5, 0.0, 0.0, -2.0};
  const Seven velocities = limitRate(upper, lower, acceleration, jerk, desired, last, last_a);
  Seven positions{};
  for (std::size_t i = 0; i < 7; i++) {
    positions[i] = q[i] + desired[i] * kDeltaT;
  }
  const Seven limited = limitRate(upper, lower, acceleration, jerk, positions, q, last, last_a);
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_EQ(limitRate(upper[i], lower[i], 9.9, 4999.0, desired[i], last[i], last_a[i]),
              velocities[i])
        << i;
    EXPECT_NEAR(q[i] + velocities[i] * kDeltaT, limited[i], 1e-15) << i;
  }
  EXPECT_THROW(limitRate(upper, lower, acceleration, jerk, Seven{kNotANumber}, last, last_a),
               std::invalid_argument);
  EXPECT_THROW(limitRate(upper, lower, acceleration, jerk, Seven{kNotANumber}, q, last, last_a),
               std::invalid_argument);
}

// min(V, max(0, sqrt(c (q_max - q)) - o)) - 0.001 and its mirror, by hand.
TEST(JointVelocityLimits, OfAnFr3ShrinkTowardsTheEnds) {
  const Seven q{2.5, 0.0, 0.0, -0.2, 3.0, 4.4, 0.0};
  const Seven upper = franka::computeUpperLimitsJointVelocity(q);
  EXPECT_NEAR(std::sqrt(12.0 * (2.7501 - 2.5)) - 0.30 - 0.001, upper[0], 1e-12);
  EXPECT_NEAR(2.62 - 0.001, upper[1], 1e-12);
  EXPECT_NEAR(std::sqrt(8.0 * (-0.1458 + 0.2)) - 0.30 - 0.001, upper[3], 1e-12);
  EXPECT_NEAR(-0.001, upper[4], 1e-12);
  EXPECT_NEAR(std::sqrt(11.0 * (4.5205 - 4.4)) - 0.35 - 0.001, upper[5], 1e-12);
  const Seven lower = franka::computeLowerLimitsJointVelocity({-2.5, 0, 0, -3.0, 0, 0.6, 0});
  EXPECT_NEAR(0.30 - std::sqrt(12.0 * (2.7501 - 2.5)) + 0.001, lower[0], 1e-12);
  EXPECT_NEAR(-2.62 + 0.001, lower[2], 1e-12);
  EXPECT_NEAR(0.30 - std::sqrt(8.0 * (3.0481 - 3.0)) + 0.001, lower[3], 1e-12);
  EXPECT_NEAR(0.35 - std::sqrt(11.0 * (0.6 - 0.54092)) + 0.001, lower[5], 1e-12);
}

// Numbers are results of libfranka 0.21.2 for the limits of the public tables.
TEST(JointVelocityLimits, AreReadFromADescription) {
  const Seven velocity{2.62, 2.62, 2.62, 2.62, 5.26, 4.18, 5.26};
  const Seven offset{0.6599, 0.2517, 0.2, 0.3533, 0.5757, 0.4878, 0.4628};
  const Seven deceleration{6, 2.585, 3.5, 4, 17, 5.5, 17};
  const Seven low{-2.9007, -1.8361, -2.9007, -3.0770, -2.8763, 0.4398, -3.0508};
  const Seven high{2.9007, 1.8361, 2.9007, -0.1169, 2.8763, 4.6216, 3.0508};
  std::ostringstream urdf;
  urdf << "<robot name='fr3'>";
  for (int i = 0; i < 7; i++) {
    urdf << "<joint name='fr3_joint" << i + 1 << "' type='revolute'><limit lower='" << low[i]
         << "' upper='" << high[i] << "' velocity='" << velocity[i] << "' effort='87'/>"
         << "<position_based_velocity_limits velocity_offset='" << offset[i]
         << "' deceleration_limit='" << deceleration[i] << "'/></joint>";
  }
  urdf << "</robot>";
  franka::JointVelocityLimitsConfig limits(urdf.str());
  const Seven upper = limits.getUpperJointVelocityLimits({2.8, 1.8, 2.85, -0.13, 2.8, 4.6, 3.0});
  const Seven expected{
      0.438372486692905, 0.179315046034279, 0.394734840344259, -0.001, 1.03395204187621, -0.001,
      0.850429812475735};
  const Seven lower = limits.getLowerJointVelocityLimits({0, 0, 0, -1.5, 0, 1.5, 0});
  const Seven lowest{-2.619, -2.619, -2.619, -2.619, -5.259, -2.92619633967593, -5.259};
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_NEAR(expected[i], upper[i], 1e-13) << i;
    EXPECT_NEAR(lowest[i], lower[i], 1e-13) << i;
  }
  EXPECT_THROW(limits.parseFromURDF("<robot name='fr3'/>"), std::runtime_error);
  std::string incomplete = urdf.str();
  incomplete.replace(incomplete.rfind("deceleration_limit"), 1, "x");
  EXPECT_THROW(limits.parseFromURDF(incomplete), std::runtime_error);
  EXPECT_THROW(franka::JointVelocityLimitsConfig("<robot"), std::runtime_error);
  EXPECT_EQ(upper, limits.getUpperJointVelocityLimits({2.8, 1.8, 2.85, -0.13, 2.8, 4.6, 3.0}));
}

// As observed with libfranka 0.9.2 and 0.21.2, also without rotation.
TEST(LimitRate, PosesCountAsTheirNearestRotation) {
  OffRotations off(5e-6);
  const Six rest{};
  for (int i = 0; i < 100; i++) {
    const Pose last = off.pose();
    const Pose still = limitRate(3.0, 9.0, 4500.0, 2.5, 17.0, 8500.0, last, last, rest, rest);
    EXPECT_LT(distance(polarFactor(last), still), 1e-13) << i;
    const Pose desired = off.pose();
    const Pose there = limitRate(1e9, 1e12, 1e15, 1e9, 1e12, 1e15, desired, last, rest, rest);
    EXPECT_LT(distance(polarFactor(desired), there), 1e-12) << i;
  }
}

}  // namespace
