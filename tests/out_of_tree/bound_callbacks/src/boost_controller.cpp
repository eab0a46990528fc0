// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// boost::bind and its placeholders in the global namespace, without an include of boost/bind.hpp.
#include <control_toolbox/ParametersConfig.h>
#include <controller_interface/multi_interface_controller.h>
#include <dynamic_reconfigure/server.h>
#include <franka_hw/franka_state_interface.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>
#include <pluginlib/class_list_macros.h>
#include <ros/node_handle.h>
#include <std_msgs/Float64.h>

#include <memory>

namespace bound_callbacks {

class BoostController
    : public controller_interface::MultiInterfaceController<
          hardware_interface::EffortJointInterface, franka_hw::FrankaStateInterface> {
 public:
  bool init(hardware_interface::RobotHW* /*robot_hw*/, ros::NodeHandle& node_handle) override {
    subscriber_ = node_handle.subscribe<std_msgs::Float64>(
        "target", 20, boost::bind(&BoostController::targetCallback, this, _1, 2.0),
        ros::VoidConstPtr(), ros::TransportHints().reliable().tcpNoDelay());
    server_ = std::make_unique<Server>(node_handle);
    server_->setCallback(boost::bind(&BoostController::parameterCallback, this, _1, _2));
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

PLUGINLIB_EXPORT_CLASS(bound_callbacks::BoostController, controller_interface::ControllerBase)
