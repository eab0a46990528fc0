// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// The interfaces of a FrankaHW, its soft limits and its warnings.
#include <gtest/gtest.h>

#include <limits>
#include <numeric>

#include "support.h"

namespace franka_hw_test {
namespace {

using franka_hw::FrankaHW;
using hardware_interface::EffortJointInterface;
using hardware_interface::PositionJointInterface;
using hardware_interface::VelocityJointInterface;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

class Interfaces : public testing::Test {
 protected:
  void SetUp() override { ASSERT_TRUE(robot_.init(arm_.nh, arm_.robot_nh)); }

  /// A state in which all numbers are different.
  static franka::RobotState distinct() {
    franka::RobotState state;
    double next = 0.01;
    const auto fill = [&next](auto& values) {
      for (double& value : values) {
        value = next;
        next += 0.01;
      }
    };
    fill(state.q);
    fill(state.q_d);
    fill(state.dq);
    fill(state.dq_d);
    fill(state.tau_J);
    state.robot_mode = franka::RobotMode::kIdle;
    return state;
  }

  FakeArm arm_{"my_left_arm_2"};
  FrankaHW robot_;
};

template <typename Interface>
std::vector<std::string> sortedNames(FrankaHW& robot) {
  auto* const interface = robot.get<Interface>();
  return interface == nullptr ? std::vector<std::string>() : interface->getNames();
}

TEST_F(Interfaces, AreTheEightOfTheOriginalAndThatOfEffects) {
  const std::vector<std::string> joints = FakeArm::joints(arm_.arm_id);
  const std::vector<std::string> robot{arm_.arm_id + "_robot"};
  EXPECT_EQ(joints, sortedNames<hardware_interface::JointStateInterface>(robot_));
  EXPECT_EQ(joints, sortedNames<PositionJointInterface>(robot_));
  EXPECT_EQ(joints, sortedNames<VelocityJointInterface>(robot_));
  EXPECT_EQ(joints, sortedNames<EffortJointInterface>(robot_));
  EXPECT_EQ(robot, sortedNames<franka_hw::FrankaStateInterface>(robot_));
  EXPECT_EQ(robot, sortedNames<franka_hw::FrankaPoseCartesianInterface>(robot_));
  EXPECT_EQ(robot, sortedNames<franka_hw::FrankaVelocityCartesianInterface>(robot_));
  EXPECT_EQ(std::vector<std::string>{arm_.arm_id + "_model"},
            sortedNames<franka_hw::FrankaModelInterface>(robot_));
  EXPECT_EQ(joints, sortedNames<hardware_interface::CommandEffectInterface>(robot_));
  EXPECT_EQ(9u, robot_.getNames().size());
}

TEST_F(Interfaces, ShowTheState) {
  const franka::RobotState state = distinct();
  robot_.update(state);
  for (size_t i = 0; i < 7; i++) {
    const std::string name = FakeArm::joints(arm_.arm_id)[i];
    const auto joint = robot_.get<hardware_interface::JointStateInterface>()->getHandle(name);
    EXPECT_EQ(state.q[i], joint.getPosition());
    EXPECT_EQ(state.dq[i], joint.getVelocity());
    EXPECT_EQ(state.tau_J[i], joint.getEffort());
    // Torque handles show measured values; position and velocity handles show desired ones.
    const auto torque = robot_.get<EffortJointInterface>()->getHandle(name);
    EXPECT_EQ(state.q[i], torque.getPosition());
    EXPECT_EQ(state.dq[i], torque.getVelocity());
    const auto position = robot_.get<PositionJointInterface>()->getHandle(name);
    EXPECT_EQ(state.q_d[i], position.getPosition());
    EXPECT_EQ(state.dq_d[i], position.getVelocity());
    const auto velocity = robot_.get<VelocityJointInterface>()->getHandle(name);
    EXPECT_EQ(state.q_d[i], velocity.getPosition());
    EXPECT_EQ(state.tau_J[i], velocity.getEffort());
  }
  const auto handle =
      robot_.get<franka_hw::FrankaStateInterface>()->getHandle(arm_.arm_id + "_robot");
  EXPECT_EQ(state.q, handle.getRobotState().q);
  EXPECT_EQ(franka::RobotMode::kIdle, robot_.robotMode());
}

TEST_F(Interfaces, TakeCommands) {
  for (size_t i = 0; i < 7; i++) {
    const std::string name = FakeArm::joints(arm_.arm_id)[i];
    const double value = static_cast<double>(i) + 1.0;
    robot_.get<PositionJointInterface>()->getHandle(name).setCommand(value);
    robot_.get<VelocityJointInterface>()->getHandle(name).setCommand(10.0 * value);
    robot_.get<EffortJointInterface>()->getHandle(name).setCommand(100.0 * value);
  }
  const std::array<double, 7> one{1, 2, 3, 4, 5, 6, 7};
  const std::array<double, 7> ten{10, 20, 30, 40, 50, 60, 70};
  const std::array<double, 7> hundred{100, 200, 300, 400, 500, 600, 700};
  EXPECT_EQ(one, robot_.getJointPositionCommand());
  EXPECT_EQ(ten, robot_.getJointVelocityCommand());
  EXPECT_EQ(hundred, robot_.getJointEffortCommand());
}

// --- soft limits ---------------------------------------------------------------------------------

TEST_F(Interfaces, CutCommandsToTheSoftLimits) {
  const franka::RobotState state = distinct();
  robot_.update(state);
  robot_.reset();
  for (const std::string& name : FakeArm::joints(arm_.arm_id)) {
    robot_.get<PositionJointInterface>()->getHandle(name).setCommand(100.0);
    robot_.get<VelocityJointInterface>()->getHandle(name).setCommand(100.0);
    robot_.get<EffortJointInterface>()->getHandle(name).setCommand(1000.0);
  }
  robot_.enforceLimits(ros::Duration(0.0));
  EXPECT_EQ(100.0, robot_.getJointPositionCommand()[0]) << "no time, no limit";

  robot_.enforceLimits(ros::Duration(0.001));
  urdf::Model urdf;
  ASSERT_TRUE(urdf.initString(urdfOf(arm_.arm_id)));
  for (size_t i = 0; i < 7; i++) {
    const auto joint = urdf.getJoint(FakeArm::joints(arm_.arm_id)[i]);
    // The speed that the safety controller allows at this position, which is proportional to the
    // distance.
    const double distance_to_limit = joint->safety->soft_upper_limit - state.q_d[i];
    const double speed = std::min(joint->limits->velocity,
                                  joint->safety->k_position * std::max(0.0, distance_to_limit));
    EXPECT_LE(robot_.getJointPositionCommand()[i], state.q_d[i] + speed * 0.001 + 1e-9) << i;
    EXPECT_LE(robot_.getJointVelocityCommand()[i], joint->limits->velocity + 1e-9) << i;
    EXPECT_LE(robot_.getJointEffortCommand()[i], joint->limits->effort + 1e-9) << i;
    EXPECT_GE(robot_.getJointEffortCommand()[i], -joint->limits->effort - 1e-9) << i;
  }
}

TEST_F(Interfaces, SoftLimitsAreLookedUpWithoutClaiming) {
  EXPECT_TRUE(robot_.get<PositionJointInterface>()->getClaims().empty());
  EXPECT_TRUE(robot_.get<VelocityJointInterface>()->getClaims().empty());
  EXPECT_TRUE(robot_.get<EffortJointInterface>()->getClaims().empty());
}

TEST(Warnings, NameTheJointsNearTheirEnds) {
  FakeArm arm;
  FrankaHW robot;
  ASSERT_TRUE(robot.init(arm.nh, arm.robot_nh));
  urdf::Model urdf;
  ASSERT_TRUE(urdf.initString(urdfOf(arm.arm_id)));
  const std::vector<std::string> joints = FakeArm::joints(arm.arm_id);
  const LogCatcher log;
  franka::RobotState state;
  // The fourth joint cannot be at zero: it needs a position of its own, far from its ends.
  state.q = {0.0, -0.8, 0.0, -1.5, 0.0, 1.6, 0.8};
  state.q[3] = urdf.getJoint(joints[3])->limits->lower + 0.05;
  robot.update(state);
  robot.checkJointLimits();
  EXPECT_TRUE(eventually([&] {
    const std::string text = log.text(ros::console::levels::Warn);
    return text.find(joints[3] + ": 2.86") != std::string::npos;  // 0.05 rad in degrees
  })) << log.text();
  for (const std::string& joint : joints) {
    EXPECT_EQ(joint == joints[3], log.text().find(joint) != std::string::npos) << log.text();
  }
}

// --- NaN -----------------------------------------------------------------------------------------

/// Whether a NaN at each index of a command is found, and none if there is none.
template <typename Command, size_t size>
void expectEveryNanIsFound(Command command, std::array<double, size> Command::* values) {
  EXPECT_FALSE(FrankaHW::commandHasNaN(command));
  for (size_t i = 0; i < size; i++) {
    Command spoilt = command;
    (spoilt.*values)[i] = kNan;
    EXPECT_TRUE(FrankaHW::commandHasNaN(spoilt)) << i;
  }
}

TEST(Nan, IsFoundInEveryPlaceOfEveryCommand) {
  const std::array<double, 7> zeros{};
  expectEveryNanIsFound(franka::Torques(zeros), &franka::Torques::tau_J);
  expectEveryNanIsFound(franka::JointPositions(zeros), &franka::JointPositions::q);
  expectEveryNanIsFound(franka::JointVelocities(zeros), &franka::JointVelocities::dq);
  const franka::CartesianPose pose({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, {0.0, 1.0});
  expectEveryNanIsFound(pose, &franka::CartesianPose::O_T_EE);
  expectEveryNanIsFound(pose, &franka::CartesianPose::elbow);
  const franka::CartesianVelocities twist({0, 0, 0, 0, 0, 0}, {0.0, 1.0});
  expectEveryNanIsFound(twist, &franka::CartesianVelocities::O_dP_EE);
  expectEveryNanIsFound(twist, &franka::CartesianVelocities::elbow);
}

}  // namespace
}  // namespace franka_hw_test
