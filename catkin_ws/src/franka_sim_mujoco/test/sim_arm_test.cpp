// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Flags of contact and collision of an arm that controllers drive in the simulation.

#include <franka_sim_mujoco/sim_arm.h>
#include <gtest/gtest.h>

#include <cmath>

#include "robot/arm_fixture.h"

namespace franka_sim_mujoco {
namespace {

TEST(SimArm, FlagsFollowTheManualsFormulasForFilteredValues) {
  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  franka_sim::test::FakeArm plant(parameters.model, franka_sim::test::kReady);
  plant.payload = parameters.end_effector;
  SimArmOptions options;
  options.filter_alpha = 0.02;
  SimArm arm(parameters, plant, options);
  int contacts = 0;
  for (int i = 0; i < 1000; ++i) {
    plant.push = {{0, 0, i < 500 ? 40.0 : 0.0, 0, 0, 0}};
    arm.read(ros::Time(1));
    arm.write();
    plant.step();
    const franka::RobotState& state = arm.state();
    for (std::size_t j = 0; j < 7; ++j) {
      const double shown = std::abs(state.tau_ext_hat_filtered[j]);
      ASSERT_EQ(shown > parameters.nominal.lower_torque[j] ? 1.0 : 0.0, state.joint_contact[j]);
      ASSERT_EQ(shown > parameters.nominal.upper_torque[j] ? 1.0 : 0.0, state.joint_collision[j]);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      const double shown = std::abs(state.K_F_ext_hat_K[j]);
      ASSERT_EQ(shown > parameters.nominal.lower_force[j] ? 1.0 : 0.0, state.cartesian_contact[j]);
      ASSERT_EQ(shown > parameters.nominal.upper_force[j] ? 1.0 : 0.0,
                state.cartesian_collision[j]);
      contacts += state.cartesian_contact[j] > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(contacts, 100);
  EXPECT_LT(contacts, 700);
}

}  // namespace
}  // namespace franka_sim_mujoco
