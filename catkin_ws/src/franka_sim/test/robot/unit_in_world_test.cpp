// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Control unit and gripper unit on the MuJoCo physics, Panda and FR3.
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/physics/world_contacts.h>
#include <franka_sim/physics/world_pushes.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/hands/gripper_unit.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>

#include "../physics/test_support.h"
#include "arm_fixture.h"
#include "sine_driver.h"

namespace franka_sim::test {

namespace {

using franka_core::RobotState;
using Wrench = std::array<double, 6>;

class UnitInWorldTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string id() const { return GetParam(); }

  void start() {
    RobotDescription description = robot(id());
    setInitialPositions(kReady, id(), description);
    world = std::make_unique<World>(test::world("empty"));
    world->addRobot(description);
    arm = &world->arm(id(), id());
    hand = &world->hand(id(), id());
    ControlUnitParameters parameters{franka_core::ArmModel::fromUrdf(urdfOf(id()), id())};
    parameters.end_effector = handPayload(id());
    parameters.F_T_NE = kHandF_T_NE;
    if (over_fci) {
      parameters.rules = InterfaceRules::kFci;
      parameters.protocol_version = id() == "fr3" ? 10 : 5;
    }
    unit = std::make_unique<ControlUnit>(parameters);
    gripper = std::make_unique<GripperUnit>(GripperParameters{});
  }

  const RobotState& tick(const franka_core::RobotCommand* command = nullptr) {
    const RobotState& state = unit->observe(arm->measure());
    act(command);
    return state;
  }

  void act(const franka_core::RobotCommand* command) {
    arm->applyTorques(unit->actuate(command));
    arm->setBrakes(unit->status().brakes_closed);
    hand->applyForces(gripper->step(hand->measure(), 1e-3));
    world->step();
  }

  const RobotState& run(int ticks, const franka_core::RobotCommand* command = nullptr) {
    for (int i = 0; i < ticks; i++) {
      tick(command);
    }
    return unit->state();
  }

  std::array<double, 16> poseOfK() const {
    const RobotState& s = unit->state();
    return unit->configuration().model.pose(franka_core::ArmFrame::kStiffness, s.q, s.F_T_EE,
                                            s.EE_T_K);
  }

  /// Pushes the hand at K for one tick. @param push force [N] and torque [Nm], axes of O
  void pushAtK(const Wrench& push) {
    const std::array<double, 16> K = poseOfK();
    pushBody(*world, id() + "_hand", {push[0], push[1], push[2]}, {push[3], push[4], push[5]}, 1,
             {{K[12], K[13], K[14]}});
  }

  /// The arm exerts the opposite of the push, in O and in K, within 0.5 % of 10 N and of 2 Nm.
  void expectReads(const Wrench& push) const {
    const std::array<double, 16> K = poseOfK();
    const Eigen::Matrix3d R = Eigen::Map<const Eigen::Matrix4d>(K.data()).topLeftCorner<3, 3>();
    for (const int part : {0, 3}) {
      const Eigen::Vector3d expected = -Eigen::Vector3d(push.data() + part);
      const Eigen::Vector3d in_O(unit->state().O_F_ext_hat_K.data() + part);
      const Eigen::Vector3d in_K(unit->state().K_F_ext_hat_K.data() + part);
      const double tolerance = 0.005 * (part == 0 ? 10 : 2);
      EXPECT_LT((in_O - expected).cwiseAbs().maxCoeff(), tolerance)
          << testing::PrintToString(push) << ": " << in_O.transpose();
      EXPECT_LT((in_K - R.transpose() * expected).cwiseAbs().maxCoeff(), tolerance)
          << testing::PrintToString(push) << ": " << in_K.transpose();
    }
  }

  const std::array<double, 7>& speedLimits() const {
    return id() == "fr3" ? franka_core::kFr3Limits.dq : franka_core::kFerLimits.dq;
  }

  /// Brings joint 1 to a speed [rad/s] by commanded joint velocities.
  void turnFirstJoint(double speed) {
    tick();
    const auto move = moveRequest(franka_core::MotionGeneratorMode::kJointVelocity);
    ASSERT_EQ(Status::kMotionStarted, unit->request(move));
    for (int i = 0; i < 600; i++) {
      franka_core::RobotCommand command;
      command.dq_c[0] = speed * std::min(1.0, i / 400.0);
      tick(&command);
    }
    ASSERT_NEAR(speed, unit->state().dq[0], 0.01);
  }

