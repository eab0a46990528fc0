// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka/model.h>
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/dual_arm_cartesian_impedance_example_controller.h>
#include <franka_example_controllers/robot_handles.h>
#include <pluginlib/class_list_macros.h>
#include <ros/transport_hints.h>
#include <tf2_ros/buffer.h>
#include <tf2_ros/transform_listener.h>

#include <cmath>

namespace franka_example_controllers {

namespace {

Eigen::Affine3d poseOf(const FrankaDataContainer& arm) {
  return Eigen::Affine3d(
      Eigen::Map<const Eigen::Matrix4d>(arm.state_handle->getRobotState().O_T_EE.data()));
}

template <typename Orientation>
Eigen::Quaterniond quaternion(const Orientation& q) {
  return Eigen::Quaterniond(q.w, q.x, q.y, q.z);
}

}  // namespace

bool DualArmCartesianImpedanceExampleController::init(hardware_interface::RobotHW* robot_hw,
                                                      ros::NodeHandle& node_handle) {
  if (!initArm(robot_hw, ros::NodeHandle(node_handle, "left"), left_) ||
      !initArm(robot_hw, ros::NodeHandle(node_handle, "right"), right_) || !findArms()) {
    return false;
  }
  publisher_.init(node_handle, "centering_frame", 1, true);
  publisher_.msg_.header.frame_id = left_.arm_id + "_link0";
  compliance_server_ = std::make_unique<dynamic_reconfigure::Server<Config>>(
      ros::NodeHandle("dynamic_reconfigure_compliance_param_node"));
  compliance_server_->setCallback(
      [this](Config& config, uint32_t /*level*/) { complianceCallback(config); });
  target_subscriber_ = node_handle.subscribe(
      "centering_frame_target_pose", 1, &DualArmCartesianImpedanceExampleController::targetCallback,
      this, ros::TransportHints().reliable().tcpNoDelay());
  return true;
}

bool DualArmCartesianImpedanceExampleController::initArm(hardware_interface::RobotHW* robot_hw,
                                                         const ros::NodeHandle& node_handle,
                                                         FrankaDataContainer& arm) {
  std::vector<std::string> joint_names;
  return readArmId(kName, node_handle, arm.arm_id) &&
         readJointNames(kName, node_handle, joint_names) && takeHandles(kName, arm.arm_id, [&] {
           arm.model_handle = std::make_unique<franka_hw::FrankaModelHandle>(
               takeHandle<franka_hw::FrankaModelInterface>(robot_hw, arm.arm_id + "_model"));
           arm.state_handle = std::make_unique<franka_hw::FrankaStateHandle>(
               takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm.arm_id + "_robot"));
           arm.joint_handles =
               takeJoints<hardware_interface::EffortJointInterface>(robot_hw, joint_names);
         });
}

bool DualArmCartesianImpedanceExampleController::findArms() {
  tf2_ros::Buffer buffer;
  const tf2_ros::TransformListener listener(buffer);
  try {
    const auto transform = buffer
                               .lookupTransform(left_.arm_id + "_link0", right_.arm_id + "_link0",
                                                ros::Time(0), ros::Duration(kTransformTimeout))
                               .transform;
    Ol_T_Or_ = Eigen::Translation3d(transform.translation.x, transform.translation.y,
                                    transform.translation.z) *
               quaternion(transform.rotation);
    return true;
  } catch (const tf2::TransformException& error) {
    ROS_ERROR(
        "%s: tf does not say where '%s_link0' stands from '%s_link0'. Both arms must be in one "
        "robot "
        "description whose robot_state_publisher runs. %s",
        kName, right_.arm_id.c_str(), left_.arm_id.c_str(), error.what());
    return false;
  }
}

void DualArmCartesianImpedanceExampleController::starting(const ros::Time& time) {
  const Stiffness& stiffness = *stiffness_.readFromRT();
  for (FrankaDataContainer* const arm : {&left_, &right_}) {
    const franka::RobotState& state = arm->state_handle->getRobotState();
    const Compliance& compliance = arm == &left_ ? stiffness.left : stiffness.right;
    arm->impedance.start(state.O_T_EE, state.q, compliance.nullspace_stiffness);
  }
  EEr_T_EEl_ = poseOf(right_).inverse() * Ol_T_Or_.inverse() * poseOf(left_);
  // Half way between both, with the axes of the left end effector.
  EEl_T_C_.setIdentity();
  EEl_T_C_.translation() = 0.5 * EEr_T_EEl_.inverse().translation();
  target_in_use_ = target_.readFromRT()->number;
  rate_ = franka_hw::TriggerRate(kPublishRate, time);
  publishCenteringFrame(time);
}

