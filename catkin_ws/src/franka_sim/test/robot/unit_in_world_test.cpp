// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Control unit and gripper unit on the MuJoCo physics, Panda and FR3.
#include <franka_sim/physics/physics_config.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/hands/gripper_unit.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
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

/// Center of mass of the link hand, in its own frame [m].
Eigen::Vector3d handCenter(const std::string& id) {
  return id == "fr3"
             ? Eigen::Vector3d(-0.00737411357523114, -0.00737411357523114, 0.0287828571428571)
             : Eigen::Vector3d(-0.01, 0.0, 0.03);
}
/// The URDF's text for the mass of the link hand, with some kilograms more.
std::string handMass(const std::string& id, int more) {
  return "<mass value=\"" + std::to_string(more) + (id == "fr3" ? ".7\"" : ".73\"");
}

/// Velocity of a point of a body in the world [m/s]. @param point in the body's frame
Eigen::Vector3d velocityOf(const World& world, const std::string& body,
                           const Eigen::Vector3d& point) {
  const BodyState state = bodyState(world, body);
  const Eigen::Vector3d lever = toEigen(state.pose).linear() * point;
  return Eigen::Vector3d(state.twist.linear.data()) +
         Eigen::Vector3d(state.twist.angular.data()).cross(lever);
}

class UnitInWorldTest : public ::testing::TestWithParam<const char*> {
 protected:
  std::string id() const { return GetParam(); }

