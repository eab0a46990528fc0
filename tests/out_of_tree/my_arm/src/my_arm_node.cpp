// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/controller_manager.h>
#include <franka/exception.h>
#include <franka_hw/franka_hw.h>
#include <franka_hw/services.h>
#include <ros/ros.h>
#include <std_srvs/Trigger.h>

#include <atomic>
#include <mutex>
#include <string>

/// A robot that counts its commands and halves the command of the last joint.
class MyArm : public franka_hw::FrankaHW {
 public:
  bool init(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) override {
    if (!FrankaHW::init(root_nh, robot_hw_nh)) {
      return false;
    }
    server_ = robot_hw_nh.advertiseService("where", &MyArm::where, this);
    return true;
  }

  void write(const ros::Time& time, const ros::Duration& period) override {
    effort_joint_command_ros_.tau_J[6] *= 0.5;
    FrankaHW::write(time, period);
    q4_ = robot_state_ros_.q[3];
    ++commands_;
  }

 private:
  bool where(std_srvs::Trigger::Request& /*request*/, std_srvs::Trigger::Response& response) {
    response.success = commands_ > 0;
    response.message = arm_id_ + " " + std::to_string(commands_) + " " + std::to_string(q4_);
    return true;
  }

  ros::ServiceServer server_;
  std::atomic<long> commands_{0};
  std::atomic<double> q4_{0.0};
};

int main(int argc, char** argv) {
  ros::init(argc, argv, "my_arm_node");
  ros::NodeHandle public_nh;
  ros::NodeHandle nh("~");
  MyArm arm;
  if (!arm.init(public_nh, nh)) {
    return 1;
  }
  franka_hw::ServiceContainer services;
  franka_hw::setupServices(arm.robot(), arm.robotMutex(), nh, services);
  controller_manager::ControllerManager manager(&arm, public_nh);
  ros::AsyncSpinner spinner(2);
  spinner.start();
  ros::Time last = ros::Time::now();
  while (ros::ok()) {
    try {
      arm.control([&](const ros::Time& now, const ros::Duration& period) {
        manager.update(now, period, period.isZero());
        arm.enforceLimits(period);
        return ros::ok();
      });
      std::lock_guard<std::mutex> lock(arm.robotMutex());
      arm.update(arm.robot().readOnce());
    } catch (const franka::Exception& e) {
      ROS_ERROR("%s", e.what());
      return 1;
    }
    const ros::Time now = ros::Time::now();
    manager.update(now, now - last);
    last = now;
  }
  return 0;
}
