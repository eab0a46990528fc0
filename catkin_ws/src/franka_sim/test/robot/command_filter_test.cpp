// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Low-pass filters of commands.
#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "robot/motion/motion_generator.h"

namespace franka_sim::test {

namespace {

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
