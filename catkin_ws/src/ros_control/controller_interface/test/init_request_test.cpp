// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_interface/controller.h>
#include <controller_interface/multi_interface_controller.h>
#include <gmock/gmock.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/joint_state_interface.h>
#include <hardware_interface/robot_hw.h>
#include <ros/ros.h>

#include <memory>
#include <string>
#include <vector>

using controller_interface::Controller;
using controller_interface::ControllerBase;
using controller_interface::MultiInterfaceController;
using hardware_interface::EffortJointInterface;
using hardware_interface::JointHandle;
using hardware_interface::JointStateHandle;
using hardware_interface::JointStateInterface;
using hardware_interface::PositionJointInterface;
using hardware_interface::RobotHW;
using hardware_interface::VelocityJointInterface;
using testing::ElementsAre;
using testing::IsEmpty;

namespace {

/// Makes the protected initRequest accessible and records the calls of init.
template <class Base>
class Open : public Base {
 public:
  using Base::Base;
  using Base::initRequest;
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {}

  bool two_argument_result_{true};
  bool three_argument_result_{true};
  std::vector<std::string> calls_;
};

class Single : public Open<Controller<EffortJointInterface>> {
 public:
  bool init(EffortJointInterface* hw, ros::NodeHandle& /*controller_nh*/) override {
    calls_.emplace_back("two");
    hw->getHandle("j1");
    return two_argument_result_;
  }
  bool init(EffortJointInterface* hw, ros::NodeHandle& /*root_nh*/,
            ros::NodeHandle& /*controller_nh*/) override {
    calls_.emplace_back("three");
    hw->getHandle("j2");
    return three_argument_result_;
  }
  std::string interfaceType() const { return getHardwareInterfaceType(); }
};

class Multi : public Open<MultiInterfaceController<VelocityJointInterface, JointStateInterface,
                                                   EffortJointInterface>> {
 public:
  using Open::Open;
  bool init(RobotHW* robot_hw, ros::NodeHandle& /*controller_nh*/) override {
    calls_.emplace_back("two");
    saw_position_ = robot_hw->get<PositionJointInterface>() != nullptr;
    saw_velocity_ = robot_hw->get<VelocityJointInterface>() != nullptr;
    robot_hw->get<EffortJointInterface>()->getHandle("j2");
    robot_hw->get<EffortJointInterface>()->getHandle("j1");
    robot_hw->get<JointStateInterface>()->getHandle("j1");
    return two_argument_result_;
  }
  bool init(RobotHW* /*robot_hw*/, ros::NodeHandle& /*root_nh*/,
            ros::NodeHandle& /*controller_nh*/) override {
    calls_.emplace_back("three");
    return three_argument_result_;
  }

  bool saw_position_{false};
  bool saw_velocity_{false};
};

class InitRequestTest : public testing::Test {
 protected:
  InitRequestTest() {
    for (const char* name : {"j1", "j2"}) {
      const JointStateHandle state(name, &value_, &value_, &value_);
      states_.registerHandle(state);
      efforts_.registerHandle(JointHandle(state, &value_));
      velocities_.registerHandle(JointHandle(state, &value_));
      positions_.registerHandle(JointHandle(state, &value_));
    }
    robot_.registerInterface(&states_);
    robot_.registerInterface(&efforts_);
    robot_.registerInterface(&positions_);
  }

  bool request(ControllerBase& controller) {
    return controller.initRequest(&robot_, root_nh_, controller_nh_, claimed_);
  }

  ros::NodeHandle root_nh_;
  ros::NodeHandle controller_nh_{"controller"};
  double value_{0.0};
  JointStateInterface states_;
  EffortJointInterface efforts_;
  VelocityJointInterface velocities_;
  PositionJointInterface positions_;
  RobotHW robot_;
  ControllerBase::ClaimedResources claimed_;
};

}  // namespace

