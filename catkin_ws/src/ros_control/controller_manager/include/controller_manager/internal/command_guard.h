// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/controller_info.h>
#include <hardware_interface/joint_command_interface.h>
#include <hardware_interface/robot_hw.h>

#include <string>
#include <vector>

namespace controller_manager {
namespace internal {

/// Watches what a controller commands to the joints it claimed through the effort, velocity and
/// position interfaces. Interfaces of other kinds are their robot's to check. Real-time safe but
/// for the constructor.
class CommandGuard {
 public:
  CommandGuard(const hardware_interface::ControllerInfo& info, hardware_interface::RobotHW& robot);

  /// The name of a joint whose command is not a finite number; nullptr if there is none.
  const char* offender() const;
  /// Remembers the present commands as good ones.
  void remember();
  /// Gives the robot back the commands remembered last.
  void restore();

 private:
  struct Command {
    hardware_interface::JointHandle handle;
    std::string joint;
    double good;
  };
  template <class Interface>
  void collect(const hardware_interface::InterfaceResources& claimed, const char* interface,
               hardware_interface::RobotHW& robot);

  std::vector<Command> commands_;
};

}  // namespace internal
}  // namespace controller_manager
