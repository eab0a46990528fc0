// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The unit's external torques and wrenches, against known forces.
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/safety/collision.h>

#include <Eigen/Core>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

#include "arm_fixture.h"

namespace franka_sim::test {

namespace {

using franka_core::RobotMode;
using franka_core::RobotState;

double smallestSingularValue(const ControlUnit& unit) {
  const RobotState& s = unit.state();
  const std::array<double, 42> J = unit.configuration().model.zeroJacobian(
      franka_core::ArmFrame::kStiffness, s.q, s.F_T_EE, s.EE_T_K);
  const Eigen::Map<const Eigen::Matrix<double, 6, 7>> jacobian(J.data());
  return Eigen::JacobiSVD<Eigen::Matrix<double, 6, 7>>(jacobian).singularValues()[5];
}

TEST_F(ArmTest, UnconfiguredKilogramReadsItsWeight) {
  franka_core::Payload load;
  load.mass = 1.0;
  load.com = {{0.0, 0.0, 0.1034}};
  arm.payload = franka_core::combine(parameters.end_effector, load);
  run(4000);
  EXPECT_NEAR(0.0, unit.state().O_F_ext_hat_K[0], 0.01);
  EXPECT_NEAR(0.0, unit.state().O_F_ext_hat_K[1], 0.01);
  EXPECT_NEAR(9.81, unit.state().O_F_ext_hat_K[2], 0.01);

  ASSERT_EQ(Status::kSuccess, unit.request(loadRequest(load)));
  run(4000);
  EXPECT_LT(norm(unit.state().O_F_ext_hat_K, 0, 3), 1e-3);
  EXPECT_DOUBLE_EQ(1.76, unit.state().m_total);
}

TEST_F(ArmTest, WithoutReflexesFlagsFollowTheManualsFormulas) {
  // Also with a lower threshold above the upper one.
  CollisionThresholds t = parameters.nominal;
  t.lower_force = {{10, 10, 10, 10, 10, 30}};
  t.upper_force.fill(20);
  t.lower_torque.fill(3);
  t.upper_torque.fill(8);
  ASSERT_EQ(Status::kSuccess, unit.request(collisionRequest(t, t)));
  int contacts = 0;
  int collisions = 0;
  for (int i = 0; i < 3000; i++) {
    arm.push = {{0, 0, -30.0 * std::sin(0.01 * i), 0, 0, 0}};
    const RobotState& state = tick(unit, arm);
    for (std::size_t j = 0; j < 7; j++) {
      const double shown = std::abs(state.tau_ext_hat_filtered[j]);
      ASSERT_EQ(shown > 3 ? 1.0 : 0.0, state.joint_contact[j]);
      ASSERT_EQ(shown > 8 ? 1.0 : 0.0, state.joint_collision[j]);
    }
    for (std::size_t j = 0; j < 6; j++) {
      const double shown = std::abs(state.K_F_ext_hat_K[j]);
      ASSERT_EQ(shown > t.lower_force[j] ? 1.0 : 0.0, state.cartesian_contact[j]);
      ASSERT_EQ(shown > 20 ? 1.0 : 0.0, state.cartesian_collision[j]);
      contacts += state.cartesian_contact[j] > 0.0 ? 1 : 0;
      collisions += state.cartesian_collision[j] > 0.0 ? 1 : 0;
    }
    ASSERT_EQ(RobotMode::kIdle, state.robot_mode);
  }
  EXPECT_GT(collisions, 100);
  EXPECT_GT(contacts, collisions);
  arm.push.fill(0.0);
  run(1000);
  EXPECT_EQ((std::array<double, 6>{}), unit.state().cartesian_collision);
}

TEST_F(ArmTest, CollisionLatchesUntilRecovery) {
  parameters = pandaOverFci();
  rebuild();
  run(1);
  CollisionThresholds t = parameters.nominal;
  t.lower_force.fill(10);
  t.upper_force.fill(20);
  t.lower_torque.fill(80);
  t.upper_torque.fill(90);
  ASSERT_EQ(Status::kSuccess, unit.request(collisionRequest(t, t)));
  EXPECT_FALSE(unit.status().cartesian_collision.happened);
  arm.push = {{0, 0, -30, 0, 0, 0}};
  run(100);
  EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode);
  EXPECT_EQ(1.0, unit.state().cartesian_collision[2]);
  EXPECT_EQ(0.0, unit.state().cartesian_contact[2]);
  const Collision& collision = unit.status().cartesian_collision;
  EXPECT_TRUE(collision.happened && !unit.status().joint_collision.happened);
  EXPECT_EQ(2u, collision.index);
  EXPECT_GT(collision.value, 20.0);
  EXPECT_EQ(20.0, collision.threshold);
  arm.push.fill(0.0);
  run(3000);
  EXPECT_EQ(1.0, unit.state().cartesian_collision[2]);
  EXPECT_EQ(std::nullopt, unit.request(codec::AutomaticErrorRecoveryRequest{}));
  run(100);
  EXPECT_EQ((std::array<double, 6>{}), unit.state().cartesian_collision);
  EXPECT_FALSE(unit.status().cartesian_collision.happened);
}

TEST(CollisionText, NamesTheLargestExcess) {
  const Collision worst = worstOf<6>({{5, -30, 9, 0, 0, 0}}, {{1, 20, 10, 1, 1, 1}});
  EXPECT_EQ(0u, worst.index);
  EXPECT_FALSE(worstOf<6>({}, {}).happened);
}

TEST_F(ArmTest, ThresholdsApplyInTheFrameOfTheInterface) {
  // In the ready pose the hand points down: z of K is minus z of O, x of K is x of O turned by the
  // hand's own angle. Turn K by a quarter about x so that a push along z of O lies along y of K.
  parameters.EE_T_K = {{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1}};
  parameters.nominal.lower_force.fill(10);
  parameters.nominal.upper_force.fill(20);
  for (const InterfaceRules rules : {InterfaceRules::kFci, InterfaceRules::kRosControl,
                                     InterfaceRules::kRosControlWithReflexes}) {
    parameters.rules = rules;
    rebuild();
    arm.put(kReady);
    arm.push = {{0, 0, 15, 0, 0, 0}};
    run(3000);
    const std::size_t axis = rules == InterfaceRules::kFci ? 2 : 1;
    std::array<double, 6> expected{};
    expected[axis] = 1.0;
    EXPECT_EQ(expected, unit.state().cartesian_contact);
  }
}

TEST_F(ArmTest, ThresholdsApplyToUnfilteredValues) {
  parameters = pandaOverFci();
  parameters.nominal.upper_force.fill(20);
  rebuild();
  run(100);
  arm.push = {{0, 0, 25, 0, 0, 0}};
  tick(unit, arm);
  const RobotState& state = tick(unit, arm);
  EXPECT_EQ(1.0, state.cartesian_collision[2]);
  EXPECT_LT(std::abs(state.O_F_ext_hat_K[2]), 12.0);  // filtered
}

TEST_F(ArmTest, FilteredTorqueIsAFirstOrderLowPassOfAHundredHertz) {
  run(100);
  // A torque on the sensor alone, with the joints at rest, is entirely external.
  ArmMeasurement m = arm.measure();
  m.dq.fill(0.0);
  unit.observe(m);
  m.tau_J = parameters.model.gravity(m.q, parameters.end_effector);
  for (int i = 0; i < 50; i++) {
    unit.observe(m);
  }
  m.tau_J[3] += 10.0;
  const double gain = 1e-3 / (1e-3 + 1 / (2 * 3.14159265358979323846 * 100));
  double expected = unit.state().tau_ext_hat_filtered[3];
  for (int i = 0; i < 20; i++) {
    expected = gain * 10.0 + (1 - gain) * expected;
    EXPECT_NEAR(expected, unit.observe(m).tau_ext_hat_filtered[3], 1e-6);
  }
}

TEST_F(ArmTest, SingularityBoundIsTwoHundredths) {
  // Crosses the bound, away from the stretched pose, and compares with a singular value
  // decomposition.
  int inside = 0;
  int outside = 0;
  for (int i = 1; i <= 200; i++) {
    ControlUnit fresh(parameters);
    ArmMeasurement m;
    m.q = {{0, 0.002 * i, 0, 0, 0, 0, 0}};
    fresh.observe(m);
    m.tau_J = fresh.state().tau_J;
    m.tau_J[1] += 10;
    fresh.observe(m);
    const RobotState& state = fresh.state();
    const bool shown = norm(state.O_F_ext_hat_K, 0, 6) > 0.0;
    EXPECT_EQ(shown, norm(state.K_F_ext_hat_K, 0, 6) > 0.0);
    EXPECT_TRUE(shown || norm(state.cartesian_contact, 0, 6) == 0.0);
    EXPECT_GT(state.tau_ext_hat_filtered[1], 3.0) << "of 10 Nm, after the first tick of the filter";
    const double sigma = smallestSingularValue(fresh);
    if (std::abs(sigma - 0.02) > 1e-9) {
      EXPECT_EQ(sigma > 0.02, shown) << "sigma " << sigma;
    }
    (shown ? outside : inside)++;
  }
  EXPECT_GT(inside, 0);
  EXPECT_GT(outside, 0);
}

}  // namespace

}  // namespace franka_sim::test