  bool over_fci{false};
  std::unique_ptr<World> world;
  ArmPlant* arm{nullptr};
  HandPlant* hand{nullptr};
  std::unique_ptr<ControlUnit> unit;
  std::unique_ptr<GripperUnit> gripper;
};

TEST_P(UnitInWorldTest, FreeMotionAtNinetyPercentSpeedReadsNoForce) {
  start();
  tick();
  ASSERT_EQ(Status::kMotionStarted, unit->request(torqueControl()));
  SineDriver driver(unit->configuration(), unit->configuration().end_effector, 8.0, 0.9,
                    speedLimits());
  double force = 0.0;
  double moment = 0.0;
  std::array<double, 7> fastest{};
  for (int i = 0; i < 8000; i++) {
    const RobotState& state = unit->observe(arm->measure());
    for (std::size_t j = 0; j < 7; j++) {
      fastest[j] = std::max(fastest[j], std::abs(state.dq[j]) / driver.limit()[j]);
    }
    force = std::max(force, norm(state.O_F_ext_hat_K, 0, 3));
    moment = std::max(moment, norm(state.O_F_ext_hat_K, 3, 3));
    const franka_core::RobotCommand command = driver.command(state);
    act(&command);
    ASSERT_TRUE(contacts(*world).empty()) << "the motion is not free";
  }
  const double slowest = *std::min_element(fastest.begin(), fastest.end());
  std::printf("%s in free motion at %.1f %% of the speed limits: wrench error %.4f N, %.5f Nm\n",
              GetParam(), 100 * slowest, force, moment);
  EXPECT_GT(slowest, 0.88);
  // Required: 0.1 N and 0.02 Nm. This bound also detects a model evaluated at the wrong instant.
  EXPECT_LT(force, 0.005);
  EXPECT_LT(moment, 0.0005);
}

TEST_P(UnitInWorldTest, PushesOnTheHandAreReadWithinHalfAPercent) {
  start();
  const double c = std::cos(0.5235987755982988);
  ASSERT_EQ(Status::kSuccess,
            unit->request(codec::SetEEToKRequest{
                {{1, 0, 0, 0, 0, c, 0.5, 0, 0, -0.5, c, 0, 0.02, -0.03, 0.05, 1}}}));
  for (int axis = 0; axis < 6; axis++) {
    for (const double sign : {10.0, -10.0}) {
      Wrench push{};
      push[axis] = axis < 3 ? sign : 0.2 * sign;
      for (int i = 0; i < 2000; i++) {
        tick();
        pushAtK(push);
      }
      expectReads(push);
    }
  }
}

TEST_P(UnitInWorldTest, StopsAtSpeedBrakeLikeAReflexAndThenClamp) {
  for (const auto& [stop, release] :
       {std::pair{UnitRequest{UserStop{true}}, UnitRequest{UserStop{false}}},
        std::pair{UnitRequest{Brakes{true}}, UnitRequest{Brakes{false}}}}) {
    start();
    turnFirstJoint(1.0);
    const double from = unit->state().q[0];
    const double ddq = unit->limits().arm.ddq[0];
    const double jerk = unit->limits().arm.dddq[0];
    const std::array<double, 7> held = unit->state().tau_J;
    // Column of the first joint: the torques [Nm] for 1 rad/s² of it.
    const auto inertia =
        unit->configuration().model.mass(unit->state().q, unit->configuration().end_effector);
    unit->request(stop);
    double jerking = 0.0;  // the greatest step of a joint's torque that the jerk limit allows
    double furthest = from;
    double braking_torque = 0.0;   // strongest change of a joint's torque, while the motors brake
    double clamping_torque = 0.0;  // and from then on
    double steepest = 0.0;         // change of a joint's torque in a tick
    int closed = 0;
    for (int i = 0; i < 1000; i++) {
      const std::array<double, 7> before = unit->state().tau_J;
      tick();
      const RobotState& state = unit->state();
      closed += unit->status().brakes_closed ? 1 : 0;
      furthest = std::max(furthest, state.q[0]);
      for (std::size_t j = 0; j < 7; j++) {
        double& strongest = closed > 2 ? clamping_torque : braking_torque;
        strongest = std::max(strongest, std::abs(state.tau_J[j] - held[j]));
        steepest = std::max(steepest, std::abs(state.tau_J[j] - before[j]));
        jerking = std::max(jerking, std::abs(inertia[j]) * jerk * 1e-3);
      }
    }
    EXPECT_NEAR(0.5 / ddq, furthest - from, 0.001);
    EXPECT_LT(furthest - unit->state().q[0], 1e-3) << "rebounds";
    EXPECT_LT(clamping_torque, 0.25 * braking_torque) << "the brakes had to stop the arm";
    // A fifth more for the control law, which follows the desired motion.
    EXPECT_LT(steepest, 1.2 * jerking);
    EXPECT_GT(closed, 700);
    EXPECT_EQ((std::array<double, 7>{}), unit->state().joint_collision);
    const std::array<double, 7> stopped = unit->state().q;
    run(1000);
    for (std::size_t j = 0; j < 7; j++) {
      EXPECT_NEAR(stopped[j], unit->state().q[j], 1e-6);
      EXPECT_NEAR(0.0, unit->state().tau_ext_hat_filtered[j], 0.01);
    }
    unit->request(release);
    run(1000);
    expectNear(stopped, unit->state().q, 1e-4);
  }
}

TEST_P(UnitInWorldTest, CollisionRaisesAReflexWithinThreeMilliseconds) {
  // Down onto the ground with the fingers; the ground is completely rigid.
  over_fci = true;
  start();
  tick();
  const auto move = moveRequest(franka_core::MotionGeneratorMode::kCartesianVelocity);
  ASSERT_EQ(franka_core::fci::Status::kMotionStarted, unit->request(move));
  const double threshold = unit->configuration().nominal.upper_force[2];
  int crossed = -1;
  int reflex = -1;
  double top = 0.0;
  for (int i = 0; i < 10000 && reflex < 0; i++) {
    franka_core::RobotCommand command;
    command.O_dP_EE_c[2] = -0.1 * std::min(1.0, i / 300.0);
    tick(&command);
    double force = 0.0;
    for (const Contact& contact : contacts(*world)) {
      force += std::abs(contact.force[2]);
    }
    top = std::max(top, force);
    if (crossed < 0 && force > threshold) {
      crossed = i;
    }
    if (unit->state().robot_mode != franka_core::RobotMode::kMove) {
      reflex = i;
    }
  }
  ASSERT_GE(crossed, 0) << "nothing was touched";
  ASSERT_GE(reflex, 0);
  std::printf("%s hits the ground at 0.1 m/s: reflex %d ms after the threshold, %.1f N\n",
              GetParam(), reflex - crossed, top);
  EXPECT_LE(reflex - crossed, 3);
  const RobotState& state = unit->state();
  EXPECT_EQ(franka_core::RobotMode::kReflex, state.robot_mode);
  EXPECT_TRUE(state.errors[6] || state.errors[7]);
  EXPECT_EQ(state.errors, state.reflex_reason);
  EXPECT_EQ(franka_core::fci::Status::kReflexAborted, unit->takeAnswer(PendingAnswer::kMotion));

  run(300);
  ASSERT_FALSE(unit->request(codec::AutomaticErrorRecoveryRequest{}));
  run(500);
  EXPECT_EQ(franka_core::fci::Status::kSuccess, unit->takeAnswer(PendingAnswer::kRecovery));
  ASSERT_EQ(franka_core::RobotMode::kIdle, state.robot_mode);
  ASSERT_EQ(franka_core::fci::Status::kMotionStarted, unit->request(move));
  const double from = state.O_T_EE[14];
  for (int i = 0; i < 1000; i++) {
    franka_core::RobotCommand command;
    command.O_dP_EE_c[2] = 0.1 * std::min(1.0, i / 300.0);
    tick(&command);
  }
  EXPECT_EQ(franka_core::RobotMode::kMove, state.robot_mode) << "motion away is allowed";
  EXPECT_GT(state.O_T_EE[14], from + 0.05);
}

INSTANTIATE_TEST_SUITE_P(Robots, UnitInWorldTest, ::testing::Values("panda", "fr3"));

}  // namespace

}  // namespace franka_sim::test
