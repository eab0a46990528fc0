// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
// FrankaHWSim: the declarations of the URDF, and the handles for them.
#include <franka_sim_mujoco/franka_hw_sim.h>
#include <joint_limits_interface/joint_limits_urdf.h>
#include <ros/console.h>

#include <algorithm>
#include <set>
#include <stdexcept>

#include "service_handlers.h"

namespace franka_sim_mujoco {

namespace {

using transmission_interface::TransmissionInfo;

/// Names with and without the package prefix are both in use.
bool namesInterface(const std::string& found, const std::string& name) {
  return found == name || found == "hardware_interface/" + name;
}

}  // namespace

FrankaHWSim::Joint* FrankaHWSim::findJoint(const std::string& name) {
  const auto joint = std::find_if(joints_.begin(), joints_.end(),
                                  [&](const Joint& candidate) { return candidate.name == name; });
  return joint == joints_.end() || name.empty() ? nullptr : &*joint;
}

void FrankaHWSim::addTransmission(const TransmissionInfo& transmission, const urdf::Model& model) {
  if (transmission.type_ == "transmission_interface/SimpleTransmission") {
    addJoint(transmission, model);
  } else if (transmission.type_ == "franka_hw/FrankaStateInterface") {
    addState(transmission, model);
  } else if (transmission.type_ == "franka_hw/FrankaModelInterface") {
    addModel(transmission, model);
  } else {
    ROS_WARN_NAMED(kHardwareLog,
                   "%s: the transmission '%s' has the type '%s', which is not simulated: ignored.",
                   arm_id_.c_str(), transmission.name_.c_str(), transmission.type_.c_str());
  }
}

void FrankaHWSim::addJoint(const TransmissionInfo& transmission, const urdf::Model& model) {
  if (transmission.joints_.size() != 1) {
    throw std::invalid_argument("the transmission '" + transmission.name_ +
                                "' must have one joint but has " +
                                std::to_string(transmission.joints_.size()) + ".");
  }
  const auto& info = transmission.joints_.front();
  Joint* joint = findJoint(info.name_);
  if (joint == nullptr) {
    devices_->add(transmission, model);
    return;
  }
  joint->has_state = true;
  for (const std::string& interface : info.hardware_interfaces_) {
    if (namesInterface(interface, "EffortJointInterface")) {
      joint->has_effort = true;
    } else if (namesInterface(interface, "PositionJointInterface")) {
      joint->has_position = true;
    } else if (namesInterface(interface, "VelocityJointInterface")) {
      joint->has_velocity = true;
    } else if (!namesInterface(interface, "JointStateInterface")) {
      ROS_WARN_NAMED(kHardwareLog,
                     "%s: the hardware interface '%s' of the joint '%s' is unknown: ignored.",
                     arm_id_.c_str(), interface.c_str(), info.name_.c_str());
    }
  }
}

void FrankaHWSim::addState(const TransmissionInfo& transmission, const urdf::Model& model) {
  std::set<std::string> names;
  for (const auto& joint : transmission.joints_) {
    if (!model.getJoint(joint.name_)) {
      throw std::invalid_argument("the transmission '" + transmission.name_ +
                                  "' names the joint '" + joint.name_ +
                                  "', which the URDF does not have.");
    }
    names.insert(joint.name_);
  }
  if (transmission.joints_.size() != kArmJoints || names.size() != kArmJoints) {
    throw std::invalid_argument(
        "the transmission '" + transmission.name_ +
        "' (franka_hw/FrankaStateInterface) must have the arm's 7 joints but has " +
        std::to_string(transmission.joints_.size()) + ".");
  }
  franka_states_.registerHandle(franka_hw::FrankaStateHandle(arm_id_ + "_robot", arm_->state()));
}

void FrankaHWSim::addModel(const TransmissionInfo& transmission, const urdf::Model& model) {
  const std::string prefix =
      "the transmission '" + transmission.name_ + "' (franka_hw/FrankaModelInterface) ";
  if (transmission.joints_.size() != 2) {
    throw std::invalid_argument(prefix +
                                "must have two joints, with the roles root and tip, but has " +
                                std::to_string(transmission.joints_.size()) + ".");
  }
  const auto jointOfRole = [&](const std::string& role) {
    for (const auto& joint : transmission.joints_) {
      if (joint.role_ == role) {
        const auto found = model.getJoint(joint.name_);
        if (!found) {
          throw std::invalid_argument(prefix + "names the joint '" + joint.name_ +
                                      "', which the URDF does not have.");
        }
        return found;
      }
    }
    throw std::invalid_argument(prefix + "has no joint with the role '" + role + "'.");
  };
  const std::string root = jointOfRole("root")->parent_link_name;
  const std::string tip = jointOfRole("tip")->child_link_name;
  model_ = std::make_unique<franka_hw::ModelKDL>(model, root, tip, singularity_threshold_);
  franka_models_.registerHandle(
      franka_hw::FrankaModelHandle(arm_id_ + "_model", *model_, arm_->state()));
}

void FrankaHWSim::checkComplete() const {
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    if (!joints_[i].has_effort) {
      throw std::invalid_argument(
          "its URDF declares no transmission with an EffortJointInterface for '" + joints_[i].name +
          "'. Was it made with the xacro argument gazebo:=true?");
    }
  }
  if (franka_states_.getNames().size() != 1 || !model_) {
    throw std::invalid_argument(
        "its URDF must declare one transmission of the type franka_hw/FrankaStateInterface and one "
        "of the "
        "type franka_hw/FrankaModelInterface. Was it made with the xacro argument gazebo:=true?");
  }
}

