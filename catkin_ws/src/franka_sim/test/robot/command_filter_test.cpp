// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Low-pass filters of commands.
#include "robot/motion/command_filter.h"

#include <franka_core/arm_model.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace franka_sim::test {

namespace {

TEST(CommandFilter, HasACutoffOfItsOwnForEachKindOfCommand) {
  CommandFilter filter;
  ASSERT_TRUE(filter.set({10, 20, 40, 80, 160}));
  filter.begin({});
  franka_core::RobotCommand step;
  step.q_c[0] = step.dq_c[1] = step.O_dP_EE_c[2] = step.tau_J_d[3] = 1.0;
  step.O_T_EE_c = franka_core::kIdentityTransform;
  step.O_T_EE_c[12] = 1.0;
  const franka_core::RobotCommand& first = filter.apply(step);
  // x / (1 + x) with x = 2 pi f 1 ms
  EXPECT_NEAR(0.0591, first.q_c[0], 5e-5);
  EXPECT_NEAR(0.1116, first.dq_c[1], 5e-5);
  EXPECT_NEAR(0.2008, first.O_T_EE_c[12], 5e-5);
  EXPECT_NEAR(0.3345, first.O_dP_EE_c[2], 5e-5);
  EXPECT_NEAR(0.5013, first.tau_J_d[3], 5e-5);
}

// Like the client's filter: a pose that is not quite orthogonal counts as the nearest rotation.
TEST(CommandFilter, TakesTheNearestRotationOfAPose) {
  franka_core::fci::SetFiltersRequest cutoffs{1000, 1000, 100, 1000, 1000};
  franka_core::RobotState state;
  Eigen::Map<Eigen::Matrix4d> pose(state.O_T_EE_c.data());
  pose.setIdentity();
  pose.topLeftCorner<3, 3>() =
      Eigen::AngleAxisd(2.0, Eigen::Vector3d(1, 2, -1).normalized()).toRotationMatrix();
  pose(0, 1) += 8e-6;
  pose(2, 0) -= 7e-6;
  pose(1, 1) += 5e-6;
  franka_core::RobotCommand command;
  command.O_T_EE_c = state.O_T_EE_c;
  CommandFilter filter;
  ASSERT_TRUE(filter.set(cutoffs));
  filter.begin(state);
  const Eigen::Matrix4d filtered = Eigen::Matrix4d::Map(filter.apply(command).O_T_EE_c.data());
  const Eigen::Matrix3d nearest = Eigen::Affine3d(pose).rotation();
  EXPECT_LT((filtered.topLeftCorner<3, 3>() - nearest).cwiseAbs().maxCoeff(), 1e-14);
}

}  // namespace

}  // namespace franka_sim::test