  /// @param change of the robot's URDF, e.g. a heavier hand than the unit knows
  void start(const std::string& scene, const std::string& from = "", const std::string& to = "") {
    RobotDescription description = robot(id());
    if (!from.empty()) {
      EXPECT_NE(std::string::npos, description.urdf.find(from)) << "the test data has changed";
      description.urdf = replaceAll(description.urdf, from, to);
    }
    if (scene == "stone") {
      description.base.position = {{-0.5, 0, 0.3}};
      description.initial_positions[id() + "_finger_joint1"] = 0.03;
    }
    setInitialPositions(kReady, id(), description);
    world = std::make_unique<World>(test::world(scene));
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

  GripperOutcome finish(GripperUnit::Ticket ticket) {
    for (int i = 0; i < 10000 && gripper->outcome(ticket) == GripperOutcome::kRunning; i++) {
      tick();
    }
    return gripper->outcome(ticket);
  }

  /// Moves, then grasps the stone with 5 N.
  void graspTheStone() {
    run(10);
    EXPECT_EQ(GripperOutcome::kSucceeded, finish(gripper->move(0.08, 0.1)));
    EXPECT_NEAR(0.08, gripper->width(), 1e-3);
    EXPECT_EQ(GripperOutcome::kSucceeded, finish(gripper->move(0.05, 0.1)));
    EXPECT_NEAR(0.05, gripper->width(), 1e-3);
    // The stone's 32 mm are in the fingers' direction; at first nothing holds it.
    setBodyPose(*world, "stone", bodyPose(*world, id() + "_hand_tcp"));
    const GripperUnit::Ticket grasp = gripper->grasp(0.032, 0.005, 0.005, 0.1, 5);
    while (gripper->outcome(grasp) == GripperOutcome::kRunning) {
      if (gripper->width() > 0.0325) {
        setBodyPose(*world, "stone", bodyPose(*world, id() + "_hand_tcp"));
      }
      tick();
    }
    EXPECT_EQ(GripperOutcome::kSucceeded, gripper->outcome(grasp));
    run(1000);
    EXPECT_TRUE(gripper->isGrasped());
  }

  /// Where the stone is in the frame of the tool center point [m].
  Eigen::Vector3d stoneInHand() const {
    return (toEigen(bodyPose(*world, id() + "_hand_tcp")).inverse() *
            toEigen(bodyPose(*world, "stone")))
        .translation();
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
  start("empty");
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
  start("empty");
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

TEST_P(UnitInWorldTest, UnconfiguredKilogramReadsWeightAndInertiaAtFullSpeed) {
  // A point of 1 kg at the hand's center of mass: the arm always exerts m (a - g) on it. Its
  // acceleration is the difference of its velocity in the world. The second difference of its
  // position is wrong by a quarter of the acceleration in a tick in which the number of physics
  // steps changes (decision 58).
  start("empty", handMass(id(), 0), handMass(id(), 1));
  tick();
  ASSERT_EQ(Status::kMotionStarted, unit->request(torqueControl()));
  SineDriver driver(unit->configuration(), unit->configuration().end_effector, 4.0, 0.5,
                    speedLimits());
  const Eigen::Vector3d in_hand = handCenter(id());
  constexpr double kSmoothing = 1e-3 / (1e-3 + 1.0 / (2 * 3.14159265358979324 * 100));
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero();
  Eigen::Vector3d expected(0, 0, 9.81);
  double worst = 0.0;
  double strongest = 0.0;
  for (int i = 0; i < 6000; i++) {
    const RobotState& state = unit->observe(arm->measure());
    const Eigen::Vector3d before = velocity;
    velocity = velocityOf(*world, id() + "_hand", in_hand);
    if (i > 0) {
      const Eigen::Vector3d a = (velocity - before) / World::kTick;
      expected += kSmoothing * (a + Eigen::Vector3d(0, 0, 9.81) - expected);
    }
    if (i > 100) {
      const Eigen::Vector3d read(state.O_F_ext_hat_K.data());
      worst = std::max(worst, (read - expected).norm());
      strongest = std::max(strongest, (expected - Eigen::Vector3d(0, 0, 9.81)).norm());
    }
    const franka_core::RobotCommand command = driver.command(state);
    act(&command);
  }
  std::printf("%s with 1 kg too much: inertial forces up to %.2f N, worst error %.4f N\n",
              GetParam(), strongest, worst);
  EXPECT_GT(strongest, 3.0);
  EXPECT_LT(worst, 0.1);
}

TEST_P(UnitInWorldTest, StopsAtSpeedBrakeLikeAReflexAndThenClamp) {
  for (const UnitRequest& stop : {UnitRequest{UserStop{true}}, UnitRequest{Brakes{true}}}) {
    start("empty");
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
    int braking = 0;
    int closed = 0;
    for (int i = 0; i < 1000; i++) {
      const double desired = unit->state().dq_d[0];
      const double acceleration = unit->state().ddq_d[0];
      const std::array<double, 7> before = unit->state().tau_J;
      tick();
      const RobotState& state = unit->state();
      if (state.dq_d[0] > 0.0) {
        braking++;
        EXPECT_LE(desired - state.dq_d[0], ddq * 1e-3 + 1e-9);
        EXPECT_LE(std::abs(state.ddq_d[0] - acceleration), jerk * 1e-3 + 1e-6);
      }
      closed += unit->status().brakes_closed ? 1 : 0;
      furthest = std::max(furthest, state.q[0]);
      for (std::size_t j = 0; j < 7; j++) {
        EXPECT_LT(std::abs(state.tau_J[j]), unit->configuration().max_torque[j]);
        double& strongest = closed > 2 ? clamping_torque : braking_torque;
        strongest = std::max(strongest, std::abs(state.tau_J[j] - held[j]));
        steepest = std::max(steepest, std::abs(state.tau_J[j] - before[j]));
        jerking = std::max(jerking, std::abs(inertia[j]) * jerk * 1e-3);
      }
    }
    const double rebound = furthest - unit->state().q[0];
    std::printf(
        "%s stops from 1 rad/s: %d ms, %.1f mrad, rebound %.3f mrad; torques change by %.1f "
        "Nm, after the brakes have closed by %.1f Nm, in a tick by at most %.2f Nm (jerk limit "
        "%.2f)\n",
        GetParam(), braking, 1e3 * (furthest - from), 1e3 * rebound, braking_torque,
        clamping_torque, steepest, jerking);
    EXPECT_NEAR(1.0 / ddq * 1e3, braking, 2);
    EXPECT_NEAR(0.5 / ddq, furthest - from, 0.001);
    EXPECT_LT(rebound, 1e-3);
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
  }
}

TEST_P(UnitInWorldTest, UserStopKeepsTheGraspedStone) {
  start("stone");
  graspTheStone();
  const Eigen::Vector3d held = stoneInHand();
  turnFirstJoint(1.0);
  unit->request(UserStop{true});
  run(1000);
  EXPECT_TRUE(unit->status().brakes_closed);
  EXPECT_TRUE(gripper->isGrasped());
  EXPECT_LT((stoneInHand() - held).norm(), 1e-3);
}

TEST_P(UnitInWorldTest, CollisionRaisesAReflexWithinThreeMilliseconds) {
  // Down onto the ground with the fingers; the ground is completely rigid.
  over_fci = true;
  start("empty");
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

TEST_P(UnitInWorldTest, InternalControllersHaveTheConfiguredStiffness) {
  for (const bool cartesian : {false, true}) {
    over_fci = true;
    start("empty");
    tick();
    const std::array<double, 6> K{{500, 500, 500, 30, 30, 30}};
    ASSERT_EQ(Status::kSuccess, unit->request(codec::SetCartesianImpedanceRequest{K}));
    ASSERT_EQ(
        Status::kSuccess,
        unit->request(codec::SetJointImpedanceRequest{{{600, 600, 600, 600, 300, 300, 300}}}));
    const auto move = moveRequest(franka_core::MotionGeneratorMode::kJointPosition,
                                  cartesian ? franka_core::ControllerMode::kCartesianImpedance
                                            : franka_core::ControllerMode::kJointImpedance);
    ASSERT_EQ(franka_core::fci::Status::kMotionStarted, unit->request(move));
    franka_core::RobotCommand hold;
    hold.q_c = unit->state().q_d;
    run(100, &hold);
    const RobotState before = unit->state();
    pushBody(*world, id() + "_hand", {{0, 4, 0}}, {{0, 0, 0}}, 7000);
    run(6900, &hold);
    const RobotState& s = unit->state();
    if (!cartesian) {
      for (std::size_t i = 0; i < 7; i++) {
        const double k = i < 4 ? 600 : 300;
        EXPECT_NEAR(s.tau_ext_hat_filtered[i], k * (s.q_d[i] - s.q[i]), 0.005 * k * 1e-2);
      }
      continue;
    }
    // The reported force is that of the robot's own spring (decision 4).
    const double force = 500 * (before.O_T_EE_d[13] - s.O_T_EE[13]);
    EXPECT_NEAR(s.O_F_ext_hat_K[1], force, 0.005 * 4) << GetParam();
    EXPECT_NEAR(-4.0, s.O_F_ext_hat_K[1], 0.02);
  }
}

INSTANTIATE_TEST_SUITE_P(Robots, UnitInWorldTest, ::testing::Values("panda", "fr3"));

}  // namespace

}  // namespace franka_sim::test
