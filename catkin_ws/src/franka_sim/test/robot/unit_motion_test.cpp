// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Motions: start, run, ends and external events meanwhile. What ends which motion, and with which
// answer: properties/invariants.cpp.
#include <algorithm>
#include <iterator>
#include <tuple>

#include "fci_fixture.h"
#include "robot/supervisor/mode_machine.h"

namespace franka_sim::test {

namespace {

/// Each mode with the events of the shortest path to it.
const std::pair<RobotMode, std::vector<ModeEvent>> kModes[] = {
    {RobotMode::kOther, {ModeEvent::kBrakesClosed}},
    {RobotMode::kIdle, {}},
    {RobotMode::kMove, {ModeEvent::kMotionStarted}},
    {RobotMode::kGuiding, {ModeEvent::kGuidingStarted}},
    {RobotMode::kReflex, {ModeEvent::kError}},
    {RobotMode::kUserStopped, {ModeEvent::kUserStopPressed}},
    {RobotMode::kAutomaticErrorRecovery, {ModeEvent::kError, ModeEvent::kRecoveryStarted}}};

TEST(ModeTable, EveryEventInEveryMode) {
  // Rows: modes in the order of kModes. Columns: events in the order of ModeEvent. '.': no change;
  // else the first letter of the mode that follows (I M G R U A, O for Other).
  const char* const table[7] = {
      "...........I",  // Other
      "M.R...G.U.O.",  // Idle
      ".IR...G.U.O.",  // Move
      ".......IU.O.",  // Guiding
      "...A..G.U.O.",  // Reflex
      ".........IO.",  // UserStopped
      "....IR..U.O.",  // AutomaticErrorRecovery
  };
  const std::string letters = "OIMGRUA";
  for (std::size_t row = 0; row < 7; row++) {
    for (int event = 0; event < kModeEventCount; event++) {
      const auto& [mode, path] = kModes[row];
      ModeMachine machine;
      for (const ModeEvent step : path) {
        machine.handle(step);
      }
      ASSERT_EQ(mode, machine.mode());
      const char expected = table[row][event];
      EXPECT_EQ(expected != '.', machine.handle(static_cast<ModeEvent>(event)))
          << row << " " << event;
      const RobotMode after =
          expected == '.' ? mode : static_cast<RobotMode>(letters.find(expected));
      EXPECT_EQ(after, machine.mode()) << row << " " << event;
      EXPECT_EQ(after == RobotMode::kOther || after == RobotMode::kUserStopped,
                machine.closesBrakes());
    }
  }
}

class UnitMotion : public FciTest {
 protected:
  /// Joint 1 by 0.3 rad and back to rest, within a second.
  RobotCommand swing(int i, double amplitude = 0.3) const {
    RobotCommand command;
    command.q_c = begin;
    command.q_c[0] += amplitude * smoothStep(1e-3 * (i + 1));
    command.dq_c[0] = amplitude * smoothSpeed(1e-3 * (i + 1));
    command.motion_generation_finished = i >= 1100;
    return command;
  }

  /// With the torques of a client that follows the generator.
  static RobotCommand followed(RobotCommand command, const RobotState& state) {
    for (std::size_t j = 0; j < 7; j++) {
      const double torque = 300 * (state.q_d[j] - state.q[j]) + 20 * (state.dq_d[j] - state.dq[j]);
      command.tau_J_d[j] = state.tau_J_d[j] + std::clamp(torque - state.tau_J_d[j], -0.99, 0.99);
    }
    return command;
  }

  void startSwing(ControllerMode controller = ControllerMode::kJointImpedance) {
    begin = unit.state().q_d;
    startMove(MotionGeneratorMode::kJointPosition, controller);
  }

  void expectNoMotionStarts() {
    const auto move = moveRequest(MotionGeneratorMode::kJointPosition);
    EXPECT_EQ(Status::kCommandNotPossibleRejected, unit.request(move));
  }

