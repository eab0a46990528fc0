// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <dynamic_reconfigure/Reconfigure.h>
#include <franka_example_controllers/cartesian_impedance_example_controller.h>
#include <franka_hw/model_base.h>
#include <geometry_msgs/PoseStamped.h>
#include <gtest/gtest.h>
#include <hardware_interface/joint_state_interface.h>
#include <ros/callback_queue.h>
#include <ros/ros.h>
#include <ros_test/arm_controller_test.h>
#include <ros_test/eventually.h>
#include <rosgraph_msgs/Log.h>
#include <rt_guard/rt_guard.h>

#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace franka_example_controllers {
namespace {

using ros_test::eventually;
using ros_test::jointNames;
using ros_test::Names;

/// A simple model with predictable torques: joint i moves along axis i of the end effector.
class PlainModel : public franka_hw::ModelBase {
 public:
  std::array<double, 16> pose(franka::Frame, const std::array<double, 7>&,
                              const std::array<double, 16>&,
                              const std::array<double, 16>&) const override {
    return {};
  }
  std::array<double, 42> bodyJacobian(franka::Frame, const std::array<double, 7>&,
                                      const std::array<double, 16>&,
                                      const std::array<double, 16>&) const override {
    return {};
  }
  std::array<double, 42> zeroJacobian(franka::Frame frame, const std::array<double, 7>&,
                                      const std::array<double, 16>&,
                                      const std::array<double, 16>&) const override {
    std::array<double, 42> jacobian{};
    for (std::size_t i = 0; frame == franka::Frame::kEndEffector && i < 6; ++i) {
      jacobian[7 * i] = 1.0;
    }
    return jacobian;
  }
  std::array<double, 49> mass(const std::array<double, 7>&, const std::array<double, 9>&, double,
                              const std::array<double, 3>&) const override {
    return {};
  }
  std::array<double, 7> coriolis(const std::array<double, 7>&, const std::array<double, 7>&,
                                 const std::array<double, 9>&, double,
                                 const std::array<double, 3>&) const override {
    return {};
  }
  std::array<double, 7> gravity(const std::array<double, 7>&, double, const std::array<double, 3>&,
                                const std::array<double, 3>&) const override {
    return {};
  }
};

class FakeRobot : public hardware_interface::RobotHW {
 public:
  explicit FakeRobot(const std::string& arm_id) {
    states_.registerHandle(franka_hw::FrankaStateHandle(arm_id + "_robot", state));
    models_.registerHandle(franka_hw::FrankaModelHandle(arm_id + "_model", model_, state));
    const Names names = jointNames(arm_id);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const hardware_interface::JointStateHandle joint(names[i], &state.q[i], &state.dq[i],
                                                       &state.tau_J[i]);
      efforts_.registerHandle(hardware_interface::JointHandle(joint, &command[i]));
    }
    registerInterface(&states_);
    registerInterface(&models_);
    registerInterface(&efforts_);
    state.O_T_EE = {{1, 0, 0, 0, 0, -1, 0, 0, 0, 0, -1, 0, 0.3, 0.0, 0.5, 1}};
  }

  franka::RobotState state;
  std::array<double, 7> command{};

 private:
  PlainModel model_;
  franka_hw::FrankaStateInterface states_;
  franka_hw::FrankaModelInterface models_;
  hardware_interface::EffortJointInterface efforts_;
};

class ControllerTest : public ros_test::ArmControllerTest {
 protected:
  ControllerTest() { setParameters("panda"); }

  bool initialize(CartesianImpedanceExampleController& controller,
                  hardware_interface::RobotHW& robot) {
    ros::NodeHandle root;
    controller_interface::ControllerBase& base = controller;
    return base.initRequest(&robot, root, node, claims);
  }

