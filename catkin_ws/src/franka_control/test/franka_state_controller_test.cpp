// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_control/franka_state_controller.h>
#include <franka_control/state_conversions.h>
#include <gtest/gtest.h>
#include <hardware_interface/robot_hw.h>
#include <ros/ros.h>
#include <ros_test/arm_controller_test.h>
#include <ros_test/eventually.h>
#include <rt_guard/rt_guard.h>

#include <chrono>
#include <cmath>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "random_state.h"

namespace franka_control {
namespace {

using ros_test::eventually;
using ros_test::jointNames;

/// Collects the messages of one topic.
template <typename Message>
class Listener {
 public:
  explicit Listener(const std::string& topic) {
    subscriber_ = ros::NodeHandle().subscribe<Message>(
        topic, 2000, [this](const boost::shared_ptr<const Message>& message) {
          const std::lock_guard<std::mutex> lock(mutex_);
          messages_.push_back(*message);
        });
  }
  bool isConnected() const { return subscriber_.getNumPublishers() > 0; }
  std::size_t count() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.size();
  }
  Message last() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_.back();
  }
  std::vector<Message> all() const {
    const std::lock_guard<std::mutex> lock(mutex_);
    return messages_;
  }

 private:
  ros::Subscriber subscriber_;
  mutable std::mutex mutex_;
  std::vector<Message> messages_;
};

/// Hardware that owns the state of one arm.
class FakeRobot : public hardware_interface::RobotHW {
 public:
  explicit FakeRobot(const std::string& arm_id) {
    states_.registerHandle(franka_hw::FrankaStateHandle(arm_id + "_robot", state));
    registerInterface(&states_);
  }
  franka::RobotState state;

 private:
  franka_hw::FrankaStateInterface states_;
};

class FrankaStateControllerTest : public ros_test::ArmControllerTest {
 protected:
  bool initialize(FrankaStateController& controller, hardware_interface::RobotHW& robot) {
    ros::NodeHandle root;
    controller_interface::ControllerBase::ClaimedResources claims;
    controller_interface::ControllerBase& base = controller;
    const bool is_ready = base.initRequest(&robot, root, node, claims);
    if (is_ready) {
      EXPECT_EQ(1U, claims.size());
      EXPECT_TRUE(claims.front().resources.empty());
    }
    return is_ready;
  }

  const ros::Duration kMillisecond{0.001};
};

TEST_F(FrankaStateControllerTest, PublishesEveryTopicOfAnyArm) {
  for (const std::string arm_id : {"panda", "fr3", "left_arm_2"}) {
    setParameters(arm_id);
    FakeRobot robot(arm_id);
    RandomStates states;
    robot.state = states.next();
    robot.state.NE_T_EE = {{0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0.1, 0.2, 0.3, 1}};

    FrankaStateController controller;
    ASSERT_TRUE(initialize(controller, robot));
    Listener<franka_msgs::FrankaState> state(node.resolveName("franka_states"));
    Listener<tf2_msgs::TFMessage> transforms("/tf");
    Listener<geometry_msgs::WrenchStamped> wrench(node.resolveName("F_ext"));
    Listener<sensor_msgs::JointState> joints(node.resolveName("joint_states"));
    Listener<sensor_msgs::JointState> desired(node.resolveName("joint_states_desired"));
    ASSERT_TRUE(eventually([&] {
      return state.isConnected() && transforms.isConnected() && wrench.isConnected() &&
             joints.isConnected() && desired.isConnected();
    }));

    controller.starting(ros::Time(12.0));
    const ros::Time stamp(12.345);
    controller.update(stamp, kMillisecond);
    ASSERT_TRUE(eventually([&] {
      return state.count() > 0 && transforms.count() > 0 && wrench.count() > 0 &&
             joints.count() > 0 && desired.count() > 0;
    }));

    franka_msgs::FrankaState expected;
    toMessage(robot.state, expected);
    expected.header = state.last().header;  // compared separately
    EXPECT_EQ(expected, state.last());
    EXPECT_EQ(stamp, state.last().header.stamp);
    EXPECT_EQ("", state.last().header.frame_id);

    EXPECT_EQ(arm_id + "_K", wrench.last().header.frame_id);
    EXPECT_EQ(stamp, wrench.last().header.stamp);
    EXPECT_EQ(robot.state.K_F_ext_hat_K[0], wrench.last().wrench.force.x);
    EXPECT_EQ(robot.state.K_F_ext_hat_K[1], wrench.last().wrench.force.y);
    EXPECT_EQ(robot.state.K_F_ext_hat_K[2], wrench.last().wrench.force.z);
    EXPECT_EQ(robot.state.K_F_ext_hat_K[3], wrench.last().wrench.torque.x);
    EXPECT_EQ(robot.state.K_F_ext_hat_K[4], wrench.last().wrench.torque.y);
    EXPECT_EQ(robot.state.K_F_ext_hat_K[5], wrench.last().wrench.torque.z);

    const auto expectJoints =
        [&](const sensor_msgs::JointState& message, const std::array<double, 7>& position,
            const std::array<double, 7>& velocity, const std::array<double, 7>& effort) {
          EXPECT_EQ(jointNames(arm_id), message.name);
          EXPECT_EQ(stamp, message.header.stamp);
          EXPECT_EQ(std::vector<double>(position.begin(), position.end()), message.position);
          EXPECT_EQ(std::vector<double>(velocity.begin(), velocity.end()), message.velocity);
          EXPECT_EQ(std::vector<double>(effort.begin(), effort.end()), message.effort);
        };
    expectJoints(joints.last(), robot.state.q, robot.state.dq, robot.state.tau_J);
    expectJoints(desired.last(), robot.state.q_d, robot.state.dq_d, robot.state.tau_J_d);

    ASSERT_EQ(3U, transforms.last().transforms.size());
    const std::vector<std::string> chain{arm_id + "_link8", arm_id + "_NE", arm_id + "_EE",
                                         arm_id + "_K"};
    const std::vector<std::array<double, 16>> matrices{robot.state.F_T_NE, robot.state.NE_T_EE,
                                                       robot.state.EE_T_K};
    for (std::size_t i = 0; i < 3; ++i) {
      const geometry_msgs::TransformStamped transform = transforms.last().transforms[i];
      EXPECT_EQ(chain[i], transform.header.frame_id);
      EXPECT_EQ(chain[i + 1], transform.child_frame_id);
      EXPECT_EQ(stamp, transform.header.stamp);
      EXPECT_EQ(toTransform(matrices[i]), transform.transform);
    }
    EXPECT_NEAR(std::sqrt(0.5), transforms.last().transforms[1].transform.rotation.z, 1e-12);
  }
}

