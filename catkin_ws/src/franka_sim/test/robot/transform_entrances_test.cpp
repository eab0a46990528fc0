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

TEST(TransformFault, DescribesEveryRefusedMatrix) {
  struct Row {
    std::array<double, 16> matrix;
    const char* part;
  };
  const std::array<double, 16> identity = franka_core::kIdentityTransform;
  const auto with = [&](std::size_t entry, double value) {
    std::array<double, 16> matrix = identity;
    matrix[entry] = value;
    return matrix;
  };
  const double third = 1.0 / std::sqrt(3.0);
  for (const Row& row :
       {Row{with(3, 1e-17), "1e-17 0 0 1"}, Row{with(12, NAN), "row 1 and column 4 is nan"},
        Row{with(0, 1.1), "column 1"}, Row{with(4, 1e-4), "columns 1 and 2"},
        Row{with(10, -1.0), "mirrors"},
        Row{{third, third, third, 0, third, third, third, 0, third, third, third, 0, 0, 0, 0, 1},
            "right angles"}}) {
    EXPECT_FALSE(franka_core::isRigidTransform(row.matrix));
    const std::string fault = franka_core::transformFault(row.matrix);
    EXPECT_NE(std::string::npos, fault.find(row.part)) << fault;
  }
  std::array<double, 16> four_digits = identity;
  four_digits[0] = four_digits[4] = four_digits[5] = 0.7071;
  four_digits[1] = -0.7071;
  EXPECT_TRUE(franka_core::isRigidTransform(four_digits));
  EXPECT_TRUE(franka_core::isRigidTransform(identity));
  EXPECT_EQ("", franka_core::transformFault(identity));
}

}  // namespace
}  // namespace franka_sim::test
