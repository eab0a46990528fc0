// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/physics/world.h>
#include <franka_sim_mujoco/device_joints.h>
#include <joint_limits_interface/joint_limits_urdf.h>
#include <ros/console.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace franka_sim_mujoco {

namespace {

constexpr char kDeviceLog[] = "device_joints";
/// Limit of the target's lead over a blocked joint in velocity control, so that it continues from
/// where it is. Chosen here: five times the drive's lag at that velocity.
constexpr double kLeadTime = 0.02;  ///< [s]

using hardware_interface::JointHandle;
using transmission_interface::TransmissionInfo;

bool claims(const std::list<hardware_interface::ControllerInfo>& controllers,
            const std::string& joint, const char* interface) noexcept {
  for (const auto& controller : controllers) {
    for (const auto& claim : controller.claimed_resources) {
      if (claim.hardware_interface == interface && claim.resources.count(joint) > 0) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace

DeviceJoints::DeviceJoints(const ros::NodeHandle& node, RobotHandle robot)
    : node_(node), robot_(std::move(robot)) {}

std::set<std::string> DeviceJoints::names() const {
  std::set<std::string> names;
  for (const Joint& joint : joints_) {
    names.insert(joint.name);
  }
  return names;
}

// --- set-up --------------------------------------------------------------------------------------

void DeviceJoints::add(const TransmissionInfo& transmission, const urdf::Model& model) {
  if (transmission.joints_.size() != 1) {
    throw std::invalid_argument("the transmission '" + transmission.name_ +
                                "' must have one joint but has " +
                                std::to_string(transmission.joints_.size()) + ".");
  }
  const auto& info = transmission.joints_.front();
  const urdf::JointConstSharedPtr described = model.getJoint(info.name_);
  if (!described) {
    throw std::invalid_argument("the transmission '" + transmission.name_ + "' names the joint '" +
                                info.name_ + "', which the URDF does not have.");
  }
  if (described->type == urdf::Joint::FIXED) {
    ROS_WARN_NAMED(kDeviceLog, "'%s' does not move: its transmission '%s' is ignored.",
                   info.name_.c_str(), transmission.name_.c_str());
    return;
  }
  const auto known = std::find_if(joints_.begin(), joints_.end(),
                                  [&](const Joint& joint) { return joint.name == info.name_; });
  if (known != joints_.end()) {
    readInterfaces(info, &*known);
    return;
  }
  joints_.emplace_back();
  Joint& joint = joints_.back();
  joint.name = info.name_;
  joint.described = described;
  readInterfaces(info, &joint);
  if (described->mimic) {
    ROS_WARN_NAMED(kDeviceLog,
                   "'%s' follows '%s' (mimic): it shows its state and takes no commands.",
                   joint.name.c_str(), described->mimic->joint_name.c_str());
    joint.takes_effort = joint.takes_position = joint.takes_velocity = false;
    return;
  }
  readGains(&joint);
}

void DeviceJoints::readInterfaces(const transmission_interface::JointInfo& info,
                                  Joint* joint) const {
  static const std::string kPackage = "hardware_interface/";
  for (const std::string& written : info.hardware_interfaces_) {
    const std::string name = written.compare(0, kPackage.size(), kPackage) == 0
                                 ? written.substr(kPackage.size())
                                 : written;
    if (name == "EffortJointInterface") {
      joint->takes_effort = true;
    } else if (name == "PositionJointInterface") {
      joint->takes_position = true;
    } else if (name == "VelocityJointInterface") {
      joint->takes_velocity = true;
    } else if (name != "JointStateInterface") {
      ROS_WARN_NAMED(kDeviceLog,
                     "The hardware interface '%s' of the joint '%s' is unknown: ignored.",
                     written.c_str(), info.name_.c_str());
    }
  }
}

void DeviceJoints::readGains(Joint* joint) const {
  std::string why;
  if (!ros::names::validate(joint->name, why)) {
    return;  // ROS can have no parameters of that name
  }
  const ros::NodeHandle gains(node_, "gazebo_ros_control/pid_gains/" + joint->name);
  if (!ros::param::has(gains.getNamespace())) {
    return;
  }
  joint->pid.emplace();
  if (!joint->pid->init(gains, true)) {
    throw std::invalid_argument(
        "the parameters " + gains.getNamespace() +
        " are not PID gains: p is missing, or one of p, i, d is not a number.");
  }
}

void DeviceJoints::registerHandles(hardware_interface::JointStateInterface& states,
                                   hardware_interface::EffortJointInterface& efforts,
                                   hardware_interface::PositionJointInterface& positions,
                                   hardware_interface::VelocityJointInterface& velocities,
                                   hardware_interface::JointEffortLimitInterface& effort_limits) {
  for (Joint& joint : joints_) {
    franka_sim::JointMeasurement& measured = joint.measured;
    states.registerHandle(hardware_interface::JointStateHandle(
        joint.name, &measured.position, &measured.velocity, &measured.effort));
    const auto state = states.getHandle(joint.name);
    const auto offer = [&](auto* interface, double* command, Method method) {
      interface->registerHandle(JointHandle(state, command));
      registerLimits(joint, state, method);
    };
    if (joint.takes_effort) {
      offer(&efforts, &joint.commands.effort, Method::kEffort);
    }
    if (joint.takes_position) {
      offer(&positions, &joint.commands.position, Method::kPosition);
      effort_limits.registerHandle(
          hardware_interface::JointEffortLimitHandle(joint.name, &joint.max_effort));
    }
    if (joint.takes_velocity) {
      offer(&velocities, &joint.commands.velocity, Method::kVelocity);
    }
  }
  if (joints_.empty()) {
    return;
  }
  robot_.between_ticks([this] {
    for (Joint& joint : joints_) {
      joint.drive = &robot_.world->drive(robot_.name, joint.name);
    }
    worldWasReset();
  });
}

void DeviceJoints::registerLimits(Joint& joint, const hardware_interface::JointStateHandle& state,
                                  Method method) {
  joint_limits_interface::JointLimits limits;
  if (!joint_limits_interface::getJointLimits(joint.described, limits)) {
    return;
  }
  if (method == Method::kEffort && limits.has_effort_limits && limits.has_velocity_limits) {
    effort_limits_.registerHandle({JointHandle(state, &joint.applied.effort), limits});
  } else if (method == Method::kPosition) {
    position_limits_.registerHandle({JointHandle(state, &joint.applied.position), limits});
  } else if (method == Method::kVelocity && limits.has_velocity_limits) {
    velocity_limits_.registerHandle({JointHandle(state, &joint.applied.velocity), limits});
  }
}

// --- every tick ----------------------------------------------------------------------------------

void DeviceJoints::read() noexcept {
  for (Joint& joint : joints_) {
    joint.measured = joint.drive->measure();
  }
}

void DeviceJoints::write(const ros::Duration& period) {
  for (Joint& joint : joints_) {
    joint.applied = joint.commands;
  }
  effort_limits_.enforceLimits(period);
  position_limits_.enforceLimits(period);
  velocity_limits_.enforceLimits(period);
  for (Joint& joint : joints_) {
    write(&joint, period);
  }
}

void DeviceJoints::write(Joint* joint, const ros::Duration& period) {
  switch (joint->method) {
    case Method::kNone:
      return;
    case Method::kEffort:
      joint->drive->applyEffort(joint->applied.effort);
      return;
    case Method::kPosition:
      if (joint->pid) {
        joint->drive->applyEffort(
            limited(*joint, joint->pid->computeCommand(positionError(*joint), period)));
      } else {
        joint->drive->follow(joint->applied.position, limitsOf(*joint, joint->max_effort));
      }
      return;
    case Method::kVelocity:
      if (joint->pid) {
        const double error = joint->applied.velocity - joint->measured.velocity;
        joint->drive->applyEffort(limited(*joint, joint->pid->computeCommand(error, period)));
      } else if (std::isfinite(joint->applied.velocity)) {
        const double lead = std::abs(joint->applied.velocity) * kLeadTime;
        joint->followed =
            std::clamp(joint->followed + joint->applied.velocity * period.toSec(),
                       joint->measured.position - lead, joint->measured.position + lead);
        joint->drive->follow(joint->followed, limitsOf(*joint));
      }
      return;
  }
}

double DeviceJoints::positionError(const Joint& joint) noexcept {
  const double error = joint.applied.position - joint.measured.position;
  return joint.described->type == urdf::Joint::CONTINUOUS ? std::remainder(error, 2.0 * M_PI)
                                                          : error;
}

franka_sim::DriveLimits DeviceJoints::limitsOf(const Joint& joint, double max_effort) noexcept {
  franka_sim::DriveLimits result;
  const auto& limits = joint.described->limits;
  if (limits && limits->effort > 0) {
    result.effort = limits->effort;
  }
  if (limits && limits->velocity > 0) {
    result.velocity = limits->velocity;
  }
  if (max_effort > 0.0) {
    result.effort = std::min(result.effort, max_effort);
  }
  return result;
}

double DeviceJoints::limited(const Joint& joint, double effort) noexcept {
  const double most = limitsOf(joint).effort;
  return std::clamp(effort, -most, most);
}

// --- switching of controllers --------------------------------------------------------------------

void DeviceJoints::doSwitch(
    const std::list<hardware_interface::ControllerInfo>& start_list,
    const std::list<hardware_interface::ControllerInfo>& stop_list) noexcept {
  static constexpr std::pair<Method, const char*> kMethods[] = {
      {Method::kEffort, "hardware_interface::EffortJointInterface"},
      {Method::kPosition, "hardware_interface::PositionJointInterface"},
      {Method::kVelocity, "hardware_interface::VelocityJointInterface"},
  };
  for (Joint& joint : joints_) {
    for (const auto& [method, interface] : kMethods) {
      if (joint.method == method && claims(stop_list, joint.name, interface)) {
        choose(&joint, Method::kNone);
      }
    }
    for (const auto& [method, interface] : kMethods) {
      if (claims(start_list, joint.name, interface)) {
        choose(&joint, method);
      }
    }
  }
}

void DeviceJoints::choose(Joint* joint, Method method) noexcept {
  joint->measured = joint->drive->measure();
  joint->method = method;
  joint->commands = {0.0, joint->measured.position, 0.0};
  joint->followed = joint->measured.position;
  position_limits_.reset();
  if (joint->pid) {
    joint->pid->reset();
  }
  if (method == Method::kNone && (joint->takes_position || joint->takes_velocity)) {
    joint->drive->follow(joint->measured.position, limitsOf(*joint));
  } else if (method == Method::kNone) {
    joint->drive->applyEffort(0.0);
  }
}

void DeviceJoints::worldWasReset() noexcept {
  for (Joint& joint : joints_) {
    choose(&joint, joint.method);
  }
}

}  // namespace franka_sim_mujoco