  void reflex() {
    ignoreCollisions();
    tickWith([](ArmMeasurement& m) { m.tau_J[0] = 110; });
    ASSERT_EQ(RobotMode::kReflex, unit.state().robot_mode);
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

  static constexpr Joints kElsewhere{{0.5, 0.1, -0.5, -2, 0.3, 1.8, 0.2}};
  Joints begin{};
};

TEST_F(UnitMotion, RunsToItsEndUnderEachController) {
  for (const ControllerMode controller :
       {ControllerMode::kJointImpedance, ControllerMode::kCartesianImpedance}) {
    standAt(kReady);
    startSwing(controller);
    double error = 0.0;
    const int ticks = drive(2000, [&](int i, const RobotState& state) {
      EXPECT_EQ(MotionGeneratorMode::kJointPosition, state.motion_generator_mode);
      EXPECT_EQ(controller, state.controller_mode);
      for (std::size_t j = 12; j < 15; j++) {
        error = std::max(error, std::abs(state.O_T_EE[j] - state.O_T_EE_d[j]));
      }
      return swing(i);
    });
    EXPECT_EQ(1101, ticks);
    EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
    // The rotors' inertia is not fed forward (decision 2): a lag, no offset.
    EXPECT_LT(error, 0.01);
    run(1000);
    EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kMotion));
    EXPECT_FALSE(unit.takeAnswer(PendingAnswer::kMotion)) << "reported once";
    EXPECT_NEAR(begin[0] + 0.3, unit.state().q_d[0], 1e-9);
    EXPECT_NEAR(begin[0] + 0.3, arm.q()[0], 1e-4);
    EXPECT_EQ((std::array<double, 7>{}), unit.state().tau_J_d);
  }
}

TEST_F(UnitMotion, FollowsAndReportsACartesianPose) {
  standAt(kReady);
  const std::array<double, 16> start = unit.state().O_T_EE_c;
  startMove(MotionGeneratorMode::kCartesianPosition, ControllerMode::kCartesianImpedance);
  drive(1200, [&](int i, const RobotState& state) {
    RobotCommand command;
    command.O_T_EE_c = start;
    command.O_T_EE_c[14] += 0.1 * smoothStep(1e-3 * (i + 1));
    expectNear(state.O_T_EE_c, state.O_T_EE_d, 1e-11);
    EXPECT_NEAR(state.O_dP_EE_c[2], state.O_dP_EE_d[2], 2e-3);
    return command;
  });
  EXPECT_EQ(RobotMode::kMove, unit.state().robot_mode);
  EXPECT_NEAR(start[14] + 0.1, unit.state().O_T_EE_c[14], 1e-9);
  EXPECT_NEAR(start[14] + 0.1, unit.state().O_T_EE[14], 1e-3);
  EXPECT_EQ(unit.state().elbow_c, unit.state().elbow_d);
}

TEST_F(UnitMotion, AccelerationThresholdsApplyToInternalControllersOnly) {
  for (const auto& [controller, mode] :
       {std::pair{ControllerMode::kJointImpedance, RobotMode::kMove},
        std::pair{ControllerMode::kExternalController, RobotMode::kReflex}}) {
    standAt(kReady);
    ASSERT_EQ(Status::kSuccess,
              unit.request(collisionRequest(highThresholds(), parameters.nominal)));
    startSwing(controller);
    // Always accelerates by more than a tenth of the limit.
    drive(300, [&](int i, const RobotState& state) {
      if (i == 150) {
        arm.push = {{0, -30, 0, 0, 0, 0}};
      }
      if (i >= 100) {
        EXPECT_GT(state.ddq_d[0], 1.5);
      }
      return followed(swing(i, 0.6), state);
    });
    EXPECT_EQ(mode, unit.state().robot_mode);
    for (const int flag : raised()) {
      EXPECT_TRUE(flag == 6 || flag == 7) << flag;
    }
    arm.push.fill(0.0);
  }
}

TEST_F(UnitMotion, SingularStartIsReportedAfterTheStart) {
  // Stretched: shoulder, elbow and wrist on one line.
  standAt({{0, 0.5, 0, franka_core::kElbowFlip, 0, 1.5, 0}});
  EXPECT_EQ(Status::kMotionStarted,
            unit.request(moveRequest(MotionGeneratorMode::kCartesianVelocity)));
  EXPECT_EQ(Status::kStartAtSingularPoseRejected, unit.takeAnswer(PendingAnswer::kMotion));
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
}

TEST_F(UnitMotion, StopMoveBrakesAndAnswersAtRest) {
  startSwing();
  drive(500, [&](int i, const RobotState&) { return swing(i); });
  const double speed = unit.state().dq_d[0];
  ASSERT_GT(speed, 0.5);
  const double from = unit.state().q_d[0];
  EXPECT_FALSE(unit.request(codec::StopMoveRequest{}));
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
  expectNoMotionStarts();
  int ticks = 0;
  while (unit.status().settling) {
    EXPECT_FALSE(unit.takeAnswer(PendingAnswer::kStop));
    EXPECT_FALSE(unit.takeAnswer(PendingAnswer::kMotion));
    ASSERT_LT(ticks++, 200);
    const double desired = unit.state().dq_d[0];
    test::tick(unit, arm);
    EXPECT_NEAR(desired, unit.state().O_dP_EE_d[5], 1e-9) << "joint 1 turns about z of O";
  }
  // The acceleration begins and ends within the jerk limit.
  EXPECT_NEAR(speed / 15.0 + 15.0 / 7500.0, 1e-3 * ticks, 1e-3);
  EXPECT_NEAR(speed * speed / 30.0, unit.state().q_d[0] - from, 1e-3 * speed);
  EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kStop));
  EXPECT_EQ(Status::kPreempted, unit.takeAnswer(PendingAnswer::kMotion));
  EXPECT_EQ(Status::kCommandNotPossibleRejected, unit.request(codec::StopMoveRequest{}));
  const std::array<double, 7> held = unit.state().q_d;
  run(1000);
  EXPECT_EQ(held, unit.state().q_d);
  expectNear(held, arm.q(), 1e-4);
  startSwing();
}

