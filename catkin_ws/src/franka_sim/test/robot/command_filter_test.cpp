// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Low-pass filters of signals and of commands.
#include <franka_sim/robot/command_filter.h>
#include <franka_sim/robot/low_pass.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>

namespace franka_sim::test {

namespace {

TEST(LowPass, HasTheFirstOrderGainAndReachesItsInput) {
  LowPass<1> filter(100.0);
  EXPECT_NEAR(0.385869545, filter.update({{1.0}})[0], 1e-9);  // T / (T + 1 / (2 pi 100))
  for (int i = 0; i < 100; i++) {
    filter.update({{1.0}});
  }
  EXPECT_NEAR(1.0, filter.output()[0], 1e-12);
  filter.restart();
  EXPECT_EQ(0.0, filter.output()[0]);
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
