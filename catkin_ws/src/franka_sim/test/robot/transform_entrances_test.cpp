// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// One rule for transforms at every input of the control unit.
#include <franka_core/transform.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <transform_sweep.h>

#include <stdexcept>
#include <string>

#include "fci_fixture.h"

namespace franka_sim::test {
namespace {

using franka_test::perturbations;
using franka_test::PerturbedMatrix;

using TransformEntrances = FciTest;

TEST_F(TransformEntrances, SettersAndParametersAgreeOnRoundedMatrices) {
  for (const PerturbedMatrix& perturbed : perturbations(parameters.F_T_NE)) {
    const Status expected =
        perturbed.accepted ? Status::kSuccess : Status::kInvalidArgumentRejected;
    EXPECT_EQ(expected, unit.request(codec::SetNEToEERequest{perturbed.matrix})) << perturbed;
    EXPECT_EQ(expected, unit.request(codec::SetEEToKRequest{perturbed.matrix})) << perturbed;
    franka_core::fci::CartesianLimit wall;
    wall.object_frame = perturbed.matrix;
    EXPECT_EQ(expected, unit.request(SetVirtualWall{0, wall})) << perturbed;
    ControlUnitParameters changed = parameters;
    changed.NE_T_EE = perturbed.matrix;
    try {
      checkParameters(changed);
      EXPECT_TRUE(perturbed.accepted) << perturbed;
    } catch (const std::invalid_argument& error) {
      EXPECT_FALSE(perturbed.accepted) << perturbed;
      EXPECT_NE(std::string::npos, std::string(error.what()).find("exactly 0 0 0 1"))
          << error.what();
    }
  }
}

TEST_F(TransformEntrances, CommandedPosesAgreeOnRoundedMatrices) {
  for (const unsigned protocol : {5U, 10U}) {
    parameters.rules = InterfaceRules::kFci;
    parameters.protocol_version = protocol;
    for (const double cutoff : {1000.0, 100.0}) {
      standAt(kReady);
      for (const PerturbedMatrix& perturbed : perturbations(unit.state().O_T_EE_c)) {
        standAt(kReady);
        franka_core::fci::SetFiltersRequest filters;
        filters.cartesian_position = cutoff;
        ASSERT_EQ(Status::kSuccess, unit.request(filters));
        startMove(MotionGeneratorMode::kCartesianPosition);
        RobotCommand command;
        command.O_T_EE_c = perturbed.matrix;
        run(3, &command);
        EXPECT_EQ(perturbed.accepted ? std::vector<int>{} : std::vector<int>{31}, raised())
            << perturbed << ", protocol " << protocol << ", filter " << cutoff;
      }
    }
  }
}

TEST(RigidTransform, HasTheToleranceOfFourDigits) {
  std::array<double, 16> turned = franka_core::kIdentityTransform;
  turned[0] = turned[4] = turned[5] = 0.7071;
  turned[1] = -0.7071;
  EXPECT_TRUE(franka_core::isRigidTransform(turned));
  std::array<double, 16> skewed = franka_core::kIdentityTransform;
  skewed[4] = 1e-4;
  EXPECT_FALSE(franka_core::isRigidTransform(skewed));
  const double third = 1.0 / std::sqrt(3.0);
  EXPECT_FALSE(franka_core::isRigidTransform(
      {third, third, third, 0, third, third, third, 0, third, third, third, 0, 0, 0, 0, 1}));
}

}  // namespace
}  // namespace franka_sim::test
