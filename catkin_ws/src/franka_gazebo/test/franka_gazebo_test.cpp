// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// Uses the original's headers as programs for the original do.

#include <franka_gazebo/controller_verifier.h>
#include <franka_gazebo/franka_gripper_sim.h>
#include <franka_gazebo/franka_hw_sim.h>
#include <franka_gazebo/joint.h>
#include <franka_gazebo/model_kdl.h>
#include <franka_gazebo/statemachine.h>
#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <type_traits>

namespace franka_gazebo {
namespace {

using franka::RobotMode;

static_assert(std::is_base_of_v<hardware_interface::RobotHW, FrankaHWSim>);
static_assert(std::is_base_of_v<controller_interface::ControllerBase, FrankaGripperSim>);
static_assert(std::is_base_of_v<franka_hw::ModelBase, ModelKDL>);
static_assert(std::is_move_constructible_v<Joint> && !std::is_copy_constructible_v<Joint>);

class FakeDrive : public franka_sim::JointDrive {
 public:
  franka_sim::JointMeasurement measure() const noexcept override { return measured; }
  void applyEffort(double /*effort*/) noexcept override {}
  bool follow(double /*position*/, const franka_sim::DriveLimits& /*limits*/) noexcept override {
    return true;
  }
  franka_sim::JointMeasurement measured;
};

JointMap robot(const std::string& arm_id) {
  JointMap joints;
  for (const char* suffix : kRobotJointSuffixes) {
    joints[arm_id + suffix] = std::make_shared<Joint>();
    joints[arm_id + suffix]->name = arm_id + suffix;
  }
  return joints;
}

hardware_interface::ControllerInfo claiming(const std::string& interface,
                                            const std::set<std::string>& resources) {
  hardware_interface::ControllerInfo info;
  info.claimed_resources.emplace_back("hardware_interface::" + interface, resources);
  return info;
}

std::set<std::string> armJoints(const std::string& arm_id) {
  std::set<std::string> names;
  for (int i = 1; i <= 7; ++i) {
    names.insert(arm_id + "_joint" + std::to_string(i));
  }
  return names;
}

TEST(FrankaGazeboJoint, DifferentiatesMeasurementsOfItsDrive) {
  FakeDrive drive;
  Joint joint;
  joint.handle = &drive;
  drive.measured = {0.5, 1.0, 2.0};
  joint.update(ros::Duration(0.001));
  EXPECT_EQ(joint.position, 0.5);
  EXPECT_EQ(joint.acceleration, 0.0);
  drive.measured.velocity = 1.002;
  joint.update(ros::Duration(0.001));
  EXPECT_NEAR(joint.acceleration, 2.0, 1e-9);
  EXPECT_NEAR(joint.jerk, 2000.0, 1e-6);
  joint.setJointPosition(0.7);
  joint.update(ros::Duration(0.001));
  EXPECT_EQ(joint.desired_position, 0.7);
  EXPECT_EQ(joint.stop_position, 0.7);
  EXPECT_TRUE(std::isnan(joint.getLinkMass()));
  joint.contact_threshold = 1.0;
  joint.command = 0.5;
  EXPECT_TRUE(joint.isInContact());
  EXPECT_FALSE(joint.isInCollision());
}

TEST(FrankaGazeboJoint, DesiredValuesDependOnModeAndMethod) {
  Joint joint;
  joint.position = 1;
  joint.velocity = 2;
  joint.acceleration = 3;
  joint.desired_position = 10;
  joint.desired_velocity = 20;
  joint.command = 40;
  EXPECT_EQ(joint.getDesiredPosition(RobotMode::kIdle), 1);
  EXPECT_EQ(joint.getDesiredTorque(RobotMode::kIdle), 0);
  joint.control_method = POSITION;
  EXPECT_EQ(joint.getDesiredPosition(RobotMode::kMove), 10);
  EXPECT_EQ(joint.getDesiredVelocity(RobotMode::kMove), 2);
  joint.control_method = VELOCITY;
  EXPECT_EQ(joint.getDesiredVelocity(RobotMode::kMove), 20);
  EXPECT_EQ(joint.getDesiredAcceleration(RobotMode::kMove), 3);
  joint.control_method = EFFORT;
  EXPECT_EQ(joint.getDesiredPosition(RobotMode::kMove), 1);
  EXPECT_EQ(joint.getDesiredAcceleration(RobotMode::kMove), 0);
  EXPECT_EQ(joint.getDesiredTorque(RobotMode::kMove), 40);
}

TEST(FrankaGazeboControllerVerifier, DistinguishesArmAndHand) {
  const JointMap joints = robot("fr3_left");
  const ControllerVerifier verifier(joints, "fr3_left");
  const auto arm = claiming("EffortJointInterface", armJoints("fr3_left"));
  EXPECT_TRUE(verifier.isClaimingArmController(arm) && verifier.isValidController(arm));
  EXPECT_FALSE(verifier.isClaimingGripperController(arm));
  const std::set<std::string> fingers{"fr3_left_finger_joint1", "fr3_left_finger_joint2"};
  EXPECT_TRUE(verifier.isClaimingGripperController(claiming("EffortJointInterface", fingers)));
  EXPECT_FALSE(verifier.isValidController(claiming("PositionJointInterface", fingers)));
  EXPECT_FALSE(verifier.isValidController(claiming("EffortJointInterface", armJoints("other"))));
  EXPECT_TRUE(verifier.isValidController(claiming("JointStateInterface", fingers)));
  EXPECT_EQ(
      *ControllerVerifier::determineControlMethod("hardware_interface::VelocityJointInterface"),
      VELOCITY);
  EXPECT_FALSE(ControllerVerifier::determineControlMethod("franka_hw::FrankaStateInterface"));
}

TEST(FrankaGazeboStateMachine, MovesStopsAndRecovers) {
  JointMap joints = robot("panda");
  franka::RobotState state;
  StateMachine machine(state, joints);
  EXPECT_TRUE(machine.is(Idle{}));
  EXPECT_FALSE(machine.process_event(SwitchControl{}));
  joints["panda_joint1"]->control_method = EFFORT;
  EXPECT_TRUE(machine.process_event(SwitchControl{}));
  EXPECT_EQ(state.robot_mode, RobotMode::kMove);
  joints["panda_joint1"]->position = 0.3;
  EXPECT_TRUE(machine.process_event(UserStop{true}));
  EXPECT_EQ(joints["panda_joint1"]->stop_position, 0.3);
  EXPECT_EQ(state.robot_mode, RobotMode::kUserStopped);
  EXPECT_FALSE(machine.process_event(ErrorRecovery{}));
  EXPECT_TRUE(machine.process_event(UserStop{false}) && machine.is(Idle{}));
  EXPECT_TRUE(machine.process_event(ErrorRecovery{}) && machine.is(Move{}));
}

}  // namespace
}  // namespace franka_gazebo
