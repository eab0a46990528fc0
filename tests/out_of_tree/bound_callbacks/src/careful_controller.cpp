// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// Code written for newer Boost: it has the macro, the include and the namespace itself.
#include <ros/ros.h>
// Our headers come first, so that they meet the definition of the macro afterwards.
#include <controller_interface/controller.h>
#include <hardware_interface/joint_state_interface.h>
#define BOOST_BIND_GLOBAL_PLACEHOLDERS 1
#include <pluginlib/class_list_macros.h>
#include <std_msgs/Float64.h>

#include <boost/bind.hpp>
#include <boost/bind/bind.hpp>
#include <functional>

using namespace boost::placeholders;

namespace bound_callbacks {

class CarefulController
    : public controller_interface::Controller<hardware_interface::JointStateInterface> {
 public:
  bool init(hardware_interface::JointStateInterface* /*hw*/,
            ros::NodeHandle& node_handle) override {
    first_ = node_handle.subscribe<std_msgs::Float64>(
        "first", 1, boost::bind(&CarefulController::callback, this, _1, 1));
    using std::placeholders::_1;
    second_ = node_handle.subscribe<std_msgs::Float64>(
        "second", 1, std::bind(&CarefulController::callback, this, _1, 2));
    third_ = node_handle.subscribe<std_msgs::Float64>(
        "third", 1, boost::bind(&CarefulController::callback, this, boost::placeholders::_1, 3));
    return true;
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {}

 private:
  void callback(const std_msgs::Float64ConstPtr& /*message*/, int which) { last_ = which; }

  ros::Subscriber first_, second_, third_;
  int last_{0};
};

}  // namespace bound_callbacks

PLUGINLIB_EXPORT_CLASS(bound_callbacks::CarefulController, controller_interface::ControllerBase)
