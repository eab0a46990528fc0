// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
/// @file
/// Ways in which a node is asked to end. ROS goes on until the node has ended what uses it.

#include "shutdown_request.h"

#include <gtest/gtest.h>
#include <ros/init.h>
#include <ros/node_handle.h>
#include <ros/xmlrpc_manager.h>
#include <ros_test/eventually.h>
#include <std_msgs/Empty.h>

#include <chrono>
#include <csignal>

namespace franka_sim_mujoco {
namespace {

constexpr std::chrono::minutes kLong{10};

/// Whether something can be advertised, as by a controller that is created now.
bool advertises() { return ros::NodeHandle("~").advertise<std_msgs::Empty>("topic", 1); }

TEST(ShutdownRequest, OfSigintLeavesRosUntilTheNodeHasEnded) {
  ShutdownRequest shutdown(kLong);
  std::raise(SIGINT);
  shutdown.wait();
  EXPECT_FALSE(ros::isShuttingDown());
  EXPECT_TRUE(advertises());
}

TEST(ShutdownRequest, OfRosnodeKillLeavesRosUntilTheNodeHasEnded) {
  ShutdownRequest shutdown(kLong);
  XmlRpc::XmlRpcClient slave(
      "127.0.0.1", static_cast<int>(ros::XMLRPCManager::instance()->getServerPort()), "/");
  XmlRpc::XmlRpcValue parameters;
  XmlRpc::XmlRpcValue result;
  parameters[0] = "/rosnode";
  parameters[1] = "user request";
  ASSERT_TRUE(slave.execute("shutdown", parameters, result));
  EXPECT_EQ(1, static_cast<int>(result[0]));
  shutdown.wait();
  EXPECT_FALSE(ros::isShuttingDown());
  EXPECT_TRUE(advertises());
}

/// The last one, as it ends ROS.
TEST(ShutdownRequestThatTheNodeDoesNotFollow, EndsRos) {
  ShutdownRequest shutdown(std::chrono::milliseconds(1));
  requestShutdown();
  shutdown.wait();
  EXPECT_TRUE(ros_test::eventually([] { return !ros::ok(); }));
  EXPECT_FALSE(advertises());
}

}  // namespace
}  // namespace franka_sim_mujoco

int main(int argc, char** argv) {
  testing::InitGoogleTest(&argc, argv);
  ros::init(argc, argv, "shutdown_request_test");
  const ros::NodeHandle keeps_ros_running;
  return RUN_ALL_TESTS();
}