  /// Runs the controller for some milliseconds on an arm that follows its commands.
  void run(CartesianImpedanceExampleController& controller, FakeRobot& robot, int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      controller.update(ros::Time(1.0 + 1e-3 * i), ros::Duration(0.001));
      robot.state.tau_J_d = robot.command;
    }
  }

  geometry_msgs::PoseStamped poseMessage(double x, double w = 0.0) {
    geometry_msgs::PoseStamped message;
    message.pose.position.x = x;
    message.pose.position.z = 0.5;
    message.pose.orientation.x = 1.0;
    message.pose.orientation.w = w;
    return message;
  }

  /// Publishes and waits until the controller has received the message.
  void send(const geometry_msgs::PoseStamped& message) {
    if (!publisher) {
      publisher = node.advertise<geometry_msgs::PoseStamped>("equilibrium_pose", 10);
    }
    ASSERT_TRUE(eventually([&] { return publisher.getNumSubscribers() > 0; }));
    publisher.publish(message);
  }

  bool setStiffness(double translational, double nullspace,
                    dynamic_reconfigure::Config* answer = nullptr) {
    dynamic_reconfigure::Reconfigure call;
    dynamic_reconfigure::DoubleParameter value;
    value.name = "translational_stiffness";
    value.value = translational;
    call.request.config.doubles.push_back(value);
    value.name = "nullspace_stiffness";
    value.value = nullspace;
    call.request.config.doubles.push_back(value);
    const std::string service =
        node.resolveName("dynamic_reconfigure_compliance_param_node/set_parameters");
    const bool is_done = ros::service::call(service, call);
    if (answer != nullptr) {
      *answer = call.response.config;
    }
    return is_done;
  }

  ros::Publisher publisher;
  controller_interface::ControllerBase::ClaimedResources claims;
};

TEST_F(ControllerTest, FollowsTheEquilibriumPoseWithItsStiffness) {
  FakeRobot robot("panda");
  CartesianImpedanceExampleController controller;
  ASSERT_TRUE(initialize(controller, robot));
  controller.starting(ros::Time(1.0));
  send(poseMessage(0.35));
  ASSERT_TRUE(eventually([&] {
    run(controller, robot, 1);
    return robot.command[0] > 1e-3;
  }));
  run(controller, robot, 5000);
  EXPECT_NEAR(200.0 * 0.05, robot.command[0], 1e-6) << "the default stiffness times 5 cm";
  EXPECT_NEAR(0.0, robot.command[1], 1e-9);

  // A quaternion of any length and sign is normalized.
  auto message = poseMessage(0.35);
  message.pose.orientation.x = -3.0;
  send(message);
  send(poseMessage(0.31));
  ASSERT_TRUE(eventually([&] {
    run(controller, robot, 1);
    return robot.command[0] < 9.9;
  }));
  run(controller, robot, 5000);
  EXPECT_NEAR(200.0 * 0.01, robot.command[0], 1e-6);
  for (int i = 3; i < 6; ++i) {
    EXPECT_NEAR(0.0, robot.command[i], 1e-9);
  }
}

TEST_F(ControllerTest, DropsPosesFromBeforeItsStart) {
  FakeRobot robot("panda");
  CartesianImpedanceExampleController controller;
  ASSERT_TRUE(initialize(controller, robot));
  controller.starting(ros::Time(1.0));
  send(poseMessage(0.35));
  ASSERT_TRUE(eventually([&] {
    run(controller, robot, 1);
    return robot.command[0] > 1e-3;
  }));
  robot.state.tau_J_d.fill(0.0);
  controller.starting(ros::Time(2.0));
  run(controller, robot, 100);
  for (double torque : robot.command) {
    EXPECT_NEAR(0.0, torque, 1e-12);
  }
}

TEST_F(ControllerTest, RefusesInvalidPoses) {
  FakeRobot robot("panda");
  CartesianImpedanceExampleController controller;
  ASSERT_TRUE(initialize(controller, robot));
  controller.starting(ros::Time(1.0));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinite = std::numeric_limits<double>::infinity();
  auto zero = poseMessage(0.9);
  zero.pose.orientation.x = 0.0;
  send(poseMessage(nan));
  send(poseMessage(infinite));
  send(poseMessage(0.9, nan));
  send(poseMessage(0.9, infinite));
  send(zero);
  send(poseMessage(0.29));  // sent last, so that the others were received before
  ASSERT_TRUE(eventually([&] {
    run(controller, robot, 1);
    return robot.command[0] < -1e-3;
  }));
  run(controller, robot, 5000);
  EXPECT_NEAR(-200.0 * 0.01, robot.command[0], 1e-6);
}

