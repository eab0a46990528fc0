// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Commands of controllers on their way to the control unit.

#include <franka/rate_limiting.h>
#include <franka_core/motion_limits.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim_mujoco/command_shaper.h>
#include <franka_sim_mujoco/sim_arm.h>
#include <gtest/gtest.h>
#include <transform_sweep.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/arm_fixture.h"
#include "robot/motion/joint_motion.h"

namespace franka_sim_mujoco {
namespace {

franka_core::MotionLimits limitsOf(unsigned protocol) {
  return franka_core::motionLimitsOfProtocol(protocol);
}

TEST(CommandShaper, PassesCommandsWithinTheLimits) {
  ShapingOptions options;
  options.cutoff_frequency = 1000.0;
  franka_core::RobotState state{};
  state.message_id = 7;
  ArmCommands desired;
  desired.torque.fill(3.0);
  desired.velocity.fill(1e-6);
  const auto mode = franka_hw::ControlMode::JointTorque | franka_hw::ControlMode::JointVelocity;
  const franka_core::RobotCommand command =
      shapeCommand(options, mode, desired, state, limitsOf(5));
  EXPECT_EQ(7u, command.message_id);
  EXPECT_EQ(desired.torque, command.tau_J_d) << "torques are limited only where reflexes act";
  for (std::size_t i = 0; i < 7; ++i) {
    EXPECT_NEAR(1e-6, command.dq_c[i], 1e-15);
  }
  options.torques = true;
  EXPECT_NEAR(1.0, shapeCommand(options, mode, desired, state, limitsOf(5)).tau_J_d[3], 1e-5);
}

TEST(CommandShaper, PassesNonFiniteCommandsToTheRobot) {
  ArmCommands desired;
  desired.position[2] = std::nan("");
  desired.pose[0] = 2.0;
  const franka_core::RobotState state{};
  const auto position =
      shapeCommand({}, franka_hw::ControlMode::JointPosition, desired, state, limitsOf(5));
  EXPECT_TRUE(std::isnan(position.q_c[2]));
  ShapingOptions limited;
  limited.cutoff_frequency = 1000.0;
  const auto pose =
      shapeCommand(limited, franka_hw::ControlMode::CartesianPose, desired, state, limitsOf(5));
  EXPECT_EQ(2.0, pose.O_T_EE_c[0]);
}

/// An arm under ros_control whose Cartesian pose controller has just started.
struct PoseControlledArm {
  PoseControlledArm(const franka_sim::ControlUnitParameters& parameters,
                    const ShapingOptions& shaping)
      : plant(parameters.model, franka_sim::test::kReady),
        arm(parameters, plant, options(shaping)) {
    plant.payload = parameters.end_effector;
    arm.read(ros::Time(1));
    arm.control(franka_hw::ControlMode::CartesianPose, franka_hw::ControlMode::None);
  }
  static SimArmOptions options(const ShapingOptions& shaping) {
    SimArmOptions options;
    options.shaping = shaping;
    return options;
  }
  void tick() {
    arm.approachCommands();
    arm.write();
    plant.step();
    arm.read(ros::Time(1));
  }

