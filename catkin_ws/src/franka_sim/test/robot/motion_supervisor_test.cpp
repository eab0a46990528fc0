// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Motions and stops as the supervisor decides them.
#include <franka_sim/robot/motion_supervisor.h>

#include "unit_without_facade.h"

namespace franka_sim::test {

namespace {

using Joints = std::array<double, 7>;
using MotionSupervisorTest = UnitWithoutFacade;

TEST_F(MotionSupervisorTest, StartsAMotionOnlyAfterAMeasurement) {
  MotionSupervisor supervisor(configuration, estimator, state);
  EXPECT_EQ(Status::kCommandNotPossibleRejected, supervisor.handle(torqueControl()));
  measure(kReady);
  supervisor.judge({});
  EXPECT_EQ(Status::kMotionStarted, supervisor.handle(torqueControl()));
  EXPECT_EQ(LawSwitch::kFromZero, supervisor.takeTask().law_switch);
  EXPECT_EQ(LawSwitch::kNone, supervisor.takeTask().law_switch);
}

TEST_F(MotionSupervisorTest, HandsTheCommandedTorqueToTheLaws) {
  MotionSupervisor supervisor(configuration, estimator, state);
  measure(kReady);
  supervisor.judge({});
  supervisor.handle(torqueControl());
  const RobotCommand command = torques({{0.5, 0, 0, 0, 0, 0, 0}});
  supervisor.advance(&command);
  EXPECT_EQ(command.tau_J_d, supervisor.takeTask().tau);
  supervisor.advance(nullptr);
  EXPECT_EQ(command.tau_J_d, supervisor.takeTask().tau) << "held while commands are missing";
  supervisor.handle(UserStop{true});
  EXPECT_TRUE(supervisor.brakesClosed());
  EXPECT_EQ(Status::kEmergencyAborted, supervisor.take(PendingAnswer::kMotion));
  EXPECT_EQ(Joints{}, supervisor.takeTask().tau);
}

}  // namespace

}  // namespace franka_sim::test
