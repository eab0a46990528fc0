// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The arm's dynamics against independent results: KDL, energy, finite differences, and each other.
#include <gtest/gtest.h>

#include <algorithm>
#include <kdl/chaindynparam.hpp>

#include "kdl_arm.h"
#include "random_state.h"

namespace franka_test {
namespace {

using franka_core::ArmDynamics;
using franka_core::ArmFrame;
using franka_core::ArmModel;
using franka_core::Payload;

class ArmDynamicsTest : public ::testing::TestWithParam<Arm> {
 protected:
  const std::string urdf_{readData(GetParam().file)};
  const ArmModel arm_{ArmModel::fromUrdf(urdf_, GetParam().arm_id)};
  StateSource states_{*GetParam().limits};
};

INSTANTIATE_TEST_SUITE_P(Arms, ArmDynamicsTest, ::testing::Values(kPanda, kFr3), armName);

KDL::JntArray joints(const std::array<double, 7>& values) {
  KDL::JntArray array(7);
  array.data = vector(values);
  return array;
}

TEST_P(ArmDynamicsTest, AgreesWithKdl) {
  double mass_error = 0.0, coriolis_error = 0.0, gravity_error = 0.0;
  const KDL::Chain bare = kdlArm(urdf_, GetParam().arm_id);
  for (int n = 0; n < kStates; n++) {
    const State s = states_.next();
    KDL::Chain chain = bare;
    addPayload(chain, s.payload);
    KDL::ChainDynParam solver(
        chain, KDL::Vector(s.gravity_earth[0], s.gravity_earth[1], s.gravity_earth[2]));
    KDL::JntSpaceInertiaMatrix mass(7);
    KDL::JntArray coriolis(7), gravity(7);
    ASSERT_EQ(0, solver.JntToMass(joints(s.q), mass));
    ASSERT_EQ(0, solver.JntToCoriolis(joints(s.q), joints(s.dq), coriolis));
    ASSERT_EQ(0, solver.JntToGravity(joints(s.q), gravity));
    mass_error =
        std::max(mass_error, (matrix(arm_.mass(s.q, s.payload)) - mass.data).cwiseAbs().maxCoeff());
    coriolis_error = std::max(
        coriolis_error,
        (vector(arm_.coriolis(s.q, s.dq, s.payload)) - coriolis.data).cwiseAbs().maxCoeff());
    gravity_error = std::max(gravity_error,
                             (vector(arm_.gravity(s.q, s.payload, s.gravity_earth)) - gravity.data)
                                 .cwiseAbs()
                                 .maxCoeff());
  }
  std::printf("largest difference to KDL: mass %.1e kg m^2, Coriolis %.1e Nm, gravity %.1e Nm\n",
              mass_error, coriolis_error, gravity_error);
  EXPECT_LT(mass_error, 1e-13);
  EXPECT_LT(coriolis_error, 1e-12);
  EXPECT_LT(gravity_error, 1e-12);
}

TEST_P(ArmDynamicsTest, ComputeDynamicsMatchesItsParts) {
  for (int n = 0; n < kStates; n++) {
    const State s = states_.next();
    const auto frame = static_cast<ArmFrame>(n % 10);
    ArmDynamics all;
    arm_.computeDynamics(frame, s.q, s.dq, s.F_T_EE, s.EE_T_K, s.payload, s.gravity_earth, all);
    EXPECT_LT((matrix(all.mass) - matrix(arm_.mass(s.q, s.payload))).cwiseAbs().maxCoeff(), 1e-13);
    EXPECT_LT(
        (vector(all.coriolis) - vector(arm_.coriolis(s.q, s.dq, s.payload))).cwiseAbs().maxCoeff(),
        1e-12);
    EXPECT_LT((vector(all.gravity) - vector(arm_.gravity(s.q, s.payload, s.gravity_earth)))
                  .cwiseAbs()
                  .maxCoeff(),
              1e-12);
    EXPECT_EQ(all.pose, arm_.pose(frame, s.q, s.F_T_EE, s.EE_T_K));
    EXPECT_EQ(all.zero_jacobian, arm_.zeroJacobian(frame, s.q, s.F_T_EE, s.EE_T_K));
  }
}

TEST_P(ArmDynamicsTest, InverseDynamicsIsMassCoriolisAndGravity) {
  for (int n = 0; n < kStates; n++) {
    const State s = states_.next();
    const Vector7 sum = matrix(arm_.mass(s.q, s.payload)) * vector(s.ddq) +
                        vector(arm_.coriolis(s.q, s.dq, s.payload)) +
                        vector(arm_.gravity(s.q, s.payload, s.gravity_earth));
    const Vector7 torque =
        vector(arm_.inverseDynamics(s.q, s.dq, s.ddq, s.payload, s.gravity_earth));
    EXPECT_LT((sum - torque).cwiseAbs().maxCoeff(), 1e-11);
  }
}

TEST(Combine, FollowsTheParallelAxisTheorem) {
  Payload hand{0.73, {-0.01, 0.0, 0.03}, {0.001, 0, 0, 0, 0.0025, 0, 0, 0, 0.0017}};
  Payload load{1.2, {0.05, -0.02, 0.11}, {0.003, 1e-4, 0, 1e-4, 0.002, 0, 0, 0, 0.004}};
  const Payload total = combine(hand, load);
  EXPECT_DOUBLE_EQ(1.93, total.mass);
  EXPECT_NEAR((0.73 * -0.01 + 1.2 * 0.05) / 1.93, total.com[0], 1e-16);
  // Two bodies about their common center: both inertias and the reduced mass at their distance.
  const Eigen::Vector3d d(0.06, -0.02, 0.08);
  const double reduced = 0.73 * 1.2 / 1.93;
  const Eigen::Matrix3d expected =
      Eigen::Map<const Eigen::Matrix3d>(hand.inertia.data()) +
      Eigen::Map<const Eigen::Matrix3d>(load.inertia.data()) +
      reduced * (d.squaredNorm() * Eigen::Matrix3d::Identity() - d * d.transpose());
  EXPECT_LT(
      (expected - Eigen::Map<const Eigen::Matrix3d>(total.inertia.data())).cwiseAbs().maxCoeff(),
      1e-16);
}

TEST(Combine, IgnoresPartsWithoutMass) {
  const Payload hand{0.73, {-0.01, 0.0, 0.03}, {0.001, 0, 0, 0, 0.0025, 0, 0, 0, 0.0017}};
  const Payload nothing{0.0, {1.0, 2.0, 3.0}, {9, 0, 0, 0, 9, 0, 0, 0, 9}};
  for (const Payload& total : {combine(hand, nothing), combine(nothing, hand)}) {
    EXPECT_EQ(hand.mass, total.mass);
    EXPECT_EQ(hand.com, total.com);
    EXPECT_EQ(hand.inertia, total.inertia);
  }
  const Payload none = combine(nothing, nothing);
  EXPECT_EQ(0.0, none.mass);
  EXPECT_EQ((std::array<double, 3>{}), none.com);
  EXPECT_EQ((std::array<double, 9>{}), none.inertia);
}

}  // namespace
}  // namespace franka_test
