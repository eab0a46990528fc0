// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// FrankaHW: its parameters.
#include <franka/control_tools.h>
#include <franka/rate_limiting.h>
#include <franka_core/arm_model.h>
#include <franka_core/realtime_rule.h>
#include <franka_hw/franka_hw.h>
#include <ros/console.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <string>

#include "command_permission.h"

namespace franka_hw {

namespace {

const std::vector<double> kTorqueThresholds{20.0, 20.0, 18.0, 18.0, 16.0, 14.0, 12.0};  // [Nm]
const std::vector<double> kForceThresholds{20.0, 20.0, 20.0, 25.0, 25.0, 25.0};         // [N, Nm]

/// Reads a required parameter. @returns false, after logging the reason, if it is missing or wrong
template <typename T>
bool require(const ros::NodeHandle& nh, const std::string& name, const char* what, T& value) {
  if (nh.getParam(name, value)) {
    return true;
  }
  ROS_ERROR_STREAM("FrankaHW: the parameter '" << nh.resolveName(name) << "' is missing or is not "
                                               << what << ".");
  return false;
}

template <std::size_t size>
bool readThresholds(const ros::NodeHandle& nh, const std::string& name,
                    const std::vector<double>& defaults, std::array<double, size>& values) {
  const std::string parameter = "collision_config/" + name;
  std::vector<double> read;
  if (nh.hasParam(parameter) && (!nh.getParam(parameter, read) || read.size() != size)) {
    ROS_ERROR_STREAM("FrankaHW: the parameter '" << nh.resolveName(parameter)
                                                 << "' is not a list of " << size
                                                 << " numbers. Correct it, or leave it out for "
                                                    "the defaults.");
    return false;
  }
  read = FrankaHW::getCollisionThresholds(parameter, nh, defaults);
  std::copy_n(read.begin(), size, values.begin());
  return true;
}

franka::ControllerMode controllerOf(const std::string& name) {
  if (name == "cartesian_impedance") {
    return franka::ControllerMode::kCartesianImpedance;
  }
  if (name != "joint_impedance") {
    ROS_WARN_STREAM("FrankaHW: internal_controller is '"
                    << name
                    << "', but must be joint_impedance or cartesian_impedance. Using "
                       "joint_impedance.");
  }
  return franka::ControllerMode::kJointImpedance;
}

bool readJointNames(const ros::NodeHandle& nh, std::array<std::string, 7>& joint_names) {
  std::vector<std::string> names;
  if (!require(nh, "joint_names", "a list of seven names", names)) {
    return false;
  }
  if (names.size() != joint_names.size()) {
    ROS_ERROR_STREAM("FrankaHW: the parameter '" << nh.resolveName("joint_names") << "' holds "
                                                 << names.size() << " names instead of seven.");
    return false;
  }
  std::copy(names.begin(), names.end(), joint_names.begin());
  return true;
}

bool readConnectTimeout(const ros::NodeHandle& nh, double& timeout) {
  std::string name;  // in a combined node, one parameter in the node's namespace may serve all arms
  if (!nh.searchParam("connect_timeout", name)) {
    return true;
  }
  if (!nh.getParam(name, timeout) || !(timeout >= 0.0)) {
    ROS_ERROR_STREAM("FrankaHW: the parameter '" << name
                                                 << "' is not a number of seconds from 0 on.");
    return false;
  }
  return true;
}

bool readRealtimeConfig(const ros::NodeHandle& nh, const std::string& arm_id,
                        const std::string& robot_ip, franka::RealtimeConfig& realtime_config) {
  std::string name = "realtime_config";
  nh.searchParam("realtime_config", name);
  const std::string config = nh.param<std::string>(name, "enforce");
  if (config != "enforce" && config != "ignore") {
    ROS_ERROR_STREAM("FrankaHW: the parameter '" << nh.resolveName(name) << "' is '" << config
                                                 << "', but must be enforce or ignore.");
    return false;
  }
  try {
    const franka_core::RealtimeRule rule = franka_core::realtimeRule(
        config == "enforce", franka_core::isLoopback(robot_ip), franka::hasRealtimeKernel());
    if (!rule.warning.empty()) {
      ROS_WARN_STREAM("FrankaHW: '" << arm_id << "' at " << robot_ip << ": " << rule.warning);
    }
    realtime_config =
        rule.enforce ? franka::RealtimeConfig::kEnforce : franka::RealtimeConfig::kIgnore;
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM("FrankaHW: " << error.what());
    return false;
  }
  return true;
}

bool readCollisionConfig(const ros::NodeHandle& nh, FrankaHW::CollisionConfig& config) {
  return readThresholds(nh, "lower_torque_thresholds_acceleration", kTorqueThresholds,
                        config.lower_torque_thresholds_acceleration) &&
         readThresholds(nh, "upper_torque_thresholds_acceleration", kTorqueThresholds,
                        config.upper_torque_thresholds_acceleration) &&
         readThresholds(nh, "lower_torque_thresholds_nominal", kTorqueThresholds,
                        config.lower_torque_thresholds_nominal) &&
         readThresholds(nh, "upper_torque_thresholds_nominal", kTorqueThresholds,
                        config.upper_torque_thresholds_nominal) &&
         readThresholds(nh, "lower_force_thresholds_acceleration", kForceThresholds,
                        config.lower_force_thresholds_acceleration) &&
         readThresholds(nh, "upper_force_thresholds_acceleration", kForceThresholds,
                        config.upper_force_thresholds_acceleration) &&
         readThresholds(nh, "lower_force_thresholds_nominal", kForceThresholds,
                        config.lower_force_thresholds_nominal) &&
         readThresholds(nh, "upper_force_thresholds_nominal", kForceThresholds,
                        config.upper_force_thresholds_nominal);
}

/// F_T_NE of robot_description; empty if it has no hand, or no chain of this arm's links.
std::unique_ptr<const std::array<double, 16>> describedEndEffector(const ros::NodeHandle& root_nh,
                                                                   const std::string& arm_id) {
  std::string name, description;
  if (!root_nh.searchParam("robot_description", name) || !root_nh.getParam(name, description)) {
    return nullptr;
  }
  try {
    const auto F_T_NE = franka_core::nominalEndEffectorFromUrdf(description, arm_id);
    return F_T_NE ? std::make_unique<const std::array<double, 16>>(*F_T_NE) : nullptr;
  } catch (const std::invalid_argument&) {
    return nullptr;  // robotMismatch() reports a description of another arm
  }
}

}  // namespace

bool FrankaHW::initParameters(ros::NodeHandle& root_nh, ros::NodeHandle& robot_hw_nh) {
  bool rate_limiting = true;
  double cutoff_frequency = 0.0;
  std::string internal_controller;
  if (!readJointNames(robot_hw_nh, joint_names_) ||
      !require(robot_hw_nh, "rate_limiting", "true or false", rate_limiting) ||
      !require(robot_hw_nh, "cutoff_frequency", "a number [Hz]", cutoff_frequency) ||
      !require(robot_hw_nh, "internal_controller", "a string", internal_controller) ||
      !require(robot_hw_nh, "arm_id", "a string", arm_id_)) {
    return false;
  }
  if (!urdf_model_.initParamWithNodeHandle("robot_description", root_nh)) {
    ROS_ERROR_STREAM("FrankaHW: no URDF could be read from the parameter '"
                     << root_nh.resolveName("robot_description")
                     << "'. The launch file must load the robot's description there.");
    return false;
  }
  described_F_T_NE_ = describedEndEffector(root_nh, arm_id_);
  if (!require(robot_hw_nh, "robot_ip", "a string (the robot's address)", robot_ip_)) {
    return false;
  }
  if (!robot_hw_nh.getParam("joint_limit_warning_threshold", joint_limit_warning_threshold_)) {
    ROS_INFO_STREAM("FrankaHW: no parameter joint_limit_warning_threshold, warning "
                    << joint_limit_warning_threshold_ << " rad before the ends of the joints.");
  }
  return readConnectTimeout(robot_hw_nh, connect_timeout_) &&
         readCollisionConfig(robot_hw_nh, collision_config_) &&
         readRealtimeConfig(robot_hw_nh, arm_id_, robot_ip_, realtime_config_) &&
         command_permission_->init(robot_hw_nh);
}

std::vector<double> FrankaHW::getCollisionThresholds(const std::string& name,
                                                     const ros::NodeHandle& robot_hw_nh,
                                                     const std::vector<double>& defaults) {
  std::vector<double> thresholds;
  if (!robot_hw_nh.getParam(name, thresholds) || thresholds.size() != defaults.size()) {
    ROS_WARN_STREAM("FrankaHW: the parameter '"
                    << robot_hw_nh.resolveName(name) << "' is missing or is not a list of "
                    << defaults.size() << " numbers; using the defaults.");
    return defaults;
  }
  return thresholds;
}

void FrankaHW::setupParameterCallbacks(ros::NodeHandle& robot_hw_nh) {
  get_limit_rate_ = [robot_hw_nh]() {
    bool rate_limiting = true;
    robot_hw_nh.getParamCached("rate_limiting", rate_limiting);
    return rate_limiting;
  };
  get_internal_controller_ = [robot_hw_nh]() {
    std::string internal_controller;
    robot_hw_nh.getParamCached("internal_controller", internal_controller);
    return controllerOf(internal_controller);
  };
  get_cutoff_frequency_ = [robot_hw_nh]() {
    double cutoff_frequency = franka::kDefaultCutoffFrequency;
    robot_hw_nh.getParamCached("cutoff_frequency", cutoff_frequency);
    return cutoff_frequency;
  };
}

bool FrankaHW::readLimits(size_t joint, joint_limits_interface::JointLimits& limits,
                          joint_limits_interface::SoftJointLimits& soft_limits) const {
  const std::string& name = joint_names_[joint];
  const urdf::JointConstSharedPtr urdf_joint = urdf_model_.getJoint(name);
  if (!urdf_joint || !urdf_joint->safety || !urdf_joint->limits) {
    ROS_WARN_STREAM("FrankaHW: joint '" << name << "' has no <limit> or no <safety_controller> in "
                                        << "the URDF: its commands are not limited here.");
    return false;
  }
  if (!joint_limits_interface::getSoftJointLimits(urdf_joint, soft_limits) ||
      !joint_limits_interface::getJointLimits(urdf_joint, limits)) {
    ROS_WARN_STREAM("FrankaHW: the limits of joint '"
                    << name << "' could not be read from the "
                    << "URDF: its commands are not limited here.");
    return false;
  }
  limits.max_acceleration = franka::kMaxJointAcceleration[joint];
  limits.has_acceleration_limits = true;
  limits.max_jerk = franka::kMaxJointJerk[joint];
  limits.has_jerk_limits = true;
  return true;
}

}  // namespace franka_hw
