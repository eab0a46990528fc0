// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>
#include <franka/robot_state.h>
#include <franka_example_controllers/cartesian_impedance_example_controller.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>
#include <ros/console.h>
#include <ros/transport_hints.h>

#include <cmath>

namespace franka_example_controllers {

namespace {

bool isFinite(const compliance_paramConfig& config) {
  return std::isfinite(config.translational_stiffness) &&
         std::isfinite(config.rotational_stiffness) && std::isfinite(config.nullspace_stiffness);
}

}  // namespace

bool CartesianImpedanceExampleController::init(hardware_interface::RobotHW* robot_hw,
                                               ros::NodeHandle& node_handle) {
  std::string arm_id;
  std::vector<std::string> joint_names;
  if (!readArmId(kName, node_handle, arm_id) || !readJointNames(kName, node_handle, joint_names) ||
      !takeHandles(robot_hw, arm_id, joint_names)) {
    return false;
  }

  // setCallback calls it at once, so the loop has the stiffness before it starts.
  compliance_server_ = std::make_unique<dynamic_reconfigure::Server<compliance_paramConfig>>(
      ros::NodeHandle(node_handle, "dynamic_reconfigure_compliance_param_node"));
  compliance_server_->getConfigDefault(accepted_compliance_);
  compliance_server_->setCallback(
      [this](compliance_paramConfig& config, uint32_t /*level*/) { complianceCallback(config); });

  equilibrium_subscriber_ = node_handle.subscribe(
      "equilibrium_pose", 20, &CartesianImpedanceExampleController::equilibriumPoseCallback, this,
      ros::TransportHints().reliable().tcpNoDelay());
  return true;
}

bool CartesianImpedanceExampleController::takeHandles(hardware_interface::RobotHW* robot_hw,
                                                      const std::string& arm_id,
                                                      const std::vector<std::string>& joint_names) {
  return franka_example_controllers::takeHandles(kName, arm_id, [&] {
    model_handle_ = std::make_unique<franka_hw::FrankaModelHandle>(
        takeHandle<franka_hw::FrankaModelInterface>(robot_hw, arm_id + "_model"));
    state_handle_ = std::make_unique<franka_hw::FrankaStateHandle>(
        takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm_id + "_robot"));
    joint_handles_ = takeJoints<hardware_interface::EffortJointInterface>(robot_hw, joint_names);
  });
}

void CartesianImpedanceExampleController::starting(const ros::Time& /*time*/) {
  const franka::RobotState& state = state_handle_->getRobotState();
  const Compliance& compliance = *compliance_.readFromRT();
  impedance_.start(state.O_T_EE, state.q, compliance.nullspace_stiffness);
  impedance_.setCompliance(compliance);
  equilibrium_in_use_ = equilibrium_.readFromRT()->number;
}

void CartesianImpedanceExampleController::update(const ros::Time& /*time*/,
                                                 const ros::Duration& /*period*/) {
  const Equilibrium& equilibrium = *equilibrium_.readFromRT();
  if (equilibrium.number != equilibrium_in_use_) {
    equilibrium_in_use_ = equilibrium.number;
    impedance_.setEquilibrium(equilibrium.position, equilibrium.orientation);
  }
  impedance_.setCompliance(*compliance_.readFromRT());

  const franka::RobotState& state = state_handle_->getRobotState();
  const CartesianImpedance::Vector7 tau =
      impedance_.update({state.O_T_EE, model_handle_->getZeroJacobian(franka::Frame::kEndEffector),
                         model_handle_->getCoriolis(), state.q, state.dq, state.tau_J_d});
  for (std::size_t i = 0; i < joint_handles_.size(); ++i) {
    joint_handles_[i].setCommand(tau[static_cast<Eigen::Index>(i)]);
  }
}

void CartesianImpedanceExampleController::equilibriumPoseCallback(
    const geometry_msgs::PoseStampedConstPtr& message) {
  const auto& position = message->pose.position;
  const auto& orientation = message->pose.orientation;
  Equilibrium equilibrium;
  equilibrium.position << position.x, position.y, position.z;
  equilibrium.orientation =
      Eigen::Quaterniond(orientation.w, orientation.x, orientation.y, orientation.z);
  const double length = equilibrium.orientation.norm();
  if (!equilibrium.position.allFinite() || !std::isfinite(length) || length < kMinQuaternionNorm) {
    ROS_ERROR_STREAM_THROTTLE(
        kLogPeriod, kName << ": an equilibrium pose was ignored, since its position (" << position.x
                          << ", " << position.y << ", " << position.z
                          << ") is not finite or its quaternion (" << orientation.x << ", "
                          << orientation.y << ", " << orientation.z << ", " << orientation.w
                          << ") is not a rotation; send numbers, and a quaternion of length 1.");
    return;
  }
  equilibrium.orientation.normalize();
  equilibrium.number = ++equilibria_received_;
  equilibrium_.writeFromNonRT(equilibrium);
}

void CartesianImpedanceExampleController::complianceCallback(compliance_paramConfig& config) {
  if (!isFinite(config)) {
    ROS_ERROR_THROTTLE(
        kLogPeriod,
        "%s: a stiffness that is not a finite number was ignored; the ones before it "
        "stay.",
        kName);
    config = accepted_compliance_;
    return;
  }
  accepted_compliance_ = config;
  Compliance compliance;
  compliance.translational_stiffness = config.translational_stiffness;
  compliance.rotational_stiffness = config.rotational_stiffness;
  compliance.nullspace_stiffness = config.nullspace_stiffness;
  compliance_.writeFromNonRT(compliance);
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::CartesianImpedanceExampleController,
                       controller_interface::ControllerBase)
