// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/lowpass_filter.h>
#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "off_rotation.h"

namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

std::array<double, 16> poseAt(double angle, const Eigen::Vector3d& axis, const Eigen::Vector3d& p) {
  std::array<double, 16> pose{};
  Eigen::Map<Eigen::Matrix4d> t(pose.data());
  t.setIdentity();
  t.topLeftCorner<3, 3>() = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
  t.topRightCorner<3, 1>() = p;
  return pose;
}

// g = 0.001 / (0.001 + 1 / (2 pi 100)) = 0.38586954509503757.
TEST(LowpassFilter, MovesByItsGain) {
  EXPECT_NEAR(0.38586954509503757, franka::lowpassFilter(0.001, 1.0, 0.0, 100.0), 1e-15);
  EXPECT_NEAR(2.0 - 0.38586954509503757, franka::lowpassFilter(0.001, 1.0, 2.0, 100.0), 1e-15);
  EXPECT_EQ(2.0, franka::lowpassFilter(0.0, 1.0, 2.0, 100.0));
}

TEST(LowpassFilter, RefusesInvalidArguments) {
  for (double time : {-0.001, kNan, kInfinity}) {
    EXPECT_THROW(franka::lowpassFilter(time, 1.0, 1.0, 100.0), std::invalid_argument);
  }
  for (double frequency : {0.0, -1.0, kNan, kInfinity}) {
    EXPECT_THROW(franka::lowpassFilter(0.001, 1.0, 1.0, frequency), std::invalid_argument);
  }
  EXPECT_THROW(franka::lowpassFilter(0.001, kNan, 1.0, 100.0), std::invalid_argument);
  EXPECT_THROW(franka::lowpassFilter(0.001, 1.0, kInfinity, 100.0), std::invalid_argument);
  std::array<double, 16> pose = poseAt(0.0, Eigen::Vector3d::UnitX(), Eigen::Vector3d::Zero());
  std::array<double, 16> wrong = pose;
  wrong[13] = kNan;
  EXPECT_THROW(franka::cartesianLowpassFilter(0.001, wrong, pose, 100.0), std::invalid_argument);
  EXPECT_THROW(franka::cartesianLowpassFilter(0.001, pose, wrong, 100.0), std::invalid_argument);
  EXPECT_THROW(franka::cartesianLowpassFilter(0.001, pose, pose, 0.0), std::invalid_argument);
}

TEST(CartesianLowpassFilter, RotatesAboutTheSameAxisByItsGain) {
  const Eigen::Vector3d axis(0.3, -0.5, 0.8);
  const double gain = 0.38586954509503757;
  const auto last = poseAt(0.2, axis, {0.0, 0.1, 0.2});
  const auto target = poseAt(1.2, axis, {1.0, 0.1, -0.2});
  const auto expected = poseAt(0.2 + gain, axis, {gain, 0.1, 0.2 - 0.4 * gain});
  const auto filtered = franka::cartesianLowpassFilter(0.001, target, last, 100.0);
  for (std::size_t i = 0; i < 16; i++) {
    EXPECT_NEAR(expected[i], filtered[i], 1e-15) << i;
  }
}

// 170 degrees in either direction: the shorter arc crosses 180.
TEST(CartesianLowpassFilter, TakesTheShortestArc) {
  const double angle = 170.0 / 180.0 * M_PI;
  const Eigen::Vector3d z = Eigen::Vector3d::UnitZ(), origin = Eigen::Vector3d::Zero();
  const auto filtered = franka::cartesianLowpassFilter(0.001, poseAt(-angle, z, origin),
                                                       poseAt(angle, z, origin), 100.0);
  const double expected = angle + 0.38586954509503757 * 20.0 / 180.0 * M_PI;
  EXPECT_NEAR(std::cos(expected), filtered[0], 1e-14);
  EXPECT_NEAR(std::sin(expected), filtered[1], 1e-14);
}

// Matrices that are not quite orthogonal count as the nearest rotation, as observed with libfranka
// 0.9.2 and 0.21.2; the rotation of their normalized quaternion differs by up to 9e-6 rad.
TEST(CartesianLowpassFilter, TakesTheNearestRotationOfBothPoses) {
  OffRotations off(1e-5);
  for (int i = 0; i < 100; i++) {
    const auto last = off.pose();
    const auto target = off.pose();
    const auto still = franka::cartesianLowpassFilter(0.001, last, last, 100.0);
    EXPECT_LT(distance(polarFactor(last), still), 1e-13) << i;
    const auto moved = franka::cartesianLowpassFilter(0.001, target, last, 1e12);
    EXPECT_LT(distance(polarFactor(target), moved), 1e-8) << i;
  }
}

}  // namespace
