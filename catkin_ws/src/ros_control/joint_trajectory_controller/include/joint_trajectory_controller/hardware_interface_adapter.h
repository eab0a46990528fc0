// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <control_toolbox/pid.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>
#include <ros/console.h>
#include <ros/node_handle.h>
#include <ros/time.h>

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

/// Converts desired states into commands of a hardware interface. Controllers specialize it for
/// their own interfaces; implemented for position, velocity, effort, posvel and posvelacc.
///
/// init() runs outside the control loop, all others in it: no allocation, no lock.
/// @tparam State of all joints: vectors position, velocity and acceleration
template <class HardwareInterface, class State>
class HardwareInterfaceAdapter {
 public:
  bool init(std::vector<typename HardwareInterface::ResourceHandleType>& /*joint_handles*/,
            ros::NodeHandle& /*controller_nh*/) {
    return false;
  }
  void starting(const ros::Time& /*time*/) {}
  void stopping(const ros::Time& /*time*/) {}
  void updateCommand(const ros::Time& /*time*/, const ros::Duration& /*period*/,
                     const State& /*desired_state*/, const State& /*state_error*/) {}
};

/// Velocity or effort = velocity_ff * desired velocity + PID of the position error.
///
/// Parameters: `gains/<joint>` as for control_toolbox::Pid::init() (required),
/// `velocity_ff/<joint>` (0).
template <class State, class JointHandle>
class ClosedLoopHardwareInterfaceAdapter {
 public:
  bool init(std::vector<JointHandle>& joint_handles, ros::NodeHandle& controller_nh) {
    joint_handles_ = &joint_handles;
    pids_.clear();
    velocity_ff_.clear();
    for (JointHandle& joint : joint_handles) {
      const ros::NodeHandle gains_nh(controller_nh, "gains/" + joint.getName());
      auto pid = std::make_unique<control_toolbox::Pid>();
      if (!pid->init(gains_nh)) {
        ROS_ERROR_STREAM("The controller has no usable PID gains for joint '"
                         << joint.getName() << "'. Set the parameters p, i, d and i_clamp in "
                         << gains_nh.getNamespace() << ".");
        return false;
      }
      double velocity_ff = 0.0;
      controller_nh.param("velocity_ff/" + joint.getName(), velocity_ff, velocity_ff);
      pids_.push_back(std::move(pid));
      velocity_ff_.push_back(velocity_ff);
    }
    return true;
  }

  void starting(const ros::Time& /*time*/) {
    for (std::size_t i = 0; i < pids_.size(); ++i) {
      pids_[i]->reset();
      (*joint_handles_)[i].setCommand(0.0);
    }
  }

  void stopping(const ros::Time& /*time*/) {}

  void updateCommand(const ros::Time& /*time*/, const ros::Duration& period,
                     const State& desired_state, const State& state_error) {
    for (std::size_t i = 0; i < pids_.size(); ++i) {
      (*joint_handles_)[i].setCommand(
          desired_state.velocity[i] * velocity_ff_[i] +
          pids_[i]->computeCommand(state_error.position[i], state_error.velocity[i], period));
    }
  }

 private:
  std::vector<std::unique_ptr<control_toolbox::Pid>> pids_;
  std::vector<double> velocity_ff_;
  std::vector<JointHandle>* joint_handles_{nullptr};
};

template <class State>
class HardwareInterfaceAdapter<hardware_interface::VelocityJointInterface, State>
    : public ClosedLoopHardwareInterfaceAdapter<State, hardware_interface::JointHandle> {};

template <class State>
class HardwareInterfaceAdapter<hardware_interface::EffortJointInterface, State>
    : public ClosedLoopHardwareInterfaceAdapter<State, hardware_interface::JointHandle> {};

/// Forwards desired states; at the start the measured ones.
/// @tparam Derived has `static void command(JointHandle&, position, velocity, acceleration)`
template <class Derived, class State, class JointHandle>
class ForwardingHardwareInterfaceAdapter {
 public:
  bool init(std::vector<JointHandle>& joint_handles, ros::NodeHandle& /*controller_nh*/) {
    joint_handles_ = &joint_handles;
    return true;
  }

  void starting(const ros::Time& /*time*/) {
    if (joint_handles_ != nullptr) {
      for (JointHandle& joint : *joint_handles_) {
        Derived::command(joint, joint.getPosition(), 0.0, 0.0);
      }
    }
  }

  void stopping(const ros::Time& /*time*/) {}

  void updateCommand(const ros::Time& /*time*/, const ros::Duration& /*period*/,
                     const State& desired_state, const State& /*state_error*/) {
    for (std::size_t i = 0; i < joint_handles_->size(); ++i) {
      Derived::command((*joint_handles_)[i], desired_state.position[i], desired_state.velocity[i],
                       desired_state.acceleration[i]);
    }
  }

 private:
  std::vector<JointHandle>* joint_handles_{nullptr};
};

template <class State>
class HardwareInterfaceAdapter<hardware_interface::PositionJointInterface, State>
    : public ForwardingHardwareInterfaceAdapter<
          HardwareInterfaceAdapter<hardware_interface::PositionJointInterface, State>, State,
          hardware_interface::JointHandle> {
 public:
  static void command(hardware_interface::JointHandle& joint, double position, double /*velocity*/,
                      double /*acceleration*/) {
    joint.setCommand(position);
  }
};

template <class State>
class HardwareInterfaceAdapter<hardware_interface::PosVelJointInterface, State>
    : public ForwardingHardwareInterfaceAdapter<
          HardwareInterfaceAdapter<hardware_interface::PosVelJointInterface, State>, State,
          hardware_interface::PosVelJointHandle> {
 public:
  static void command(hardware_interface::PosVelJointHandle& joint, double position,
                      double velocity, double /*acceleration*/) {
    joint.setCommand(position, velocity);
  }
};

template <class State>
class HardwareInterfaceAdapter<hardware_interface::PosVelAccJointInterface, State>
    : public ForwardingHardwareInterfaceAdapter<
          HardwareInterfaceAdapter<hardware_interface::PosVelAccJointInterface, State>, State,
          hardware_interface::PosVelAccJointHandle> {
 public:
  static void command(hardware_interface::PosVelAccJointHandle& joint, double position,
                      double velocity, double acceleration) {
    joint.setCommand(position, velocity, acceleration);
  }
};