TEST_F(InitRequestTest, CallsBothInitsAndReportsTheClaims) {
  Single controller;
  efforts_.claim("left by another controller");
  ASSERT_TRUE(request(controller));
  EXPECT_TRUE(controller.isInitialized());
  EXPECT_THAT(controller.calls_, ElementsAre("two", "three"));
  ASSERT_EQ(1u, claimed_.size());
  EXPECT_EQ("hardware_interface::EffortJointInterface", claimed_[0].hardware_interface);
  EXPECT_THAT(claimed_[0].resources, ElementsAre("j1", "j2"));
  EXPECT_THAT(efforts_.getClaims(), IsEmpty());
  EXPECT_EQ("hardware_interface::EffortJointInterface", controller.interfaceType());
}

TEST_F(InitRequestTest, RefusesASecondRequest) {
  Single controller;
  ASSERT_TRUE(request(controller));
  EXPECT_FALSE(request(controller));
  EXPECT_TRUE(controller.isInitialized());
}

TEST_F(InitRequestTest, FailedInitLeavesNoClaims) {
  Single first;
  first.two_argument_result_ = false;
  EXPECT_FALSE(request(first));
  EXPECT_THAT(first.calls_, ElementsAre("two"));
  Single second;
  second.three_argument_result_ = false;
  EXPECT_FALSE(request(second));
  EXPECT_THAT(second.calls_, ElementsAre("two", "three"));
  EXPECT_EQ(ControllerBase::ControllerState::CONSTRUCTED, second.state_.load());
  EXPECT_THAT(efforts_.getClaims(), IsEmpty());
  EXPECT_THAT(claimed_, IsEmpty());
}

TEST_F(InitRequestTest, RequiresItsInterface) {
  RobotHW bare;
  Single controller;
  EXPECT_FALSE(controller.initRequest(&bare, root_nh_, controller_nh_, claimed_));
  EXPECT_THAT(controller.calls_, IsEmpty());
  EXPECT_FALSE(controller.isInitialized());
}

TEST_F(InitRequestTest, SeveralInterfacesAreListedInTheOrderOfTheTemplate) {
  robot_.registerInterface(&velocities_);
  Multi controller;
  ASSERT_TRUE(request(controller));
  EXPECT_THAT(controller.calls_, ElementsAre("two", "three"));
  EXPECT_FALSE(controller.saw_position_) << "only its own interfaces are shown to a controller";
  EXPECT_TRUE(controller.saw_velocity_);
  ASSERT_EQ(3u, claimed_.size());
  EXPECT_EQ("hardware_interface::VelocityJointInterface", claimed_[0].hardware_interface);
  EXPECT_THAT(claimed_[0].resources, IsEmpty());
  EXPECT_EQ("hardware_interface::JointStateInterface", claimed_[1].hardware_interface);
  EXPECT_THAT(claimed_[1].resources, IsEmpty());
  EXPECT_EQ("hardware_interface::EffortJointInterface", claimed_[2].hardware_interface);
  EXPECT_THAT(claimed_[2].resources, ElementsAre("j1", "j2"));
  EXPECT_THAT(efforts_.getClaims(), IsEmpty());
}

TEST_F(InitRequestTest, RequiresAllOfSeveralInterfaces) {
  Multi controller;
  EXPECT_FALSE(request(controller));
  EXPECT_THAT(controller.calls_, IsEmpty());
}

TEST_F(InitRequestTest, AllowsMissingOptionalInterfaces) {
  Multi controller(true);
  ASSERT_TRUE(request(controller));
  EXPECT_FALSE(controller.saw_velocity_);
  ASSERT_EQ(2u, claimed_.size());
  EXPECT_EQ("hardware_interface::JointStateInterface", claimed_[0].hardware_interface);
  EXPECT_EQ("hardware_interface::EffortJointInterface", claimed_[1].hardware_interface);
}

TEST(EnumerateElements, JoinsWithPrefixAndSuffix) {
  const std::vector<std::string> names = {"a", "b"};
  EXPECT_EQ("- 'a'\n- 'b'",
            controller_interface::internal::enumerateElements(names, "\n", "- '", "'"));
  const std::vector<int> nothing;
  EXPECT_EQ("", controller_interface::internal::enumerateElements(nothing, ",", "<", ">"));
}

int main(int argc, char** argv) {
  testing::InitGoogleMock(&argc, argv);
  ros::init(argc, argv, "init_request_test");
  return RUN_ALL_TESTS();
}
