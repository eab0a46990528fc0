// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// Poses and Jacobians of all ten frames against KDL.
#include <gtest/gtest.h>

#include <algorithm>
#include <kdl/chainfksolverpos_recursive.hpp>
#include <kdl/chainjnttojacsolver.hpp>

#include "kdl_arm.h"
#include "random_state.h"

namespace franka_test {
namespace {

using franka_core::ArmFrame;
using franka_core::ArmModel;

class ArmKinematicsTest : public ::testing::TestWithParam<Arm> {
 protected:
  const std::string urdf_{readData(GetParam().file)};
  const ArmModel arm_{ArmModel::fromUrdf(urdf_, GetParam().arm_id)};
  StateSource states_{*GetParam().limits};
};

INSTANTIATE_TEST_SUITE_P(Arms, ArmKinematicsTest, ::testing::Values(kPanda, kFr3), armName);

std::size_t jointsOf(ArmFrame frame) {
  return std::min<std::size_t>(static_cast<int>(frame) + 1, 7);
}

Eigen::Matrix4d toEigen(const KDL::Frame& frame) {
  Eigen::Matrix4d t = Eigen::Matrix4d::Identity();
  for (int r = 0; r < 3; r++) {
    for (int c = 0; c < 3; c++) {
      t(r, c) = frame.M(r, c);
    }
    t(r, 3) = frame.p(r);
  }
  return t;
}

TEST_P(ArmKinematicsTest, AgreesWithKdl) {
  double pose_error = 0.0, jacobian_error = 0.0;
  std::array<KDL::Chain, 7> arms;
  for (std::size_t count = 1; count <= 7; count++) {
    arms[count - 1] = kdlArm(urdf_, GetParam().arm_id, count);
  }
  for (int n = 0; n < kStates; n++) {
    const State s = states_.next();
    for (int f = 0; f < 10; f++) {
      const auto frame = static_cast<ArmFrame>(f);
      const std::size_t count = jointsOf(frame);
      KDL::Chain chain;
      const KDL::Chain& arm = arms[count - 1];
      // KDL's chain of seven ends at the flange; joint 7 itself is the segment before.
      for (unsigned i = 0; i < arm.getNrOfSegments() - (frame == ArmFrame::kJoint7 ? 1 : 0); i++) {
        chain.addSegment(arm.getSegment(i));
      }
      if (frame >= ArmFrame::kEndEffector) {
        chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), toKdl(s.F_T_EE)));
      }
      if (frame == ArmFrame::kStiffness) {
        chain.addSegment(KDL::Segment(KDL::Joint(KDL::Joint::Fixed), toKdl(s.EE_T_K)));
      }
      KDL::JntArray q(count);
      q.data = vector(s.q).head(count);
      KDL::Frame tip;
      KDL::Jacobian expected(count);
      ASSERT_EQ(0, KDL::ChainFkSolverPos_recursive(chain).JntToCart(q, tip));
      ASSERT_EQ(0, KDL::ChainJntToJacSolver(chain).JntToJac(q, expected));
      pose_error = std::max(
          pose_error,
          (pose(arm_.pose(frame, s.q, s.F_T_EE, s.EE_T_K)) - toEigen(tip)).cwiseAbs().maxCoeff());
      const Jacobian zero = jacobian(arm_.zeroJacobian(frame, s.q, s.F_T_EE, s.EE_T_K));
      jacobian_error =
          std::max(jacobian_error, (zero.leftCols(count) - expected.data).cwiseAbs().maxCoeff());
      if (count < 7) {
        EXPECT_EQ(0.0, zero.rightCols(7 - count).cwiseAbs().maxCoeff());
      }
      // The same twists in the axes of the frame.
      Eigen::Matrix<double, 6, 6> to_body = Eigen::Matrix<double, 6, 6>::Zero();
      to_body.topLeftCorner<3, 3>() = toEigen(tip).topLeftCorner<3, 3>().transpose();
      to_body.bottomRightCorner<3, 3>() = toEigen(tip).topLeftCorner<3, 3>().transpose();
      const Jacobian body = jacobian(arm_.bodyJacobian(frame, s.q, s.F_T_EE, s.EE_T_K));
      jacobian_error = std::max(jacobian_error, (body - to_body * zero).cwiseAbs().maxCoeff());
    }
  }
  std::printf("largest difference to KDL: pose %.1e, Jacobian %.1e\n", pose_error, jacobian_error);
  EXPECT_LT(pose_error, 1e-14);
  EXPECT_LT(jacobian_error, 1e-14);
}

}  // namespace
}  // namespace franka_test