  franka_sim::test::FakeArm plant;
  SimArm arm;
};

TEST(CommandShaper, PoseHandlesAcceptTheSamePosesAsTheRobot) {
  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  for (const bool reflexes : {false, true}) {
    for (const bool limited : {false, true}) {
      for (const double cutoff : {100.0, 1000.0}) {
        parameters.rules = reflexes ? franka_sim::InterfaceRules::kRosControlWithReflexes
                                    : franka_sim::InterfaceRules::kRosControl;
        ShapingOptions shaping;
        shaping.rate_limiting = limited;
        shaping.cutoff_frequency = cutoff;
        const std::array<double, 16> pose =
            PoseControlledArm(parameters, shaping).arm.commands().pose;
        for (const franka_test::PerturbedMatrix& perturbed : franka_test::perturbations(pose)) {
          PoseControlledArm controlled(parameters, shaping);
          ASSERT_EQ(SimArm::Switch::kDone, controlled.arm.switchResult());
          controlled.arm.commands().pose = perturbed.matrix;
          controlled.tick();
          controlled.tick();
          const bool runs = controlled.arm.state().robot_mode == franka::RobotMode::kMove;
          EXPECT_EQ(perturbed.accepted, runs) << perturbed << ", reflexes " << reflexes
                                              << ", limited " << limited << ", cutoff " << cutoff;
          EXPECT_EQ(perturbed.accepted ? 0u : 1u, controlled.arm.lastAbort().count) << perturbed;
          EXPECT_EQ(
              !perturbed.accepted,
              controlled.arm.lastAbort().errors[franka_core::indexOf(
                  franka_core::RobotError::kCartesianPositionMotionGeneratorInvalidFrameFlag)]);
        }
      }
    }
  }
}

// libfranka's filters throw then.
TEST(CommandShaper, PassesCommandsUnshapedIfTheStateIsNotFinite) {
  using franka_hw::ControlMode;
  franka_core::RobotState state{};
  state.q_d[0] = state.dq_d[1] = state.O_T_EE_c[12] = state.O_dP_EE_c[2] = state.tau_J_d[3] = NAN;
  state.message_id = 11;
  ShapingOptions options;
  options.torques = true;
  ArmCommands desired;
  desired.position.fill(0.1);
  desired.velocity.fill(0.2);
  desired.pose = franka_core::kIdentityTransform;
  desired.twist.fill(0.3);
  desired.torque.fill(0.4);
  const auto shaped = [&](ControlMode mode) {
    return shapeCommand(options, mode, desired, state, limitsOf(5));
  };
  EXPECT_EQ(11U, shaped(ControlMode::JointPosition).message_id);
  EXPECT_EQ(desired.position, shaped(ControlMode::JointPosition).q_c);
  EXPECT_EQ(desired.velocity, shaped(ControlMode::JointVelocity).dq_c);
  EXPECT_EQ(desired.pose, shaped(ControlMode::CartesianPose).O_T_EE_c);
  EXPECT_EQ(desired.twist, shaped(ControlMode::CartesianVelocity).O_dP_EE_c);
  EXPECT_EQ(desired.torque, shaped(ControlMode::JointTorque).tau_J_d);
}

/// The robot itself checks the shaped commands of a controller that jumps.
class ShapedMotion : public testing::TestWithParam<unsigned> {};

TEST_P(ShapedMotion, IsNeverRefused) {
  const franka_core::MotionLimits limits = limitsOf(GetParam());
  for (const double cutoff : {100.0, 1000.0}) {
    ShapingOptions options;
    options.cutoff_frequency = cutoff;
    franka_sim::JointMotion motion;
    franka_core::RobotState state{};
    state.q_d = {{0.0, -0.8, 0.0, -2.0, 0.0, 1.6, 0.0}};
    motion.start(state.q_d);
    ArmCommands desired;
    for (int tick = 0; tick < 4000; ++tick) {
      desired.velocity.fill(tick / 250 % 2 == 0 ? 0.7 : -0.7);  // jumps every quarter of a second
      const auto command =
          shapeCommand(options, franka_hw::ControlMode::JointVelocity, desired, state, limits);
      ASSERT_FALSE(motion.takeVelocities(command.dq_c, limits)) << tick;
      state.q_d = motion.last().q;
      state.dq_d = motion.last().dq;
      state.ddq_d = motion.last().ddq;
    }
    EXPECT_NEAR(-0.7, state.dq_d[0], 1e-2);
  }
}

INSTANTIATE_TEST_SUITE_P(PandaAndFr3, ShapedMotion, testing::Values(5u, 10u));

/// The limiter of the original, joint by joint, as its published formulas have it.
double limitedAsInTheOriginal(double position, double last, double velocity, double acceleration,
                              double max_velocity, double max_acceleration, double max_jerk) {
  constexpr double kT = 0.001;
  const double jerk = (((position - last) / kT - velocity) / kT - acceleration) / kT;
  const double free = acceleration + std::clamp(jerk, -max_jerk, max_jerk) * kT;
  const double highest =
      std::min(max_jerk / max_acceleration * (max_velocity - velocity), max_acceleration);
  const double lowest =
      std::max(max_jerk / max_acceleration * (-max_velocity - velocity), -max_acceleration);
  return last + (velocity + std::max(std::min(free, highest), lowest) * kT) * kT;
}

/// A controller whose position setpoints come in steps. Joint 1 of a Panda, whose limits are
/// constant.
class ShapedSetpoints : public testing::TestWithParam<double> {};

TEST_P(ShapedSetpoints, MoveTheArmAsTheLimiterOfTheOriginal) {
  const franka_core::MotionLimits limits = limitsOf(5);
  const double cutoff = GetParam();
  ShapingOptions options;
  options.cutoff_frequency = cutoff;
  const double gain = cutoff >= 1000.0 ? 1.0 : 0.001 / (0.001 + 1.0 / (2.0 * M_PI * cutoff));
  for (const double step : {0.05, 0.5}) {
    franka_sim::JointMotion motion;
    franka_core::RobotState state{};
    state.q_d = {{0.0, -0.8, 0.0, -2.0, 0.0, 1.6, 0.0}};
    motion.start(state.q_d);
    ASSERT_FALSE(motion.takePositions(state.q_d, limits));
    ArmCommands desired;
    desired.position = state.q_d;
    desired.position[0] = step;
    double q = 0.0;
    double dq = 0.0;
    double ddq = 0.0;
    double fastest = 0.0;
    for (int tick = 0; tick < 3000; ++tick) {
      const auto command =
          shapeCommand(options, franka_hw::ControlMode::JointPosition, desired, state, limits);
      ASSERT_FALSE(motion.takePositions(command.q_c, limits)) << tick;
      state.q_d = motion.last().q;
      state.dq_d = motion.last().dq;
      state.ddq_d = motion.last().ddq;
      fastest = std::max(fastest, std::abs(state.dq_d[0]));
      const double next = limitedAsInTheOriginal(
          gain * step + (1.0 - gain) * q, q, dq, ddq, franka::kMaxJointVelocity[0],
          franka::kMaxJointAcceleration[0], franka::kMaxJointJerk[0]);
      ddq = ((next - q) / 0.001 - dq) / 0.001;
      dq = (next - q) / 0.001;
      q = next;
      ASSERT_NEAR(q, state.q_d[0], 1e-6) << tick;
    }
    EXPECT_LT(fastest, limits.arm.dq[0]);
  }
}

INSTANTIATE_TEST_SUITE_P(CutoffFrequencies, ShapedSetpoints,
                         testing::Values(3.0, 10.0, 100.0, 1000.0));

/// An FR3's velocity limits fall towards the joints' ends faster than joints 5 and 7 can brake.
class ShapedMotionToTheEnds : public testing::TestWithParam<unsigned> {};

TEST_P(ShapedMotionToTheEnds, ComesToRestWithoutRefusal) {
  const franka_core::MotionLimits limits = limitsOf(GetParam());
  for (const double towards : {-20.0, 20.0}) {
    ShapingOptions options;
    options.cutoff_frequency = 1000.0;
    franka_sim::JointMotion motion;
    franka_core::RobotState state{};
    state.q_d = {{0.0, -0.8, 0.0, -2.0, 0.0, 1.6, 0.0}};
    motion.start(state.q_d);
    ArmCommands desired;
    desired.velocity.fill(towards);
    std::array<double, 7> fastest{};
    for (int tick = 0; tick < 10000; ++tick) {
      const auto command =
          shapeCommand(options, franka_hw::ControlMode::JointVelocity, desired, state, limits);
      ASSERT_FALSE(motion.takeVelocities(command.dq_c, limits)) << tick << " " << towards;
      state.q_d = motion.last().q;
      state.dq_d = motion.last().dq;
      state.ddq_d = motion.last().ddq;
      for (std::size_t i = 0; i < 7; ++i) {
        fastest[i] = std::max(fastest[i], std::abs(state.dq_d[i]));
      }
    }
    for (std::size_t i = 0; i < 7; ++i) {
      EXPECT_GT(fastest[i], 1.0) << i;
      EXPECT_NEAR(0.0, state.dq_d[i], 1e-2) << i;
      EXPECT_LT(
          towards > 0 ? limits.arm.q_max[i] - state.q_d[i] : state.q_d[i] - limits.arm.q_min[i],
          0.25)
          << i;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Fr3, ShapedMotionToTheEnds, testing::Values(6u, 9u, 10u));

/// The elbow of a Cartesian controller whose desired velocity jumps before it is reached.
class ShapedElbow : public testing::TestWithParam<unsigned> {};

TEST_P(ShapedElbow, ReachesTheAccelerationLimitWithoutExceedingTheJerkLimit) {
  using franka_hw::ControlMode;
  using franka_sim::kTick;
  const franka_core::MotionLimits limits = limitsOf(GetParam());
  const auto& [velocity, acceleration, jerk] = limits.arm.elbow;
  for (const ControlMode mode : {ControlMode::CartesianPose, ControlMode::CartesianVelocity}) {
    ShapingOptions options;
    options.cutoff_frequency = 1000.0;
    franka_core::RobotState state{};
    ArmCommands desired;
    state.O_T_EE_c = desired.pose = franka_core::kIdentityTransform;
    double highest = 0.0;
    for (int tick = 0; tick < 1000; ++tick) {
      const double speed = tick / 50 % 2 == 0 ? 1.0 : -1.0;  // [rad/s]
      desired.pose_elbow = desired.twist_elbow = {{state.elbow_c[0] + speed * kTick, -1.0}};
      const double q3 = shapeCommand(options, mode, desired, state, limits).elbow_c[0];
      const double dq3 = (q3 - state.elbow_c[0]) / kTick;
      const double ddq3 = (dq3 - state.delbow_c[0]) / kTick;
      ASSERT_LE(std::abs(ddq3 - state.ddelbow_c[0]) / kTick, jerk) << mode << " " << tick;
      ASSERT_LE(std::abs(ddq3), acceleration) << mode << " " << tick;
      ASSERT_LE(std::abs(dq3), velocity) << mode << " " << tick;
      highest = std::max(highest, std::abs(ddq3));
      state.elbow_c = {{q3, -1.0}};
      state.delbow_c = {{dq3, 0.0}};
      state.ddelbow_c = {{ddq3, 0.0}};
    }
    EXPECT_NEAR(acceleration, highest, 0.01) << mode;
  }
}

INSTANTIATE_TEST_SUITE_P(PandaAndFr3, ShapedElbow, testing::Values(5u, 10u));

}  // namespace
}  // namespace franka_sim_mujoco
