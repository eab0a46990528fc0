// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <controller_manager/internal/command_guard.h>

#include <cmath>

namespace controller_manager {
namespace internal {

CommandGuard::CommandGuard(const hardware_interface::ControllerInfo& info,
                           hardware_interface::RobotHW& robot) {
  for (const hardware_interface::InterfaceResources& claimed : info.claimed_resources) {
    collect<hardware_interface::EffortJointInterface>(
        claimed, "hardware_interface::EffortJointInterface", robot);
    collect<hardware_interface::VelocityJointInterface>(
        claimed, "hardware_interface::VelocityJointInterface", robot);
    collect<hardware_interface::PositionJointInterface>(
        claimed, "hardware_interface::PositionJointInterface", robot);
  }
}

template <class Interface>
void CommandGuard::collect(const hardware_interface::InterfaceResources& claimed,
                           const char* interface, hardware_interface::RobotHW& robot) {
  Interface* const joints =
      claimed.hardware_interface == interface ? robot.get<Interface>() : nullptr;
  if (joints == nullptr) {
    return;
  }
  for (const std::string& joint : claimed.resources) {
    const hardware_interface::JointHandle handle = joints->getHandle(joint);
    commands_.push_back({handle, joint, handle.getCommand()});
  }
  // Looking is no claim.
  joints->clearClaims();
}

const char* CommandGuard::offender() const {
  for (const Command& command : commands_) {
    if (!std::isfinite(command.handle.getCommand())) {
      return command.joint.c_str();
    }
  }
  return nullptr;
}

void CommandGuard::remember() {
  for (Command& command : commands_) {
    command.good = command.handle.getCommand();
  }
}

void CommandGuard::restore() {
  for (Command& command : commands_) {
    command.handle.setCommand(std::isfinite(command.good) ? command.good : 0.0);
  }
}

}  // namespace internal
}  // namespace controller_manager