TEST_F(FrankaStateControllerTest, LosesNoStateToAThreadThatIsLate) {
  setParameters("panda");
  node.setParam("publish_rate", 1000.0);
  FakeRobot robot("panda");
  FrankaStateController controller;
  ASSERT_TRUE(initialize(controller, robot));
  Listener<franka_msgs::FrankaState> states(node.resolveName("franka_states"));
  ASSERT_TRUE(eventually([&] { return states.isConnected(); }));

  // Each round is faster than any thread wakes up, and then waits for its messages.
  controller.starting(ros::Time(20.0));
  constexpr unsigned kStatesPerRound = 60, kRounds = 20;
  for (unsigned i = 1; i <= kRounds * kStatesPerRound; ++i) {
    robot.state.q[0] = i;
    controller.update(ros::Time(20 + i / 1000, i % 1000 * 1000000), kMillisecond);
    if (i % kStatesPerRound == 0) {
      ASSERT_TRUE(eventually([&] { return states.count() == i; })) << states.count() << " of " << i;
    }
  }
  const auto all = states.all();
  for (std::size_t i = 0; i < all.size(); ++i) {
    ASSERT_EQ(static_cast<double>(i + 1), all[i].q[0]);
    ASSERT_EQ(i, all[i].header.seq);
  }
}

TEST_F(FrankaStateControllerTest, PublishesThirtyTimesASecondByDefault) {
  setParameters("panda");
  FakeRobot robot("panda");
  FrankaStateController controller;
  ASSERT_TRUE(initialize(controller, robot));
  Listener<franka_msgs::FrankaState> states(node.resolveName("franka_states"));
  ASSERT_TRUE(eventually([&] { return states.isConnected(); }));
  controller.starting(ros::Time(50.0));
  for (const unsigned milliseconds : {1, 33, 34, 66, 67, 99, 100}) {
    controller.update(ros::Time(50, milliseconds * 1000000), kMillisecond);
  }
  ASSERT_TRUE(eventually([&] { return states.count() >= 3; }));
  const auto all = states.all();
  EXPECT_EQ(ros::Time(50, 100000000), all.back().header.stamp);
  EXPECT_EQ(3U, all.size());
}

TEST_F(FrankaStateControllerTest, UpdateNeitherAllocatesNorLocks) {
  setParameters("panda");
  node.setParam("publish_rate", 1000.0);
  FakeRobot robot("panda");
  robot.state = RandomStates().next();
  FrankaStateController controller;
  ASSERT_TRUE(initialize(controller, robot));
  int i = 0;
  EXPECT_TRUE(eventually([&] {
    const ros::Time now(10.0 + ++i * 1e-3);
    rt_guard::Scope scope;
    controller.update(now, kMillisecond);
    EXPECT_EQ(0U, scope.allocations());
    EXPECT_EQ(0U, scope.locks());
    return i == 200;
  }));
}

TEST_F(FrankaStateControllerTest, RefusesMissingAndWrongParameters) {
  FakeRobot robot("panda");
  const auto refused = [&] {
    FrankaStateController controller;
    return !initialize(controller, robot);
  };
  EXPECT_TRUE(refused()) << "nothing is set";
  node.setParam("arm_id", "panda");
  EXPECT_TRUE(refused()) << "joint_names are missing";
  for (int count : {0, 1, 6, 8}) {
    node.setParam("joint_names", jointNames("panda", count));
    EXPECT_TRUE(refused()) << count << " joints";
  }
  node.setParam("joint_names", "panda_joint1");
  EXPECT_TRUE(refused()) << "joint_names are a string";
  setParameters("panda");
  node.setParam("arm_id", 7);
  EXPECT_TRUE(refused()) << "arm_id is a number";
  node.setParam("arm_id", "fr3");
  EXPECT_TRUE(refused()) << "another arm";
  node.setParam("arm_id", "panda");
  for (double rate : {0.0, -30.0, std::nan("")}) {
    node.setParam("publish_rate", rate);
    EXPECT_TRUE(refused()) << rate << " Hz";
  }
  node.setParam("publish_rate", "often");
  EXPECT_TRUE(refused()) << "publish_rate is a string";
  node.setParam("publish_rate", 30.0);
  EXPECT_FALSE(refused());

  hardware_interface::RobotHW no_franka;
  FrankaStateController controller;
  EXPECT_FALSE(initialize(controller, no_franka));
}

}  // namespace
}  // namespace franka_control

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "franka_state_controller_test");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
