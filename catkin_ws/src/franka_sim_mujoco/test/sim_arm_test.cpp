// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// An arm that controllers drive in the simulation: flags of contact and collision, controllers
/// that run less often than the robot, and switches near a singular pose.

#include <franka_sim_mujoco/sim_arm.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "robot/arm_fixture.h"

namespace franka_sim_mujoco {
namespace {

TEST(SimArm, FlagsFollowTheManualsFormulasForFilteredValues) {
  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  franka_sim::test::FakeArm plant(parameters.model, franka_sim::test::kReady);
  plant.payload = parameters.end_effector;
  SimArmOptions options;
  options.filter_alpha = 0.02;
  SimArm arm(parameters, plant, options);
  int contacts = 0;
  for (int i = 0; i < 1000; ++i) {
    plant.push = {{0, 0, i < 500 ? 40.0 : 0.0, 0, 0, 0}};
    arm.read(ros::Time(1));
    arm.approachCommands();
    arm.write();
    plant.step();
    const franka::RobotState& state = arm.state();
    for (std::size_t j = 0; j < 7; ++j) {
      const double shown = std::abs(state.tau_ext_hat_filtered[j]);
      ASSERT_EQ(shown > parameters.nominal.lower_torque[j] ? 1.0 : 0.0, state.joint_contact[j]);
      ASSERT_EQ(shown > parameters.nominal.upper_torque[j] ? 1.0 : 0.0, state.joint_collision[j]);
    }
    for (std::size_t j = 0; j < 6; ++j) {
      const double shown = std::abs(state.K_F_ext_hat_K[j]);
      ASSERT_EQ(shown > parameters.nominal.lower_force[j] ? 1.0 : 0.0, state.cartesian_contact[j]);
      ASSERT_EQ(shown > parameters.nominal.upper_force[j] ? 1.0 : 0.0,
                state.cartesian_collision[j]);
      contacts += state.cartesian_contact[j] > 0.0 ? 1 : 0;
    }
  }
  EXPECT_GT(contacts, 100);
  EXPECT_LT(contacts, 700);
}

/// An arm whose controller of positions runs every `period` ticks.
struct PositionControlledArm {
  explicit PositionControlledArm(int period)
      : period(period), arm(parameters, plant, optionsFor(period)) {
    plant.payload = parameters.end_effector;
  }

  static SimArmOptions optionsFor(int period) {
    SimArmOptions options;
    options.control_ticks = period;
    return options;
  }

  /// @param controller writes the commands; called once a period
  template <typename Controller>
  void tick(const Controller& controller) {
    arm.read(ros::Time(1));
    if (ticks++ % period == 0) {
      controller();
    }
    arm.approachCommands();
    arm.write();
    plant.step();
  }

  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  franka_sim::test::FakeArm plant{parameters.model, franka_sim::test::kReady};
  int period;
  int ticks{0};
  SimArm arm;
};

class SimArmPeriod : public ::testing::TestWithParam<int> {};

TEST_P(SimArmPeriod, ChangesNothingWithoutController) {
  PositionControlledArm reference(1), slow(GetParam());
  for (int i = 0; i < 500; ++i) {
    reference.tick([] {});
    slow.tick([] {});
    ASSERT_EQ(reference.plant.q(), slow.plant.q()) << "tick " << i;
    ASSERT_EQ(reference.arm.state().tau_ext_hat_filtered, slow.arm.state().tau_ext_hat_filtered);
  }
}

TEST_P(SimArmPeriod, MotionReachesItsGoalWithoutExternalTorqueAndRests) {
  constexpr double kWay = 0.8;     // [rad]
  constexpr int kDuration = 2000;  // [ticks]
  constexpr int kEnd = kDuration + 1000;
  PositionControlledArm slow(GetParam());
  slow.tick([] {});
  slow.arm.control(franka_hw::ControlMode::JointPosition, franka_hw::ControlMode::None);
  const std::array<double, 7> start = slow.arm.state().q_d;
  for (int i = 0; i < kEnd; ++i) {
    slow.tick([&] {
      const double part = std::min(1.0, static_cast<double>(i) / kDuration);
      slow.arm.commands().position = start;
      slow.arm.commands().position[0] += kWay * part * part * part * (10 + part * (6 * part - 15));
    });
    for (const double torque : slow.arm.state().tau_ext_hat_filtered) {
      ASSERT_LT(std::abs(torque), 0.5) << "tick " << i;
    }
  }
  EXPECT_EQ(franka::RobotMode::kMove, slow.arm.state().robot_mode);
  EXPECT_NEAR(start[0] + kWay, slow.plant.q()[0], 1e-3);
  for (const double dq : slow.plant.dq()) {
    EXPECT_NEAR(0.0, dq, 1e-4);
  }
}

TEST(SimArm, SwitchOfOtherControllersLeavesItsMotionAlone) {
  constexpr auto kNone = franka_hw::ControlMode::None;
  PositionControlledArm reference(1), arm(1);
  for (PositionControlledArm* each : {&reference, &arm}) {
    each->tick([] {});
    each->arm.control(franka_hw::ControlMode::JointPosition, kNone);
  }
  const std::array<double, 7> start = arm.arm.state().q_d;
  for (int i = 0; i < 1000; ++i) {
    if (i % 100 == 50) {
      EXPECT_FALSE(arm.arm.control(kNone, kNone));
    }
    for (PositionControlledArm* each : {&reference, &arm}) {
      each->tick([&] {
        each->arm.commands().position = start;
        each->arm.commands().position[0] += 0.1 * (1.0 - std::cos(3e-3 * i));
      });
    }
    ASSERT_EQ(reference.plant.q(), arm.plant.q()) << "tick " << i;
    ASSERT_EQ(franka::RobotMode::kMove, arm.arm.state().robot_mode) << "tick " << i;
  }
}

INSTANTIATE_TEST_SUITE_P(Milliseconds, SimArmPeriod,
                         ::testing::Values(1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 12, 20));

using franka_core::RobotMode;
using franka_hw::ControlMode;

franka_sim::ControlUnitParameters rosControl() {
  franka_sim::ControlUnitParameters parameters = franka_sim::test::pandaWithHand();
  parameters.rules = franka_sim::InterfaceRules::kRosControl;
  return parameters;
}

/// An arm whose Cartesian controller moves it towards the axis of its first joint, over which the
/// pose is singular.
class ArmNearSingularPose {
 public:
  ArmNearSingularPose()
      : parameters_(rosControl()),
        plant_(parameters_.model, {{0, -1.43, 0, -2.35619449, 0, 1.57079633, 0.78539816}}),
        arm(parameters_, plant_, SimArmOptions()) {
    plant_.payload = parameters_.end_effector;
    run(1);
    arm.control(ControlMode::CartesianVelocity, ControlMode::None);
    for (int i = 0; i < 3000 && !arm.unit().stopsAtSingularPose(); ++i) {
      run(1);
    }
    run(100);
  }

