// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

// Functions of JointTrajectoryController for set-up and destruction.

#include <joint_trajectory_controller/joint_trajectory_controller.h>
#include <urdf/model.h>

#include <algorithm>
#include <cmath>
#include <exception>
#include <set>

namespace joint_trajectory_controller {
namespace internal {

/// The names in the parameter `joints`; empty after logging an error.
inline std::vector<std::string> readJointNames(const ros::NodeHandle& nh) {
  const std::string place = nh.getNamespace() + "/joints";
  XmlRpc::XmlRpcValue value;
  if (!nh.getParam("joints", value)) {
    ROS_ERROR_STREAM("Parameter '" << place << "' not found: it lists the controller's joints.");
    return {};
  }
  if (value.getType() != XmlRpc::XmlRpcValue::TypeArray || value.size() == 0) {
    ROS_ERROR_STREAM("Parameter '" << place << "' has to be a list of one or more joint names.");
    return {};
  }
  std::vector<std::string> names;
  for (int i = 0; i < value.size(); ++i) {
    if (value[i].getType() != XmlRpc::XmlRpcValue::TypeString) {
      ROS_ERROR_STREAM("Element " << i << " of parameter '" << place << "' is not a joint name.");
      return {};
    }
    names.push_back(static_cast<std::string>(value[i]));
  }
  if (std::set<std::string>(names.begin(), names.end()).size() != names.size()) {
    ROS_ERROR_STREAM("Parameter '" << place << "' names a joint twice.");
    return {};
  }
  return names;
}

/// The robot's URDF from `robot_description` in a namespace or the nearest one above it.
/// @returns false after logging an error.
inline bool readUrdf(const ros::NodeHandle& root_nh, urdf::Model& model) {
  std::string text;
  std::string place = "robot_description";
  if (!root_nh.getParam(place, text) &&
      !(root_nh.searchParam("robot_description", place) && root_nh.getParam(place, text)) &&
      !ros::param::get("/robot_description", text)) {
    ROS_ERROR_STREAM("The robot's URDF is missing: neither '"
                     << root_nh.resolveName("robot_description")
                     << "' nor a robot_description above it is set.");
    return false;
  }
  if (!model.initString(text)) {
    ROS_ERROR_STREAM("The URDF in parameter '" << place << "' cannot be parsed.");
    return false;
  }
  return true;
}

/// A number that is finite and not negative. @returns false after logging an error.
inline bool readNumber(const ros::NodeHandle& nh, const std::string& name, double& value) {
  nh.param(name, value, value);
  if (!std::isfinite(value) || value < 0.0) {
    ROS_ERROR_STREAM("Parameter '" << nh.resolveName(name) << "' is " << value
                                   << ", but has to be a number of at least 0.");
    return false;
  }
  return true;
}

}  // namespace internal

template <class SegmentImpl, class HardwareInterface>
JointTrajectoryController<SegmentImpl, HardwareInterface>::JointTrajectoryController() = default;

template <class SegmentImpl, class HardwareInterface>
JointTrajectoryController<SegmentImpl, HardwareInterface>::~JointTrajectoryController() {
  callbacks_.stop();  // before the objects that they use
  try {
    const std::lock_guard<std::recursive_mutex> lock(mutex_);
    cancelActiveGoal("The controller '" + name_ + "' was unloaded.");
  } catch (const std::exception& error) {
    ROS_ERROR_STREAM("The end of a goal of '" << name_ << "' cannot be reported. " << error.what());
  }
  action_server_.reset();
  delete command_;
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::initRequest(
    hardware_interface::RobotHW* robot_hw, ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh,
    controller_interface::ControllerBase::ClaimedResources& claimed_resources) {
  if (!controller_interface::Controller<HardwareInterface>::initRequest(
          robot_hw, root_nh, controller_nh, claimed_resources)) {
    return false;
  }
  auto* const effects = robot_hw->get<hardware_interface::CommandEffectInterface>();
  const std::vector<std::string> offered =
      effects != nullptr ? effects->getNames() : std::vector<std::string>();
  for (const std::string& joint : joint_names_) {
    if (std::find(offered.begin(), offered.end(), joint) != offered.end()) {
      effects_.push_back(effects->getHandle(joint));
    }
  }
  return true;
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::init(
    HardwareInterface* hw, ros::NodeHandle& root_nh, ros::NodeHandle& controller_nh) {
  controller_nh_ = controller_nh;
  const std::string place = controller_nh.getNamespace();
  name_ = place.substr(place.rfind('/') + 1);
  if (!readParameters(controller_nh) || !takeJoints(hw, root_nh)) {
    return false;
  }
  if (!hw_iface_adapter_.init(joints_, controller_nh)) {
    ROS_ERROR_STREAM_NAMED(name_, "The controller '" << name_
                                                     << "' cannot command its joints through "
                                                     << this->getHardwareInterfaceType() << ".");
    return false;
  }
  sizeStates();
  openInterfaces(controller_nh);
  return true;
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::readParameters(
    ros::NodeHandle& controller_nh) {
  joint_names_ = internal::readJointNames(controller_nh);
  if (joint_names_.empty() || !readRates(controller_nh)) {
    return false;
  }
  controller_nh.param("allow_partial_joints_goal", allow_partial_joints_goal_, false);
  default_tolerances_ =
      getSegmentTolerances<Scalar>(ros::NodeHandle(controller_nh, "constraints"), joint_names_);
  return true;
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::readRates(
    ros::NodeHandle& controller_nh) {
  double state_publish_rate = 50.0;
  double stop_trajectory_duration = 0.0;
  if (!internal::readNumber(controller_nh, "state_publish_rate", state_publish_rate) ||
      !internal::readNumber(controller_nh, "action_monitor_rate", action_monitor_rate_) ||
      !internal::readNumber(controller_nh, "stop_trajectory_duration", stop_trajectory_duration)) {
    return false;
  }
  if (action_monitor_rate_ < 1e-3) {
    ROS_ERROR_STREAM("Parameter '" << controller_nh.resolveName("action_monitor_rate") << "' is "
                                   << action_monitor_rate_
                                   << " Hz: clients would never learn how their goals end.");
    return false;
  }
  state_publisher_period_ =
      state_publish_rate > 1e-9 ? ros::Duration(1.0 / state_publish_rate) : ros::Duration(0.0);
  stop_trajectory_duration_ = static_cast<Scalar>(stop_trajectory_duration);
  return true;
}

template <class SegmentImpl, class HardwareInterface>
bool JointTrajectoryController<SegmentImpl, HardwareInterface>::takeJoints(
    HardwareInterface* hw, ros::NodeHandle& root_nh) {
  urdf::Model model;
  if (!internal::readUrdf(root_nh, model)) {
    return false;
  }
  joints_.clear();
  angle_wraparound_.clear();
  for (const std::string& name : joint_names_) {
    const urdf::JointConstSharedPtr joint = model.getJoint(name);
    if (!joint) {
      ROS_ERROR_STREAM_NAMED(name_, "Could not find joint '" << name << "' in the robot's URDF.");
      return false;
    }
    angle_wraparound_.push_back(joint->type == urdf::Joint::CONTINUOUS);
    try {
      joints_.push_back(hw->getHandle(name));
    } catch (const hardware_interface::HardwareInterfaceException& error) {
      ROS_ERROR_STREAM_NAMED(name_, "Could not find joint '" << name << "' in '"
                                                             << this->getHardwareInterfaceType()
                                                             << "': " << error.what());
      return false;
    }
  }
  return true;
}

/// Gives all data of the loop their final size, so that it never allocates.
template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::sizeStates() {
  const State zero(static_cast<unsigned int>(joints_.size()));
  current_state_ = desired_state_ = state_error_ = hold_origin_ = zero;
  joint_state_ = deviation_ = zero_ = State(1);
  deviations_.assign(joints_.size(), SegmentImpl(0, zero_, 0, zero_));
  segments_.assign(joints_.size(), nullptr);
  joint_succeeded_.assign(joints_.size(), 0);
  // The loop may already move the joints: the builder reads them from starting() on.
  hold_trajectory_ = holdTrajectory(0.0, zero);
  if (stop_trajectory_duration_ > 0) {
    hold_builder_ = std::make_unique<StopBuilder>(stop_trajectory_duration_, hold_origin_);
  } else {
    hold_builder_ = std::make_unique<HoldBuilder>(joints_);
  }
  Snapshot snapshot;
  snapshot.hold_origin = snapshot.desired = snapshot.actual = snapshot.error = zero;
  snapshot_.init(snapshot);
}

template <class SegmentImpl, class HardwareInterface>
void JointTrajectoryController<SegmentImpl, HardwareInterface>::openInterfaces(
    ros::NodeHandle& controller_nh) {
  typedef JointTrajectoryController Self;
  state_publisher_ = std::make_unique<StatePublisher>();
  control_msgs::JointTrajectoryControllerState& msg = state_publisher_->msg_;
  const std::vector<double> zeros(joints_.size(), 0.0);
  msg.joint_names = joint_names_;
  msg.desired.positions = msg.desired.velocities = msg.desired.accelerations = zeros;
  msg.actual.positions = msg.actual.velocities = zeros;
  msg.error.positions = msg.error.velocities = zeros;
  state_publisher_->init(controller_nh, "state", 1);

  ros::NodeHandle own = callbacks_.of(controller_nh);
  trajectory_command_sub_ = own.subscribe("command", 1, &Self::trajectoryCommandCB, this);
  query_state_service_ = own.advertiseService("query_state", &Self::queryStateService, this);
  action_server_ = std::make_shared<ActionServer>(
      own, "follow_joint_trajectory", [this](GoalHandle gh) { goalCB(gh); },
      [this](GoalHandle gh) { cancelCB(gh); }, false);
  action_server_->start();
  // Wall time: clients get the result of their goals also while simulated time stands still.
  monitor_timer_ =
      own.createWallTimer(ros::WallDuration(1.0 / action_monitor_rate_), &Self::monitor, this);
  callbacks_.start();
}

}  // namespace joint_trajectory_controller
