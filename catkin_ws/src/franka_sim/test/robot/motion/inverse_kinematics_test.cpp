// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Inverse kinematics against the forward kinematics of ArmModel, and its behavior near
// singularities.
#include "robot/motion/inverse_kinematics.h"

#include <gtest/gtest.h>

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <random>

#include "motion_fixture.h"

namespace franka_sim::test {

namespace {

using franka_core::ArmFrame;

/// The Jacobian with a row for joint 3.
Eigen::MatrixXd jacobianOf(const Joints& q) {
  Eigen::Matrix<double, 7, 7> matrix = Eigen::Matrix<double, 7, 7>::Zero();
  const auto jacobian = model().zeroJacobian(ArmFrame::kEndEffector, q, kHandF_T_NE);
  matrix.topRows<6>() = Eigen::Map<const Eigen::Matrix<double, 6, 7>>(jacobian.data());
  matrix(6, 2) = 1.0;
  return matrix;
}

/// By another decomposition than the tested one.
double smallestSingularValue(const Joints& q) {
  return Eigen::JacobiSVD<Eigen::MatrixXd>(jacobianOf(q)).singularValues()(6);
}

Joints randomPose(std::mt19937& engine) {
  Joints q{};
  const auto& limits = franka_core::kFerLimits;
  for (std::size_t i = 0; i < 7; i++) {
    q[i] = std::uniform_real_distribution<double>(limits.q_min[i], limits.q_max[i])(engine);
  }
  return q;
}

TEST(InverseKinematics, RecoversTheJointsOfAPoseExactly) {
  std::mt19937 engine(1);
  int solved = 0;
  for (int i = 0; i < 5000; i++) {
    const Joints q = randomPose(engine);
    if (smallestSingularValue(q) < 0.05) {
      continue;
    }
    solved++;
    Joints near = q;  // one tick away, at a few rad/s
    for (double& value : near) {
      value += std::uniform_real_distribution<double>(-2e-3, 2e-3)(engine);
    }
    const auto solution = InverseKinematics::solve(near, forward(q), q[2], kHandF_T_NE, model());
    ASSERT_FALSE(solution.near_singularity);
    EXPECT_LT(largestDifference(forward(q), solution.O_T_EE), 1e-12);
    EXPECT_EQ(forward(solution.q), solution.O_T_EE);
    EXPECT_LT(largestDifference(q, solution.q), 1e-10);
    EXPECT_NEAR(q[2], solution.q[2], 1e-12);
  }
  EXPECT_GT(solved, 1000);
}

TEST(InverseKinematics, RefusesSingularStartPoses) {
  std::mt19937 engine(2);
  int singular = 0;
  for (int i = 0; i < 20000; i++) {
    const Joints q = randomPose(engine);
    const double sigma = smallestSingularValue(q);
    if (std::abs(sigma - 0.01) < 1e-6) {
      continue;
    }
    EXPECT_EQ(sigma < 0.01, InverseKinematics::isSingular(q, kHandF_T_NE, model())) << sigma;
    singular += sigma < 0.01 ? 1 : 0;
  }
  EXPECT_GT(singular, 100);
}

TEST(InverseKinematics, TakesOneDampedStepNearASingularity) {
  // On the way to the stretched arm.
  Joints q = kReady;
  for (q[3] = -1.5; smallestSingularValue(q) > 0.015; q[3] += 1e-3) {
    ASSERT_LT(q[3], 0.5);
  }
  const double sigma = smallestSingularValue(q);
  ASSERT_GT(sigma, 0.005);
  Transform desired = forward(q);
  desired[12] += 1e-4;
  const auto solution = InverseKinematics::solve(q, desired, q[2], kHandF_T_NE, model());
  EXPECT_TRUE(solution.near_singularity);
  // Closed form by another decomposition: q += sum v s / (s^2 + lambda^2) (u . e).
  Eigen::JacobiSVD<Eigen::MatrixXd> svd(jacobianOf(q), Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::VectorXd error = Eigen::VectorXd::Zero(7);
  error[0] = 1e-4;
  const double damping = (1.0 - std::pow(sigma / 0.02, 2)) * 0.02 * 0.02;
  Eigen::VectorXd step = svd.matrixU().transpose() * error;
  for (int i = 0; i < 7; i++) {
    const double s = svd.singularValues()[i];
    step[i] *= s / (s * s + damping);
  }
  step = svd.matrixV() * step;
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_NEAR(q[i] + step[static_cast<int>(i)], solution.q[i], 1e-9);
  }
}

}  // namespace

}  // namespace franka_sim::test
