// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The parts of a control unit, each without the others.
#include <franka_sim/robot/configuration.h>
#include <franka_sim/robot/control_laws.h>
#include <franka_sim/robot/motion_supervisor.h>
#include <franka_sim/robot/pending_answers.h>
#include <franka_sim/robot/rest_sequence.h>
#include <franka_sim/robot/state_estimator.h>

#include <Eigen/Geometry>
#include <random>

#include "fci_fixture.h"

namespace franka_sim::test {

namespace {

using Joints = std::array<double, 7>;

// --- PendingAnswers ------------------------------------------------------------------------------

TEST(PendingAnswers, GivesEachAnswerOnce) {
  PendingAnswers answers;
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kRecovery));
  answers.recoveryEnds(Status::kSuccess);
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kMotion));
  EXPECT_EQ(Status::kSuccess, answers.take(PendingAnswer::kRecovery));
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kRecovery));
}

TEST(PendingAnswers, MotionAndStopWaitForRest) {
  PendingAnswers answers;
  answers.stopBegins();
  answers.motionEndsAtRest(Status::kPreempted);
  EXPECT_TRUE(answers.waitForRest());
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kMotion));
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kStop));
  answers.atRest();
  EXPECT_FALSE(answers.waitForRest());
  EXPECT_EQ(Status::kPreempted, answers.take(PendingAnswer::kMotion));
  EXPECT_EQ(Status::kSuccess, answers.take(PendingAnswer::kStop));
}

TEST(PendingAnswers, InterruptionReplacesSuccessOnly) {
  for (const Status own : {Status::kSuccess, Status::kPreempted}) {
    PendingAnswers answers;
    answers.motionEndsAtRest(own);
    answers.interruptMotion(Status::kReflexAborted);
    EXPECT_EQ(own == Status::kSuccess ? Status::kReflexAborted : own,
              answers.take(PendingAnswer::kMotion));
    EXPECT_FALSE(answers.waitForRest());
  }
}

TEST(PendingAnswers, StopIsInterruptedOnlyWhileItWaits) {
  PendingAnswers answers;
  answers.interruptStop(Status::kReflexAborted);
  EXPECT_EQ(std::nullopt, answers.take(PendingAnswer::kStop));
  answers.stopBegins();
  answers.interruptStop(Status::kReflexAborted);
  answers.atRest();
  EXPECT_EQ(Status::kReflexAborted, answers.take(PendingAnswer::kStop));
}

// --- RestSequence --------------------------------------------------------------------------------

const Joints kSwing{{0.3, 0, 0, 0, 0, 0, 0}};
const Joints kRate{{10, 10, 10, 10, 10, 10, 10}};  // [rad/s^2]: kSwing stops within 30 ms

TEST(RestSequence, BrakesAtTheGivenRateAndStops) {
  RestSequence rest;
  EXPECT_EQ(RestSequence::Step::kNone, rest.step(false, kReady, {}, kRate));
  rest.brake(kReady, kSwing, kRate);
  int ticks = 1;
  while (rest.step(false, kReady, {}, kRate) == RestSequence::Step::kBrakes) {
    ASSERT_TRUE(rest.isBraking());
    ASSERT_LT(++ticks, 1000);
  }
  EXPECT_TRUE(rest.isFinished());
  EXPECT_NEAR(30, ticks, 1);
  EXPECT_NEAR(kReady[0] + 0.3 * 0.3 / 20.0, rest.braking().q()[0], 2e-4);
  EXPECT_EQ(Joints{}, rest.braking().dq());
}

TEST(RestSequence, YieldsForTwoHundredTicksAfterAReflex) {
  RestSequence rest;
  rest.brake(kReady, {}, kRate);
  EXPECT_EQ(RestSequence::Step::kStops, rest.step(true, kReady, {}, kRate));
  int yielded = 0;
  while (rest.step(true, kReady, {}, kRate) == RestSequence::Step::kYields) {
    ASSERT_LT(++yielded, 1000);
  }
  EXPECT_EQ(200, yielded);
  EXPECT_TRUE(rest.isFinished());
}

