// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// std::bind, with the standard library's placeholders in the whole file.
#include <control_toolbox/ParametersConfig.h>
#include <controller_interface/controller.h>
#include <dynamic_reconfigure/server.h>
#include <hardware_interface/joint_command_interface.h>
#include <pluginlib/class_list_macros.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64.h>

#include <functional>
#include <memory>

using namespace std::placeholders;

namespace bound_callbacks {

class StdController
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  bool init(hardware_interface::EffortJointInterface* /*hw*/,
            ros::NodeHandle& node_handle) override {
    subscriber_ = node_handle.subscribe<std_msgs::Float64>(
        "target", 1, std::bind(&StdController::targetCallback, this, _1, 2.0));
    server_ = std::make_unique<Server>(node_handle);
    server_->setCallback(std::bind(&StdController::parameterCallback, this, _1, _2));
    return true;
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {}

 private:
  typedef dynamic_reconfigure::Server<control_toolbox::ParametersConfig> Server;

  void targetCallback(const std_msgs::Float64ConstPtr& message, double scale) {
    target_ = message->data * scale;
  }
  void parameterCallback(control_toolbox::ParametersConfig& config, uint32_t /*level*/) {
    gain_ = config.p;
  }

  ros::Subscriber subscriber_;
  std::unique_ptr<Server> server_;
  double target_{0.0};
  double gain_{0.0};
};

}  // namespace bound_callbacks

PLUGINLIB_EXPORT_CLASS(bound_callbacks::StdController, controller_interface::ControllerBase)