TEST_F(UnitMotion, SwitchingTheControlLawCausesNoTorqueStep) {
  // A load that is not configured makes the hold carry torque into the motion and out of it.
  arm.payload.mass += 1.0;
  ignoreCollisions();
  run(2000);
  std::array<double, 7> last = arm.torques();
  double step = 0.0;
  const auto measure = [&] {
    step = std::max(step, largestDifference(arm.torques(), last));
    last = arm.torques();
  };
  ASSERT_EQ(Status::kSuccess,
            unit.request(codec::SetJointImpedanceRequest{{{200, 200, 200, 200, 200, 200, 200}}}));
  startSwing();
  drive(300, [&](int, const RobotState&) {
    measure();
    return swing(-1);
  });
  unit.request(codec::StopMoveRequest{});
  for (int i = 0; i < 300; i++) {
    test::tick(unit, arm);
    measure();
  }
  // The blend allows 1 Nm per tick, plus the laws' own changes. Unblended, joint 4 steps by more
  // than 3 Nm.
  EXPECT_LT(step, 1.5);
}

TEST_F(UnitMotion, ReflexBrakesYieldsAndRecoversAtRest) {
  startSwing();
  arm.push = {{0, -60, 0, 0, 0, 0}};
  drive(500, [&](int i, const RobotState&) { return swing(i); });
  ASSERT_EQ(RobotMode::kReflex, unit.state().robot_mode);
  EXPECT_EQ(Status::kReflexAborted, unit.takeAnswer(PendingAnswer::kMotion));
  expectNoMotionStarts();
  EXPECT_EQ(Status::kCommandNotPossibleRejected, unit.request(codec::StopMoveRequest{}));
  arm.push.fill(0.0);
  const auto reason = unit.state().reflex_reason;
  ASSERT_FALSE(unit.request(codec::AutomaticErrorRecoveryRequest{}));
  EXPECT_EQ(RobotMode::kAutomaticErrorRecovery, unit.state().robot_mode);
  EXPECT_EQ(Status::kSuccess, waitFor(PendingAnswer::kRecovery));
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
  EXPECT_TRUE(raised().empty());
  EXPECT_EQ((std::array<double, 6>{}), unit.state().cartesian_collision);
  EXPECT_EQ(reason, unit.state().reflex_reason) << "kept until the next motion";
  startSwing();
  EXPECT_EQ((std::array<bool, 41>{}), unit.state().reflex_reason);
  EXPECT_EQ(1101, drive(2000, [&](int i, const RobotState&) { return swing(i); }));
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
}