void DualArmCartesianImpedanceExampleController::update(const ros::Time& time,
                                                        const ros::Duration& /*period*/) {
  const Target& target = *target_.readFromRT();
  if (target.number != target_in_use_) {
    target_in_use_ = target.number;
    lead(target.Ol_T_C);
  }
  const Stiffness& stiffness = *stiffness_.readFromRT();
  left_.impedance.setCompliance(stiffness.left);
  right_.impedance.setCompliance(stiffness.right);
  updateArm(left_);
  updateArm(right_);
  if (rate_(time)) {
    publishCenteringFrame(time);
  }
}

void DualArmCartesianImpedanceExampleController::lead(const Eigen::Affine3d& Ol_T_C) noexcept {
  const Eigen::Affine3d left = Ol_T_C * EEl_T_C_.inverse();
  const Eigen::Affine3d right = Ol_T_Or_.inverse() * left * EEr_T_EEl_.inverse();
  left_.impedance.setEquilibrium(left.translation(), Eigen::Quaterniond(left.linear()));
  right_.impedance.setEquilibrium(right.translation(), Eigen::Quaterniond(right.linear()));
}

void DualArmCartesianImpedanceExampleController::updateArm(FrankaDataContainer& arm) {
  const franka::RobotState& state = arm.state_handle->getRobotState();
  const CartesianImpedance::Vector7 tau = arm.impedance.update(
      {state.O_T_EE, arm.model_handle->getZeroJacobian(franka::Frame::kEndEffector),
       arm.model_handle->getCoriolis(), state.q, state.dq, state.tau_J_d});
  for (std::size_t i = 0; i < arm.joint_handles.size(); ++i) {
    arm.joint_handles[i].setCommand(tau[static_cast<Eigen::Index>(i)]);
  }
}

void DualArmCartesianImpedanceExampleController::publishCenteringFrame(const ros::Time& time) {
  if (!publisher_.trylock()) {
    return;
  }
  const Eigen::Affine3d Ol_T_C = poseOf(left_) * EEl_T_C_;
  const Eigen::Quaterniond orientation = Eigen::Quaterniond(Ol_T_C.linear()).normalized();
  geometry_msgs::PoseStamped& message = publisher_.msg_;
  message.header.stamp = time;
  message.pose.position.x = Ol_T_C.translation().x();
  message.pose.position.y = Ol_T_C.translation().y();
  message.pose.position.z = Ol_T_C.translation().z();
  message.pose.orientation.x = orientation.x();
  message.pose.orientation.y = orientation.y();
  message.pose.orientation.z = orientation.z();
  message.pose.orientation.w = orientation.w();
  publisher_.unlockAndPublish();
}

void DualArmCartesianImpedanceExampleController::targetCallback(
    const geometry_msgs::PoseStampedConstPtr& message) {
  const std::string frame = left_.arm_id + "_link0";
  if (message->header.frame_id != frame) {
    ROS_ERROR_THROTTLE(1.0, "%s: a target pose in '%s' was ignored; it must be given in '%s'.",
                       kName, message->header.frame_id.c_str(), frame.c_str());
    return;
  }
  const auto& p = message->pose.position;
  const Eigen::Vector3d position(p.x, p.y, p.z);
  const Eigen::Quaterniond orientation = quaternion(message->pose.orientation);
  if (!position.allFinite() || !(orientation.norm() > kMinQuaternionNorm)) {
    ROS_ERROR_THROTTLE(1.0,
                       "%s: a target pose was ignored, since its position is not finite or its "
                       "quaternion is not a rotation.",
                       kName);
    return;
  }
  Target target;
  target.Ol_T_C = Eigen::Translation3d(position) * orientation.normalized();
  target.number = ++targets_received_;
  target_.writeFromNonRT(target);
}

void DualArmCartesianImpedanceExampleController::complianceCallback(Config& config) {
  Stiffness stiffness;
  stiffness.left = {config.left_translational_stiffness, config.left_rotational_stiffness,
                    config.left_nullspace_stiffness};
  stiffness.right = {config.right_translational_stiffness, config.right_rotational_stiffness,
                     config.right_nullspace_stiffness};
  for (const Compliance& compliance : {stiffness.left, stiffness.right}) {
    if (!std::isfinite(compliance.translational_stiffness + compliance.rotational_stiffness +
                       compliance.nullspace_stiffness)) {
      ROS_ERROR_THROTTLE(1.0, "%s: a stiffness that is not a number was ignored.", kName);
      return;
    }
  }
  stiffness_.writeFromNonRT(stiffness);
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::DualArmCartesianImpedanceExampleController,
                       controller_interface::ControllerBase)
