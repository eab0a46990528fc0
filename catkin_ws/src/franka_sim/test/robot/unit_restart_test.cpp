// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
//
// The arm is teleported while a request waits for an answer: no request waits for ever.
#include "fci_fixture.h"

namespace franka_sim::test {
namespace {

const std::array<double, 7> kElsewhere{{0.5, 0.1, -0.5, -2, 0.3, 1.8, 0.2}};

class UnitRestart : public FciTest {
 protected:
  /// Moves joint 1 at about 1 rad/s.
  void swing() {
    startMove(MotionGeneratorMode::kJointPosition);
    drive(300, [](int i, const RobotState&) {
      RobotCommand command;
      command.q_c = kReady;
      command.q_c[0] += 0.6 * smoothStep(1e-3 * i);
      return command;
    });
    ASSERT_EQ(RobotMode::kMove, unit.state().robot_mode);
    ASSERT_GT(unit.state().dq_d[0], 0.5);
  }
  void putElsewhere() {
    arm.put(kElsewhere);
    unit.restart();
  }
  void expectToStayElsewhere() {
    run(500);
    EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
    EXPECT_EQ(std::vector<int>{}, raised());
    expectNear(kElsewhere, arm.q(), 1e-6);
  }
};

TEST_F(UnitRestart, AnswersAStopThatStillBrakes) {
  swing();
  EXPECT_FALSE(unit.request(codec::StopMoveRequest{}));
  run(5);
  ASSERT_TRUE(unit.status().settling);
  ASSERT_FALSE(unit.takeAnswer(PendingAnswer::kStop));
  putElsewhere();
  EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kStop));
  EXPECT_EQ(Status::kPreempted, unit.takeAnswer(PendingAnswer::kMotion));
  EXPECT_FALSE(unit.status().settling);
  expectToStayElsewhere();
  // Nothing of it remains for the next motion.
  startMove(MotionGeneratorMode::kJointPosition);
  run(21);
  EXPECT_FALSE(unit.takeAnswer(PendingAnswer::kStop));
}

TEST_F(UnitRestart, EndsAMotionThatCannotContinueFromTheNewPose) {
  swing();
  putElsewhere();
  EXPECT_EQ(Status::kAborted, unit.takeAnswer(PendingAnswer::kMotion));
  expectToStayElsewhere();
}

TEST_F(UnitRestart, AnswersAStopBeforeTheNextObservation) {
  ASSERT_EQ(Status::kMotionStarted, unit.request(torqueControl()));
  putElsewhere();
  EXPECT_FALSE(unit.request(codec::StopMoveRequest{}));
  run(1);
  EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kStop));
  EXPECT_EQ(Status::kPreempted, unit.takeAnswer(PendingAnswer::kMotion));
  expectToStayElsewhere();
}

TEST_F(UnitRestart, LeavesAStopThatWasReleasedWhileTheArmBraked) {
  const std::vector<std::array<UnitRequest, 2>> stops{{UserStop{true}, UserStop{false}},
                                                      {Brakes{true}, Brakes{false}}};
  for (const auto& [press, release] : stops) {
    swing();
    unit.request(press);
    run(5);
    unit.request(release);
    ASSERT_TRUE(unit.status().settling);
    putElsewhere();
    expectToStayElsewhere();
    arm.put(kReady);
    unit.restart();
    run(5);
  }
}

TEST_F(UnitRestart, LetsARecoveryFinish) {
  swing();
  arm.push = {{0, 200, 0, 0, 0, 0}};
  drive(200, [](int, const RobotState& state) {
    RobotCommand command;
    command.q_c = state.q_d;
    return command;
  });
  arm.push.fill(0.0);
  ASSERT_EQ(RobotMode::kReflex, unit.state().robot_mode);
  ASSERT_FALSE(unit.request(codec::AutomaticErrorRecoveryRequest{}));
  putElsewhere();
  EXPECT_EQ(Status::kSuccess, waitFor(PendingAnswer::kRecovery));
  expectToStayElsewhere();
}

TEST_F(UnitRestart, EndsTheAccelerationThresholds) {
  parameters.acceleration.upper_force.fill(1e3);
  rebuild();
  run(1);
  swing();
  ASSERT_EQ(1e3, unit.status().thresholds.upper_force[0]);
  putElsewhere();
  run(1);
  EXPECT_EQ(parameters.nominal.upper_force, unit.status().thresholds.upper_force);
}

TEST_F(UnitRestart, HoldsGuidedAxesAtTheNewPose) {
  ASSERT_EQ(Status::kSuccess, unit.request(codec::SetGuidingModeRequest{
                                  {{false, false, false, false, false, false}}, false}));
  unit.request(Guiding{true});
  run(10);
  putElsewhere();
  run(500);
  expectNear(kElsewhere, arm.q(), 1e-3);
}

TEST_F(UnitRestart, AnswersAStopThatAReflexInterrupts) {
  swing();
  EXPECT_FALSE(unit.request(codec::StopMoveRequest{}));
  run(5);
  tickWith([](ArmMeasurement& m) { m.tau_J[0] += 60.0; });
  EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode);
  EXPECT_EQ(Status::kReflexAborted, unit.takeAnswer(PendingAnswer::kStop));
  EXPECT_EQ(Status::kPreempted, unit.takeAnswer(PendingAnswer::kMotion));
}

TEST_F(UnitRestart, AnswersAStopWhenTorqueControlReplacesBraking) {
  swing();
  EXPECT_FALSE(unit.request(codec::StopMoveRequest{}));
  run(5);
  ASSERT_EQ(Status::kMotionStarted, unit.request(torqueControl()));
  EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kStop));
}

}  // namespace
}  // namespace franka_sim::test