TEST_F(ControllerTest, TakesStiffnessFromDynamicReconfigure) {
  FakeRobot robot("panda");
  CartesianImpedanceExampleController controller;
  ASSERT_TRUE(initialize(controller, robot));
  controller.starting(ros::Time(1.0));

  // Joint 7 moves nothing: it is the whole null space, with 0.5 Nm/rad from the first cycle on.
  robot.state.q[6] = 0.2;
  run(controller, robot, 1);
  EXPECT_NEAR(-0.5 * 0.2, robot.command[6], 1e-12);

  ASSERT_TRUE(setStiffness(400.0, 10.0));
  ASSERT_TRUE(eventually([&] {
    run(controller, robot, 1);
    return robot.command[6] < -0.11;
  }));
  run(controller, robot, 5000);
  EXPECT_NEAR(-10.0 * 0.2, robot.command[6], 1e-6);
  robot.state.O_T_EE[12] += 0.01;
  run(controller, robot, 100);
  EXPECT_NEAR(-400.0 * 0.01, robot.command[0], 1e-6);

  dynamic_reconfigure::Config answer;
  ASSERT_TRUE(setStiffness(1e6, std::numeric_limits<double>::quiet_NaN(), &answer));
  for (const auto& parameter : answer.doubles) {
    EXPECT_TRUE(std::isfinite(parameter.value)) << parameter.name;
  }
  run(controller, robot, 5000);
  EXPECT_NEAR(-10.0 * 0.2, robot.command[6], 1e-6) << "invalid values change nothing";
}

TEST_F(ControllerTest, UpdateNeitherAllocatesNorLocks) {
  FakeRobot robot("panda");
  CartesianImpedanceExampleController controller;
  ASSERT_TRUE(initialize(controller, robot));
  for (int n = 0; n < 5; ++n) {
    send(poseMessage(0.3 + 0.01 * n));
    ASSERT_TRUE(setStiffness(100.0 + n, 1.0));
    rt_guard::Scope scope;
    controller.starting(ros::Time(1.0));
    run(controller, robot, 100);
    EXPECT_EQ(0U, scope.allocations());
    EXPECT_EQ(0U, scope.locks());
  }
}

TEST_F(ControllerTest, RefusesMissingAndWrongParametersWithOneSentence) {
  std::vector<std::string> errors;
  ros::CallbackQueue queue;
  ros::NodeHandle listener;
  listener.setCallbackQueue(&queue);
  const ros::Subscriber log = listener.subscribe<rosgraph_msgs::Log>(
      "/rosout", 100, [&](const rosgraph_msgs::LogConstPtr& message) {
        if (message->level >= rosgraph_msgs::Log::ERROR &&
            message->msg.find("Failed to initialize the controller") == std::string::npos) {
          errors.push_back(message->msg);
        }
      });
  ASSERT_TRUE(eventually([&] { return log.getNumPublishers() > 0; }));

  FakeRobot robot("panda");
  const auto expectRefusal = [&](const std::string& words) {
    errors.clear();
    CartesianImpedanceExampleController controller;
    EXPECT_FALSE(initialize(controller, robot)) << words;
    ROS_ERROR("the end");  // arrives after all others
    EXPECT_TRUE(eventually([&] {
      queue.callAvailable();
      return !errors.empty() && errors.back() == "the end";
    })) << words;
    ASSERT_EQ(2U, errors.size()) << words;
    EXPECT_EQ(0U, errors[0].find("CartesianImpedanceExampleController: ")) << errors[0];
    EXPECT_NE(std::string::npos, errors[0].find(words)) << errors[0];
  };
  node.deleteParam("arm_id");
  expectRefusal("set the parameter " + node.getNamespace() + "/arm_id");
  node.setParam("arm_id", "");
  expectRefusal("set the parameter " + node.getNamespace() + "/arm_id");
  setParameters("panda");
  for (int count : {6, 8}) {
    node.setParam("joint_names", jointNames("panda", count));
    expectRefusal("seven joint names; it has " + std::to_string(count));
  }
  node.setParam("joint_names", "panda_joint1");
  expectRefusal("seven joint names");
  setParameters("fr3");
  expectRefusal("Could not find resource 'fr3_model' in 'franka_hw::FrankaModelInterface'.");
  node.setParam("arm_id", "panda");
  expectRefusal(
      "Could not find resource 'fr3_joint1' in 'hardware_interface::EffortJointInterface'.");
}

}  // namespace
}  // namespace franka_example_controllers

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "cartesian_impedance_example_controller_test");
  ros::AsyncSpinner spinner(1);
  spinner.start();
  return RUN_ALL_TESTS();
}
