// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/force_example_controller.h>
#include <franka_example_controllers/robot_handles.h>
#include <franka_example_controllers/torque_rate.h>
#include <pluginlib/class_list_macros.h>

#include <Eigen/Core>
#include <cmath>

namespace franka_example_controllers {

namespace {

constexpr double kGravity = 9.81;  // [m/s^2]
constexpr double kForceFilter =
    0.001;  // share of the difference to a target per cycle; the original's
using Vector7 = Eigen::Matrix<double, 7, 1>;

double filtered(double current, double target) noexcept {
  return kForceFilter * target + (1.0 - kForceFilter) * current;
}

}  // namespace

bool ForceExampleController::init(hardware_interface::RobotHW* robot_hw,
                                  ros::NodeHandle& node_handle) {
  std::string arm_id;
  std::vector<std::string> joint_names;
  ROS_WARN(
      "%s: make sure that the end effector rests on something horizontal before you start "
      "this controller.",
      kName);
  if (!readArmId(kName, node_handle, arm_id) || !readJointNames(kName, node_handle, joint_names) ||
      !takeHandles(kName, arm_id, [&] {
        model_handle_ = std::make_unique<franka_hw::FrankaModelHandle>(
            takeHandle<franka_hw::FrankaModelInterface>(robot_hw, arm_id + "_model"));
        state_handle_ = std::make_unique<franka_hw::FrankaStateHandle>(
            takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm_id + "_robot"));
        joint_handles_ =
            takeJoints<hardware_interface::EffortJointInterface>(robot_hw, joint_names);
      })) {
    return false;
  }
  mass_server_ = std::make_unique<dynamic_reconfigure::Server<desired_mass_paramConfig>>(
      ros::NodeHandle("dynamic_reconfigure_desired_mass_param_node"));
  mass_server_->setCallback(
      [this](desired_mass_paramConfig& config, uint32_t /*level*/) { massCallback(config); });
  return true;
}

void ForceExampleController::massCallback(desired_mass_paramConfig& config) {
  if (!std::isfinite(config.desired_mass) || !std::isfinite(config.k_p) ||
      !std::isfinite(config.k_i)) {
    ROS_ERROR_THROTTLE(1.0, "%s: a setting that is not a number was ignored.", kName);
    return;
  }
  configured_.writeFromNonRT({config.desired_mass, config.k_p, config.k_i});
}

void ForceExampleController::starting(const ros::Time& /*time*/) {
  const franka::RobotState& state = state_handle_->getRobotState();
  const std::array<double, 7> gravity = model_handle_->getGravity();
  // Sensor values beyond gravity before contact are their bias.
  for (std::size_t i = 0; i < gravity.size(); ++i) {
    tau_ext_initial_[i] = state.tau_J[i] - gravity[i];
  }
  integral_.fill(0.0);
  target_ = Target();
}

void ForceExampleController::update(const ros::Time& /*time*/, const ros::Duration& period) {
  const franka::RobotState& state = state_handle_->getRobotState();
  const std::array<double, 42> jacobian =
      model_handle_->getZeroJacobian(franka::Frame::kEndEffector);
  const std::array<double, 7> gravity = model_handle_->getGravity();
  const Eigen::Map<const Eigen::Matrix<double, 6, 7>> J(jacobian.data());

  const double force = -kGravity * target_.mass;
  const Vector7 tau_d = J.row(2).transpose() * force;
  std::array<double, 7> tau{};
  for (std::size_t i = 0; i < tau.size(); ++i) {
    const double tau_ext = state.tau_J[i] - gravity[i] - tau_ext_initial_[i];
    const double error = tau_d[static_cast<Eigen::Index>(i)] - tau_ext;
    integral_[i] += period.toSec() * error;
    tau[i] = tau_d[static_cast<Eigen::Index>(i)] + target_.k_p * error + target_.k_i * integral_[i];
  }
  tau = saturateTorqueRate(tau, state.tau_J_d);
  for (std::size_t i = 0; i < joint_handles_.size(); ++i) {
    joint_handles_[i].setCommand(tau[i]);
  }

  const Target& configured = *configured_.readFromRT();
  target_.mass = filtered(target_.mass, configured.mass);
  target_.k_p = filtered(target_.k_p, configured.k_p);
  target_.k_i = filtered(target_.k_i, configured.k_i);
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::ForceExampleController,
                       controller_interface::ControllerBase)