void FrankaHWSim::registerAll() {
  for (std::size_t i = 0; i < joints_.size(); ++i) {
    Joint& joint = joints_[i];
    if (!joint.has_state) {
      continue;
    }
    joint_states_.registerHandle(hardware_interface::JointStateHandle(
        joint.name, &joint.position, &joint.velocity, &joint.effort));
    if (i < kArmJoints) {
      command_effects_.registerHandle(hardware_interface::CommandEffectHandle(
          joint.name, [this] { return reasonWithoutEffect(); }));
      registerArmJoint(i);
    } else if (joint.has_effort) {
      efforts_.registerHandle(
          hardware_interface::JointHandle(joint_states_.getHandle(joint.name), &joint.command));
    }
  }
  registerCartesian();
  devices_->registerHandles(joint_states_, efforts_, positions_, velocities_, effort_limits_);
  registerInterface(&joint_states_);
  registerInterface(&efforts_);
  registerInterface(&positions_);
  registerInterface(&velocities_);
  registerInterface(&effort_limits_);
  registerInterface(&command_effects_);
  registerInterface(&franka_states_);
  registerInterface(&franka_models_);
  registerInterface(&poses_);
  registerInterface(&twists_);
}

void FrankaHWSim::registerArmJoint(std::size_t joint) {
  const Joint& names = joints_[joint];
  ArmCommands& commands = arm_->commands();
  franka::RobotState& state = arm_->state();
  const hardware_interface::JointStateHandle measured = joint_states_.getHandle(names.name);
  const hardware_interface::JointStateHandle desired(names.name, &state.q_d[joint],
                                                     &state.dq_d[joint], &state.tau_J[joint]);
  if (names.has_effort) {
    efforts_.registerHandle(hardware_interface::JointHandle(measured, &commands.torque[joint]));
  }
  if (names.has_position) {
    positions_.registerHandle(hardware_interface::JointHandle(desired, &commands.position[joint]));
  }
  if (names.has_velocity) {
    velocities_.registerHandle(hardware_interface::JointHandle(desired, &commands.velocity[joint]));
  }
}

void FrankaHWSim::registerCartesian() {
  ArmCommands& commands = arm_->commands();
  const franka_hw::FrankaStateHandle state = franka_states_.getHandle(arm_id_ + "_robot");
  poses_.registerHandle(
      franka_hw::FrankaCartesianPoseHandle(state, commands.pose, commands.pose_elbow));
  twists_.registerHandle(
      franka_hw::FrankaCartesianVelocityHandle(state, commands.twist, commands.twist_elbow));
}

void FrankaHWSim::registerLimits(const urdf::Model& model) {
  for (std::size_t i = 0; i < kArmJoints; ++i) {
    const Joint& joint = joints_[i];
    const urdf::JointConstSharedPtr described = model.getJoint(joint.name);
    joint_limits_interface::JointLimits limits;
    joint_limits_interface::SoftJointLimits soft_limits;
    if (!described->limits || !described->safety ||
        !joint_limits_interface::getJointLimits(described, limits) ||
        !joint_limits_interface::getSoftJointLimits(described, soft_limits)) {
      ROS_WARN_NAMED(
          kHardwareLog,
          "%s: the joint '%s' has no <limit> or no <safety_controller> in the URDF: only "
          "the robot itself limits its motion.",
          arm_id_.c_str(), joint.name.c_str());
      continue;
    }
    // They limit each tick's commands, not those of the controllers, which hold for a period.
    franka::RobotState& state = arm_->state();
    ArmCommands& applied = arm_->applied();
    const hardware_interface::JointStateHandle desired(joint.name, &state.q_d[i], &state.dq_d[i],
                                                       &state.tau_J[i]);
    if (joint.has_position) {
      position_limits_.registerHandle(joint_limits_interface::PositionJointSoftLimitsHandle(
          hardware_interface::JointHandle(desired, &applied.position[i]), limits, soft_limits));
    }
    if (joint.has_velocity) {
      velocity_limits_.registerHandle(joint_limits_interface::VelocityJointSoftLimitsHandle(
          hardware_interface::JointHandle(desired, &applied.velocity[i]), limits, soft_limits));
    }
  }
}

void FrankaHWSim::holdJointLimits(const ros::Duration& period) {
  if (arm_->waits()) {
    // No controller commands yet: the limits must not start from the positions of the last motion.
    position_limits_.reset();
    return;
  }
  if ((arm_->mode() & franka_hw::ControlMode::JointPosition) != franka_hw::ControlMode::None) {
    position_limits_.enforceLimits(period);
  }
  if ((arm_->mode() & franka_hw::ControlMode::JointVelocity) != franka_hw::ControlMode::None) {
    velocity_limits_.enforceLimits(period);
  }
}

}  // namespace franka_sim_mujoco