TEST_F(UnitMotion, PushAtRestRaisesAReflex) {
  arm.push = {{0, 60, 0, 0, 0, 0}};
  run(200);
  EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode);
  EXPECT_FALSE(unit.takeAnswer(PendingAnswer::kMotion));
}

TEST_F(UnitMotion, RecoveryNeedsTheUserBeyondJointLimits) {
  EXPECT_EQ(Status::kSuccess, unit.request(codec::AutomaticErrorRecoveryRequest{}))
      << "nothing to recover from";
  unit.request(UserStop{true});
  EXPECT_EQ(Status::kManualErrorRecoveryRequiredRejected,
            unit.request(codec::AutomaticErrorRecoveryRequest{}));
  unit.request(UserStop{false});
  run(3);

  ignoreCollisions();
  arm.put({{2.91, -0.785, 0, -2.356, 0, 1.571, 0.785}});
  run(1);
  ASSERT_EQ(std::vector<int>{0}, raised());
  EXPECT_EQ(Status::kManualErrorRecoveryRequiredRejected,
            unit.request(codec::AutomaticErrorRecoveryRequest{}));
  unit.request(Guiding{true});
  EXPECT_EQ(RobotMode::kGuiding, unit.state().robot_mode);
  arm.put({{2.5, -0.785, 0, -2.356, 0, 1.571, 0.785}});
  run(3);
  unit.request(Guiding{false});
  EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode) << "the error is still to be recovered";
  EXPECT_FALSE(unit.request(codec::AutomaticErrorRecoveryRequest{}));
  run(500);
  EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kRecovery));
  EXPECT_EQ(RobotMode::kIdle, unit.state().robot_mode);
}

TEST_F(UnitMotion, RecoveryFailsIfTheArmDoesNotComeToRest) {
  reflex();
  ASSERT_FALSE(unit.request(codec::AutomaticErrorRecoveryRequest{}));
  std::optional<Status> end;
  int ticks = 0;
  while (!end && ticks < 6000) {
    tickWith([](ArmMeasurement& m) { m.dq[6] = 0.02; });
    end = unit.takeAnswer(PendingAnswer::kRecovery);
    ticks++;
  }
  EXPECT_EQ(Status::kAborted, end);
  EXPECT_EQ(5000, ticks);
  EXPECT_EQ(RobotMode::kReflex, unit.state().robot_mode);
}

TEST_F(UnitMotion, GuidingFollowsPushesAlongFreeAxesOnly) {
  ASSERT_EQ(Status::kSuccess, unit.request(codec::SetGuidingModeRequest{
                                  {{false, true, false, false, false, false}}, false}));
  unit.request(Guiding{true});
  const std::array<double, 16> from = unit.state().O_T_EE;
  arm.push = {{4, 4, 4, 0, 0, 0}};
  run(400);
  const RobotState& state = unit.state();
  EXPECT_EQ(RobotMode::kGuiding, state.robot_mode);
  EXPECT_GT(std::abs(state.O_T_EE[13] - from[13]), 0.02);
  EXPECT_LT(std::abs(state.O_T_EE[12] - from[12]), 0.005);
  EXPECT_LT(std::abs(state.O_T_EE[14] - from[14]), 0.005);
  EXPECT_EQ(state.q, state.q_d) << "the desired position follows the hand";
  EXPECT_EQ((std::array<double, 7>{}), state.tau_J_d);
  arm.push.fill(0.0);
  unit.request(Guiding{false});
  run(1000);
  const std::array<double, 7> left = arm.q();
  run(500);
  expectNear(left, arm.q(), 1e-5);
}

