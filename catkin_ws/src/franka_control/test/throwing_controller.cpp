// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// A controller that throws on request; for tests/test_controllers_and_errors.py, which registers it
// with pluginlib.
#include <controller_interface/controller.h>
#include <hardware_interface/joint_command_interface.h>
#include <pluginlib/class_list_macros.h>
#include <ros/node_handle.h>

#include <stdexcept>
#include <string>
#include <vector>

namespace franka_control_test {

/// Holds its `joints` (names): commands zero torque in addition to the robot's own torques. Throws
/// in the callback that its parameter `throws_in` names (starting, update, or none); in update a
/// few cycles after the start. The parameter is read at each start.
class ThrowingController
    : public controller_interface::Controller<hardware_interface::EffortJointInterface> {
 public:
  bool init(hardware_interface::EffortJointInterface* hardware, ros::NodeHandle& nh) override {
    nh_ = nh;
    for (const std::string& name : nh.param("joints", std::vector<std::string>())) {
      joints_.push_back(hardware->getHandle(name));
    }
    return true;
  }
  void starting(const ros::Time& /*time*/) override {
    throws_in_ = nh_.param<std::string>("throws_in", "none");
    cycles_ = 0;
    if (throws_in_ == "starting") {
      throw std::runtime_error("I do not want to start");
    }
  }
  void update(const ros::Time& /*time*/, const ros::Duration& /*period*/) override {
    for (auto& joint : joints_) {
      joint.setCommand(0.0);
    }
    if (throws_in_ == "update" && ++cycles_ > kCyclesToBear) {
      throw std::runtime_error("I have had enough");
    }
  }

 private:
  static constexpr int kCyclesToBear = 200;

  ros::NodeHandle nh_;
  std::vector<hardware_interface::JointHandle> joints_;
  std::string throws_in_;
  int cycles_{0};
};

}  // namespace franka_control_test

PLUGINLIB_EXPORT_CLASS(franka_control_test::ThrowingController,
                       controller_interface::ControllerBase)