  /// @returns whether it moved in each tick
  bool run(int ticks) {
    bool moved = true;
    for (int i = 0; i < ticks; ++i) {
      arm.read(ros::Time(1));
      moved = moved && arm.unit().state().robot_mode == RobotMode::kMove;
      speed_ = std::min(speed_ + 1e-4, 0.02);
      arm.commands().twist = {{-speed_, 0, 0, 0, 0, 0}};
      arm.approachCommands();
      arm.write();
      plant_.step();
    }
    return moved;
  }

  void resetWorld() {
    arm.worldWasReset();
    speed_ = 0.0;
  }

  double x() { return arm.unit().state().O_T_EE[12]; }

 private:
  franka_sim::ControlUnitParameters parameters_;
  franka_sim::test::FakeArm plant_;
  double speed_{0};

 public:
  SimArm arm;
};

TEST(SimArmSwitch, ARefusedStartChangesNothing) {
  ArmNearSingularPose undisturbed, refusing;
  ASSERT_TRUE(refusing.arm.unit().stopsAtSingularPose());
  EXPECT_TRUE(refusing.arm.refuses(ControlMode::JointTorque, ControlMode::None));
  EXPECT_FALSE(refusing.arm.control(ControlMode::JointTorque, ControlMode::None));
  EXPECT_EQ(SimArm::Switch::kRefused, refusing.arm.switchResult());
  EXPECT_EQ(ControlMode::CartesianVelocity, refusing.arm.mode());
  const double before = refusing.x();
  EXPECT_TRUE(undisturbed.run(300) && refusing.run(300));
  EXPECT_LT(refusing.x(), before - 0.004);
  EXPECT_EQ(undisturbed.arm.unit().state().q, refusing.arm.unit().state().q) << "to the last bit";
}

TEST(SimArmSwitch, AControllerThatRemainsGoesOnAtASingularPose) {
  ArmNearSingularPose moved;
  ASSERT_TRUE(moved.arm.unit().stopsAtSingularPose());
  moved.resetWorld();
  EXPECT_TRUE(moved.run(100));
  // A restart is a stop and a start: what would be stopped is stopped, but not what only remains.
  EXPECT_TRUE(moved.arm.control(ControlMode::CartesianVelocity, ControlMode::CartesianVelocity));
  EXPECT_EQ(SimArm::Switch::kRefused, moved.arm.switchResult());
  EXPECT_EQ(ControlMode::None, moved.arm.mode());
}

}  // namespace
}  // namespace franka_sim_mujoco
