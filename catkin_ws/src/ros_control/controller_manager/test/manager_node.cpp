// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A controller manager with a dummy robot and a 1 kHz loop that can be halted, for tests of
// services and scripts. It spins with one thread, so that the tests detect a switch that blocks it.
#include <controller_manager/controller_manager.h>
#include <ros/ros.h>
#include <std_srvs/SetBool.h>

#include <atomic>
#include <chrono>
#include <thread>

#include "dummies.h"

namespace {

/// Counts switches in the parameter `prepared_switches`, for tests that wait for one.
class CountingRobot : public dummies::DummyRobot {
  bool prepareSwitch(const Infos& start, const Infos& stop) override {
    const bool feasible = DummyRobot::prepareSwitch(start, stop);
    ros::param::set("prepared_switches", prepares_.load());
    return feasible;
  }
};

}  // namespace

int main(int argc, char** argv) {
  ros::init(argc, argv, "manager_node");
  ros::NodeHandle nh;
  CountingRobot robot;
  controller_manager::ControllerManager manager(&robot, nh);
  manager.registerControllerLoader(std::make_shared<dummies::DummyLoader>());

  std::atomic<bool> running{true};
  const auto set_running = [&](std_srvs::SetBool::Request& request,
                               std_srvs::SetBool::Response& response) {
    running = request.data;
    response.success = true;
    return true;
  };
  const ros::ServiceServer server =
      nh.advertiseService<std_srvs::SetBool::Request, std_srvs::SetBool::Response>("run_loop",
                                                                                   set_running);

  std::atomic<bool> ended{false};
  std::thread loop([&] {
    const ros::Duration period(0.001);
    ros::Time time(1.0);
    while (!ended) {
      if (running) {
        time += period;
        manager.update(time, period);
      }
      std::this_thread::sleep_for(std::chrono::milliseconds(1));  // the loop's period
    }
  });
  ros::spin();
  ended = true;
  loop.join();
  return 0;
}
