// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_example_controllers/controller_parameters.h>
#include <franka_example_controllers/robot_handles.h>
#include <franka_example_controllers/teleop_joint_pd_example_controller.h>
#include <joint_limits_interface/joint_limits.h>
#include <joint_limits_interface/joint_limits_urdf.h>
#include <pluginlib/class_list_macros.h>
#include <ros/names.h>
#include <urdf/model.h>

#include <array>
#include <cmath>

namespace franka_example_controllers {

namespace {

// The walls before the soft limits; the original's constants. [rad] [Nm/rad] [Nm s/rad]
constexpr std::array<double, 7> kWallWidth{{0.12, 0.09, 0.09, 0.09, 0.0349, 0.0349, 0.0349}};
constexpr std::array<double, 7> kWallStiffness{
    {2000.0, 2000.0, 1000.0, 1000.0, 500.0, 200.0, 200.0}};
constexpr std::array<double, 7> kWallDamping{{30.0, 30.0, 30.0, 10.0, 5.0, 5.0, 5.0}};

bool readVector(const char* controller, const ros::NodeHandle& nh, const std::string& name,
                Vector7d& values) {
  std::vector<double> gains;
  if (!readGains(controller, nh, name, gains)) {
    return false;
  }
  values = Eigen::Map<const Vector7d>(gains.data());
  return true;
}

bool readThreshold(const char* controller, const ros::NodeHandle& nh, double& value) {
  if (nh.getParam("contact_force_threshold", value) && std::isfinite(value)) {
    return true;
  }
  ROS_ERROR("%s: the parameter %s must be a number [N].", controller,
            nh.resolveName("contact_force_threshold").c_str());
  return false;
}

Vector7d vector(const std::array<double, 7>& values) {
  return Eigen::Map<const Vector7d>(values.data());
}

std::array<double, 7> array(const Vector7d& values) {
  std::array<double, 7> result;
  Eigen::Map<Vector7d>(result.data()) = values;
  return result;
}

}  // namespace

bool TeleopJointPDExampleController::init(hardware_interface::RobotHW* robot_hw,
                                          ros::NodeHandle& node_handle) {
  if (!readParameters(node_handle) ||
      !initArm(robot_hw, ros::NodeHandle(node_handle, "leader"), leader_) ||
      !initArm(robot_hw, ros::NodeHandle(node_handle, "follower"), follower_)) {
    return false;
  }
  parameters_in_use_.writeFromNonRT(parameters_);
  if (node_handle.param("debug", false)) {
    offerReconfigure(node_handle);
  }
  return true;
}

bool TeleopJointPDExampleController::readParameters(const ros::NodeHandle& node_handle) {
  const ros::NodeHandle leader(node_handle, "leader");
  const ros::NodeHandle follower(node_handle, "follower");
  TeleopParameters& p = parameters_;
  return readVector(kName, leader, "d_gains_lower", p.leader_d_gains_lower) &&
         readVector(kName, leader, "d_gains_upper", p.leader_d_gains_upper) &&
         readVector(kName, leader, "dq_max_lower", p.leader_dq_max_lower) &&
         readVector(kName, leader, "dq_max_upper", p.leader_dq_max_upper) &&
         readVector(kName, follower, "p_gains", p.follower_p_gains) &&
         readVector(kName, follower, "d_gains", p.follower_d_gains) &&
         readVector(kName, follower, "drift_comp_gains", p.drift_comp_gains) &&
         readVector(kName, follower, "dq_max_lower", p.follower_dq_max_lower) &&
         readVector(kName, follower, "dq_max_upper", p.follower_dq_max_upper) &&
         readVector(kName, follower, "ddq_max_lower", p.follower_ddq_max_lower) &&
         readVector(kName, follower, "ddq_max_upper", p.follower_ddq_max_upper) &&
         readThreshold(kName, leader, p.leader_contact_force_threshold) &&
         readThreshold(kName, follower, p.follower_contact_force_threshold);
}

bool TeleopJointPDExampleController::initArm(hardware_interface::RobotHW* robot_hw,
                                             const ros::NodeHandle& node_handle,
                                             FrankaDataContainer7& arm) {
  std::vector<std::string> joint_names;
  return readArmId(kName, node_handle, arm.arm_id) &&
         readJointNames(kName, node_handle, joint_names) &&
         takeHandles(
             kName, arm.arm_id,
             [&] {
               arm.state_handle = std::make_unique<franka_hw::FrankaStateHandle>(
                   takeHandle<franka_hw::FrankaStateInterface>(robot_hw, arm.arm_id + "_robot"));
               arm.joint_handles =
                   takeJoints<hardware_interface::EffortJointInterface>(robot_hw, joint_names);
             }) &&
         buildWalls(node_handle, joint_names, arm);
}

bool TeleopJointPDExampleController::buildWalls(const ros::NodeHandle& node_handle,
                                                const std::vector<std::string>& joint_names,
                                                FrankaDataContainer7& arm) {
  // <parent>/<controller>/leader: the description is beside the controller.
  const std::string parent =
      ros::names::parentNamespace(ros::names::parentNamespace(node_handle.getNamespace()));
  urdf::Model model;
  if (!model.initParamWithNodeHandle("robot_description", ros::NodeHandle(parent))) {
    ROS_ERROR("%s: no URDF could be read from the parameter '%s'.", kName,
              ros::names::append(parent, "robot_description").c_str());
    return false;
  }
  std::array<double, 7> upper{};
  std::array<double, 7> lower{};
  for (std::size_t i = 0; i < upper.size(); ++i) {
    joint_limits_interface::SoftJointLimits limits;
    if (!joint_limits_interface::getSoftJointLimits(model.getJoint(joint_names[i]), limits)) {
      ROS_ERROR("%s: joint '%s' has no <safety_controller> in the URDF, and so no soft limits.",
                kName, joint_names[i].c_str());
      return false;
    }
    upper[i] = limits.max_position;
    lower[i] = limits.min_position;
  }
  arm.walls = std::make_unique<JointWallContainer<7>>(upper, lower, kWallWidth, kWallWidth,
                                                      kWallStiffness, kWallDamping, kWallDamping);
  return true;
}

// --- debug functions -----------------------------------------------------------------------------

void TeleopJointPDExampleController::offerReconfigure(const ros::NodeHandle& node_handle) {
  publishers_ = std::make_unique<Publishers>();
  publishers_->leader_target.init(node_handle, "leader_target", 1);
  publishers_->follower_target.init(node_handle, "follower_target", 1);
  publishers_->leader_contact.init(node_handle, "leader_contact", 1);
  publishers_->follower_contact.init(node_handle, "follower_contact", 1);
  publishers_->marker_labels.init(node_handle, "marker_labels", 1, true);
  for (auto* const target : {&publishers_->leader_target, &publishers_->follower_target}) {
    const FrankaDataContainer7& arm = target == &publishers_->leader_target ? leader_ : follower_;
    for (const hardware_interface::JointHandle& joint : arm.joint_handles) {
      target->msg_.name.push_back(joint.getName());
    }
    target->msg_.position.resize(7);
    target->msg_.velocity.resize(7);
  }
  auto& markers = publishers_->marker_labels.msg_.markers;
  for (const FrankaDataContainer7* const arm : {&leader_, &follower_}) {
    visualization_msgs::Marker marker;
    marker.header.frame_id = arm->arm_id + "_link0";
    marker.ns = "teleop_labels";
    marker.id = static_cast<int>(markers.size());
    marker.type = visualization_msgs::Marker::TEXT_VIEW_FACING;
    marker.pose.position.z = 1.0;
    marker.pose.orientation.w = 1.0;
    marker.scale.z = 0.1;
    marker.color.r = marker.color.g = marker.color.b = marker.color.a = 1.0F;
    marker.text = arm == &leader_ ? "leader" : "follower";
    markers.push_back(marker);
  }

  // The values read become the server's, so that its defaults do not overwrite them.
  const ros::NodeHandle server_nh("dyn_reconf_teleop_param_node");
  teleop_paramConfig config = teleop_paramConfig::__getDefault__();
  const TeleopParameters& p = parameters_;
  config.leader_contact_force_threshold = p.leader_contact_force_threshold;
  config.follower_contact_force_threshold = p.follower_contact_force_threshold;
#define SET_JOINT(i)                                    \
  config.dq_l_##i = p.follower_dq_max_lower[(i) - 1];   \
  config.dq_u_##i = p.follower_dq_max_upper[(i) - 1];   \
  config.ddq_l_##i = p.follower_ddq_max_lower[(i) - 1]; \
  config.ddq_u_##i = p.follower_ddq_max_upper[(i) - 1]
  SET_JOINT(1);
  SET_JOINT(2);
  SET_JOINT(3);
  SET_JOINT(4);
  SET_JOINT(5);
  SET_JOINT(6);
  SET_JOINT(7);
#undef SET_JOINT
  config.force_feedback_idle = p.force_feedback_idle;
  config.force_feedback_guiding = p.force_feedback_guiding;
  config.__toServer__(server_nh);
  server_ = std::make_unique<dynamic_reconfigure::Server<teleop_paramConfig>>(server_nh);
  server_->setCallback(
      [this](teleop_paramConfig& changed, uint32_t /*level*/) { reconfigure(changed); });
}

void TeleopJointPDExampleController::reconfigure(const teleop_paramConfig& config) {
  TeleopParameters p = parameters_;
  p.leader_damping_scaling = config.leader_damping_scaling;
  p.follower_stiffness_scaling = config.follower_stiffness_scaling;
  p.force_feedback_idle = config.force_feedback_idle;
  p.force_feedback_guiding = config.force_feedback_guiding;
  p.leader_contact_force_threshold = config.leader_contact_force_threshold;
  p.follower_contact_force_threshold = config.follower_contact_force_threshold;
  p.follower_dq_max_lower << config.dq_l_1, config.dq_l_2, config.dq_l_3, config.dq_l_4,
      config.dq_l_5, config.dq_l_6, config.dq_l_7;
  p.follower_dq_max_upper << config.dq_u_1, config.dq_u_2, config.dq_u_3, config.dq_u_4,
      config.dq_u_5, config.dq_u_6, config.dq_u_7;
  p.follower_ddq_max_lower << config.ddq_l_1, config.ddq_l_2, config.ddq_l_3, config.ddq_l_4,
      config.ddq_l_5, config.ddq_l_6, config.ddq_l_7;
  p.follower_ddq_max_upper << config.ddq_u_1, config.ddq_u_2, config.ddq_u_3, config.ddq_u_4,
      config.ddq_u_5, config.ddq_u_6, config.ddq_u_7;
  parameters_in_use_.writeFromNonRT(p);
}

void TeleopJointPDExampleController::publish(const ros::Time& time) {
  if (publishers_->leader_target.trylock()) {
    sensor_msgs::JointState& message = publishers_->leader_target.msg_;
    message.header.stamp = time;
    const franka::RobotState& state = leader_.state_handle->getRobotState();
    std::copy(state.q.begin(), state.q.end(), message.position.begin());
    std::copy(state.dq.begin(), state.dq.end(), message.velocity.begin());
    publishers_->leader_target.unlockAndPublish();
  }
  if (publishers_->follower_target.trylock()) {
    sensor_msgs::JointState& message = publishers_->follower_target.msg_;
    message.header.stamp = time;
    for (std::size_t i = 0; i < 7; ++i) {
      message.position[i] = follow_.target()[static_cast<Eigen::Index>(i)];
      message.velocity[i] = follow_.targetVelocity()[static_cast<Eigen::Index>(i)];
    }
    publishers_->follower_target.unlockAndPublish();
  }
  if (publishers_->leader_contact.trylock()) {
    publishers_->leader_contact.msg_.data = follow_.leaderContact();
    publishers_->leader_contact.unlockAndPublish();
  }
  if (publishers_->follower_contact.trylock()) {
    publishers_->follower_contact.msg_.data = follow_.followerContact();
    publishers_->follower_contact.unlockAndPublish();
  }
  if (publishers_->marker_labels.trylock()) {
    for (visualization_msgs::Marker& marker : publishers_->marker_labels.msg_.markers) {
      marker.header.stamp = time;
    }
    publishers_->marker_labels.unlockAndPublish();
  }
}

// --- the loop ------------------------------------------------------------------------------------

TeleopArm TeleopJointPDExampleController::armOf(const FrankaDataContainer7& arm) noexcept {
  const franka::RobotState& state = arm.state_handle->getRobotState();
  TeleopArm result;
  result.q = vector(state.q);
  result.dq = vector(state.dq);
  result.tau_ext = vector(state.tau_ext_hat_filtered);
  result.force_ext = Eigen::Map<const Eigen::Vector3d>(state.K_F_ext_hat_K.data());
  result.has_error = static_cast<bool>(state.current_errors);
  return result;
}

void TeleopJointPDExampleController::starting(const ros::Time& time) {
  follow_.start(armOf(leader_), armOf(follower_));
  leader_.walls->reset();
  follower_.walls->reset();
  rate_ = franka_hw::TriggerRate(kPublishRate, time);
}

void TeleopJointPDExampleController::update(const ros::Time& time, const ros::Duration& period) {
  const TeleopArm leader = armOf(leader_);
  const TeleopArm follower = armOf(follower_);
  follow_.update(*parameters_in_use_.readFromRT(), leader, follower, period.toSec());
  command(leader_, follow_.leaderTorque());
  command(follower_, follow_.followerTorque());
  if (publishers_ && rate_(time)) {
    publish(time);
  }
}

void TeleopJointPDExampleController::command(FrankaDataContainer7& arm, const Vector7d& tau) {
  const franka::RobotState& state = arm.state_handle->getRobotState();
  const std::array<double, 7> walls = arm.walls->computeTorque(state.q, state.dq);
  const std::array<double, 7> torque = array(tau + vector(walls));
  for (std::size_t i = 0; i < arm.joint_handles.size(); ++i) {
    arm.joint_handles[i].setCommand(torque[i]);
  }
}

}  // namespace franka_example_controllers

PLUGINLIB_EXPORT_CLASS(franka_example_controllers::TeleopJointPDExampleController,
                       controller_interface::ControllerBase)
