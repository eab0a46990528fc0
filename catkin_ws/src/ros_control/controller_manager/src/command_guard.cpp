// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/command_guard.h>
#include <hardware_interface/internal/demangle_symbol.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/position_velocity_torque_gains_command_interface.h>
#include <hardware_interface/posvel_command_interface.h>
#include <hardware_interface/posvelacc_command_interface.h>

#include <cmath>
#include <limits>

namespace controller_manager {
namespace internal {

namespace hw = hardware_interface;

CommandGuard::CommandGuard(const hw::ControllerInfo& info, hw::RobotHW& robot) {
  const auto scalar = [this](const hw::JointHandle& joint) {
    add(joint, &hw::JointHandle::getCommand, &hw::JointHandle::setCommand);
  };
  for (const hw::InterfaceResources& claimed : info.claimed_resources) {
    collect<hw::EffortJointInterface>(claimed, robot, scalar);
    collect<hw::VelocityJointInterface>(claimed, robot, scalar);
    collect<hw::PositionJointInterface>(claimed, robot, [this](const hw::JointHandle& joint) {
      addPosition(joint, &hw::JointHandle::getCommand, &hw::JointHandle::setCommand);
    });
    collect<hw::PosVelJointInterface>(claimed, robot,
                                      [this](const auto& joint) { addPositionAndVelocity(joint); });
    collect<hw::PosVelAccJointInterface>(claimed, robot, [this](const auto& joint) {
      typedef hw::PosVelAccJointHandle Handle;
      addPositionAndVelocity(joint);
      add(joint, &Handle::getCommandAcceleration, &Handle::setCommandAcceleration);
    });
    collect<hw::PositionVelocityTorqueGainsJointInterface>(
        claimed, robot, [this](const auto& joint) {
          typedef hw::PositionVelocityTorqueGainsJointHandle Handle;
          addPositionAndVelocity(joint);
          add(joint, &Handle::getCommandEffort, &Handle::setCommandEffort);
          add(joint, &Handle::getCommandKp, &Handle::setCommandKp);
          add(joint, &Handle::getCommandKd, &Handle::setCommandKd);
        });
  }
}

template <class Interface, class Watch>
void CommandGuard::collect(const hw::InterfaceResources& claimed, hw::RobotHW& robot, Watch watch) {
  const bool meant = claimed.hardware_interface == hw::internal::demangledTypeName<Interface>();
  Interface* const joints = meant ? robot.get<Interface>() : nullptr;
  if (joints == nullptr) {
    return;
  }
  for (const std::string& joint : claimed.resources) {
    watch(joints->getHandle(joint));
  }
  // getHandle() claimed the joints, but reading them must not claim.
  joints->clearClaims();
}

template <class Handle, class Get, class Set>
void CommandGuard::add(const Handle& handle, Get get, Set set) {
  commands_.push_back(
      {handle.getName(), [=] { return (handle.*get)(); },
       [target = Handle(handle), set](double value) mutable { (target.*set)(value); },
       [] { return 0.0; }, std::numeric_limits<double>::quiet_NaN()});
}

template <class Handle, class Get, class Set>
void CommandGuard::addPosition(const Handle& handle, Get get, Set set) {
  add(handle, get, set);
  commands_.back().rest = [=] { return handle.getPosition(); };
}

template <class Handle>
void CommandGuard::addPositionAndVelocity(const Handle& handle) {
  addPosition(handle, &Handle::getCommandPosition, &Handle::setCommandPosition);
  add(handle, &Handle::getCommandVelocity, &Handle::setCommandVelocity);
}

const char* CommandGuard::offender() const {
  for (const Command& command : commands_) {
    if (!std::isfinite(command.get())) {
      return command.joint.c_str();
    }
  }
  return nullptr;
}

void CommandGuard::remember() {
  for (Command& command : commands_) {
    command.good = command.get();
  }
}

void CommandGuard::restore() {
  for (Command& command : commands_) {
    command.set(std::isfinite(command.good) ? command.good : command.rest());
  }
}

}  // namespace internal
}  // namespace controller_manager