TEST(RestSequence, BrakesAnewFromTheMeasuredMotionWhenAReflexTakesTooLong) {
  const Joints slow{{1, 1, 1, 1, 1, 1, 1}};
  Joints met = kReady;
  met[0] += 0.01;
  RestSequence rest;
  rest.brake(kReady, {{0.5, 0, 0, 0, 0, 0, 0}}, slow);  // takes 500 ms
  for (int i = 0; i < 199; i++) {
    EXPECT_EQ(RestSequence::Step::kBrakes, rest.step(true, met, {}, slow));
  }
  EXPECT_GT(rest.braking().q()[0], met[0]);
  EXPECT_EQ(RestSequence::Step::kStops, rest.step(true, met, {}, slow));
  EXPECT_EQ(met, rest.braking().q());
}

// --- TorqueCommand, VirtualWalls -----------------------------------------------------------------

TEST(TorqueCommand, StepsAreJudgedFromTheCommandedAndFromTheSaturatedTorque) {
  struct Row {
    double before, next;  // of joint 1, whose motor gives 87 Nm [Nm]
    bool jumps;
  };
  const Row rows[] = {
      {10.0, 11.0, false}, {10.0, 11.1, true},  // 1 Nm in a tick
      {88.5, 89.4, false},                      // near the commanded torque only
      {88.5, 86.1, false},                      // near the saturated torque only
      {88.5, 90.0, true},  {88.5, 85.9, true}, {-95, -86.5, false}, {-95, -85.9, true},
  };
  for (const Row& row : rows) {
    TorqueCommand command(std::array<double, 7>{{87, 87, 87, 87, 12, 12, 12}});
    ASSERT_TRUE(command.receive({{row.before, 0, 0, 0, 0, 0, 0}}));
    EXPECT_EQ(row.jumps, command.jumps({{row.next, 0, 0, 0, 0, 0, 0}}))
        << row.before << " to " << row.next;
  }
}

TEST(VirtualWalls, AreMetWhereATurnedCuboidStands) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  int inside = 0;
  for (int k = 0; k < 2000; k++) {
    Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    pose.translation() << 0.3 * uniform(random), 0.3 * uniform(random), 0.3 * uniform(random);
    pose.linear() =
        Eigen::AngleAxisd(3.1 * uniform(random),
                          Eigen::Vector3d(uniform(random), uniform(random), 1.0).normalized())
            .toRotationMatrix();
    codec::CartesianLimit wall;
    wall.object_world_size = {{0.3, 0.6, 0.9}};
    Eigen::Map<Eigen::Matrix4d>(wall.object_frame.data()) = pose.matrix();
    wall.active = true;
    VirtualWalls walls;
    ASSERT_TRUE(walls.set(0, wall));
    Transform far = franka_core::kIdentityTransform;
    far[12] = 5.0;
    walls.begin(far);

    Transform hand = franka_core::kIdentityTransform;
    for (const std::size_t i : {12, 13, 14}) {
      hand[i] = 0.6 * uniform(random);
    }
    const Eigen::Vector3d local = pose.inverse() * Eigen::Vector3d(hand[12], hand[13], hand[14]);
    const bool expected =
        local.cwiseAbs().x() < 0.15 && local.cwiseAbs().y() < 0.3 && local.cwiseAbs().z() < 0.45;
    EXPECT_EQ(expected, walls.violated(hand)) << k;
    inside += expected ? 1 : 0;
  }
  EXPECT_GT(inside, 100);
}

// --- the three parts -----------------------------------------------------------------------------

/// The parts over one configuration and one state, without the unit around them.
class UnitParts : public ::testing::Test {
 protected:
  static ControlUnitParameters overFci() {
    ControlUnitParameters parameters = pandaWithHand();
    parameters.rules = InterfaceRules::kFci;
    return parameters;
  }

  void measure(const Joints& q) {
    ArmMeasurement measurement;
    measurement.q = q;
    measurement.tau_J = estimator.estimate().dynamics.gravity;
    estimator.update(measurement, configuration.parameters().nominal);
  }

  Configuration configuration{overFci()};
  franka_core::RobotState state;
  StateEstimator estimator{configuration, state};
};