TEST_F(UnitMotion, ImpedancesAreCheckedAtTheirBounds) {
  const std::pair<UnitRequest, Status> rows[] = {
      {codec::SetJointImpedanceRequest{{{14250, 0, 0, 0, 0, 0, 0}}}, Status::kSuccess},
      {codec::SetCartesianImpedanceRequest{{{10, 3000, 10, 1, 300, 1}}}, Status::kSuccess},
      {codec::SetJointImpedanceRequest{{{14251, 0, 0, 0, 0, 0, 0}}},
       Status::kInvalidArgumentRejected},
      {codec::SetCartesianImpedanceRequest{{{3000, 3000, 9.9, 300, 300, 300}}},
       Status::kInvalidArgumentRejected},
      {codec::SetCartesianImpedanceRequest{{{3000, 3000, 10, 300, 301, 300}}},
       Status::kInvalidArgumentRejected}};
  for (std::size_t i = 0; i < std::size(rows); i++) {
    EXPECT_EQ(rows[i].second, unit.request(rows[i].first)) << i;
  }
}

TEST_F(UnitMotion, FiltersSmoothTheCommands) {
  ASSERT_EQ(Status::kSuccess, unit.request(codec::SetFiltersRequest{1000, 10, 1000, 1000, 1000}));
  startMove(MotionGeneratorMode::kJointVelocity);
  double last = 0.0;
  const double gain = 1e-3 / (1e-3 + 1.0 / (2 * 3.14159265358979323846 * 10));
  drive(30, [&](int, const RobotState& state) {
    EXPECT_NEAR(last, state.dq_d[0], 1e-12);
    RobotCommand command;
    command.dq_c[0] = 0.1;  // a step that unfiltered is 100 rad/s^2
    last += gain * (0.1 - last);
    return command;
  });
  EXPECT_EQ(RobotMode::kMove, unit.state().robot_mode);
}

TEST_F(UnitMotion, TorqueControlThatReplacesBrakingAnswersTheStop) {
  startSwing();
  drive(500, [&](int i, const RobotState&) { return swing(i); });
  EXPECT_FALSE(unit.request(codec::StopMoveRequest{}));
  run(5);
  ASSERT_EQ(Status::kMotionStarted, unit.request(torqueControl()));
  EXPECT_EQ(Status::kSuccess, unit.takeAnswer(PendingAnswer::kStop));
}

// No request waits for ever when the arm is teleported.
TEST_F(UnitMotion, RestartAnswersAStopThatStillBrakes) {
  startSwing();
  drive(500, [&](int i, const RobotState&) { return swing(i); });
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

TEST_F(UnitMotion, RestartEndsAMotionThatCannotContinueFromTheNewPose) {
  startSwing();
  drive(500, [&](int i, const RobotState&) { return swing(i); });
  putElsewhere();
  EXPECT_EQ(Status::kAborted, unit.takeAnswer(PendingAnswer::kMotion));
  expectToStayElsewhere();
}

TEST_F(UnitMotion, RestartEndsTheAccelerationThresholds) {
  parameters.acceleration.upper_force.fill(1e3);
  rebuild();
  run(1);
  startSwing();
  drive(200, [&](int i, const RobotState&) { return swing(i); });
  ASSERT_EQ(1e3, unit.status().thresholds.upper_force[0]);
  putElsewhere();
  run(1);
  EXPECT_EQ(parameters.nominal.upper_force, unit.status().thresholds.upper_force);
}

TEST_F(UnitMotion, RestartHoldsGuidedAxesAtTheNewPose) {
  ASSERT_EQ(Status::kSuccess, unit.request(codec::SetGuidingModeRequest{{}, false}));
  unit.request(Guiding{true});
  run(10);
  putElsewhere();
  run(500);
  expectNear(kElsewhere, arm.q(), 1e-3);
}

}  // namespace

}  // namespace franka_sim::test