TEST_F(UnitParts, ConfigurationKeepsItsValuesWhenARequestIsRefused) {
  const std::array<double, 7> before = configuration.jointStiffness();
  EXPECT_EQ(Status::kInvalidArgumentRejected,
            configuration.apply(codec::SetJointImpedanceRequest{{{-1, 0, 0, 0, 0, 0, 0}}}));
  EXPECT_EQ(before, configuration.jointStiffness());
  CollisionThresholds good = configuration.parameters().nominal;
  CollisionThresholds bad = good;
  good.upper_force.fill(33);
  bad.upper_force[0] = -1;
  EXPECT_EQ(Status::kInvalidArgumentRejected, configuration.apply(collisionRequest(good, bad)));
  EXPECT_NE(good.upper_force, configuration.parameters().acceleration.upper_force);
  EXPECT_EQ(Status::kInvalidArgumentRejected, configuration.apply(SetProtocolVersion{11}));
  EXPECT_EQ(5u, configuration.parameters().protocol_version);
}

TEST_F(UnitParts, EstimatorReadsNoForceAtRestAndTheTorqueThatIsAdded) {
  measure(kReady);
  EXPECT_TRUE(estimator.estimate().first && !estimator.estimate().measured);
  EXPECT_EQ(estimator.estimate().dynamics.gravity, state.tau_J);
  measure(kReady);
  EXPECT_TRUE(!estimator.estimate().first && estimator.estimate().measured);
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_NEAR(0.0, estimator.estimate().tau_ext[i], 1e-9) << i;
  }
  ArmMeasurement pushed{kReady, {}, estimator.estimate().dynamics.gravity};
  pushed.tau_J[3] -= 4.0;
  estimator.update(pushed, configuration.parameters().nominal);
  EXPECT_NEAR(4.0, std::abs(estimator.estimate().tau_ext[3]), 1e-9);
}

TEST_F(UnitParts, LawsCompensateGravityAndSaturateTheCommand) {
  measure(kReady);
  ControlLaws laws(configuration);
  ControlTask task;
  task.mode = RobotMode::kMove;
  task.controller = ControllerMode::kExternalController;
  task.tau = {{1, -2, 3, 1000, 0, 0, 0}};
  task.law_switch = LawSwitch::kFromZero;
  const Estimate& estimate = estimator.estimate();
  const Joints& torques = laws.torques(task, state, estimate);
  const Joints expected{{1, -2, 3, 87, 0, 0, 0}};
  EXPECT_EQ(expected, laws.law());
  for (std::size_t i = 0; i < 7; i++) {
    EXPECT_NEAR(expected[i] + estimate.dynamics.gravity[i], torques[i], 1e-12) << i;
  }
  EXPECT_EQ(Joints{}, laws.rest());
}

TEST_F(UnitParts, LawsFadeFromOneLawToTheNext) {
  measure(kReady);
  ControlLaws laws(configuration);
  ControlTask task;
  task.mode = RobotMode::kMove;
  task.controller = ControllerMode::kExternalController;
  task.tau = {{10, 0, 0, 0, 0, 0, 0}};
  task.law_switch = LawSwitch::kFromZero;
  const Estimate& estimate = estimator.estimate();
  laws.torques(task, state, estimate);
  task.tau.fill(0.0);
  task.law_switch = LawSwitch::kBlend;
  EXPECT_NEAR(9.0, laws.torques(task, state, estimate)[0] - estimate.dynamics.gravity[0], 1e-12)
      << "1000 Nm/s (protocol 5.5)";
}

TEST_F(UnitParts, SupervisorStartsAMotionOnlyAfterAMeasurement) {
  MotionSupervisor supervisor(configuration, estimator, state);
  EXPECT_EQ(Status::kCommandNotPossibleRejected, supervisor.handle(torqueControl()));
  measure(kReady);
  supervisor.judge({});
  EXPECT_EQ(Status::kMotionStarted, supervisor.handle(torqueControl()));
  EXPECT_EQ(LawSwitch::kFromZero, supervisor.takeTask().law_switch);
  EXPECT_EQ(LawSwitch::kNone, supervisor.takeTask().law_switch);
}

TEST_F(UnitParts, SupervisorHandsTheCommandedTorqueToTheLaws) {
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
