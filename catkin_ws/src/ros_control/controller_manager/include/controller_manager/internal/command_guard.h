// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <hardware_interface/controller_info.h>
#include <hardware_interface/robot_hw.h>

#include <functional>
#include <string>
#include <vector>

namespace controller_manager {
namespace internal {

/// Checks a controller's commands to its claimed joints through the joint command interfaces of
/// hardware_interface: effort, velocity, position, position and velocity (with acceleration, or
/// with torque and gains). Interfaces of other kinds must be checked by their robot. Called by one
/// thread. Real-time safe. Exception: the constructor.
class CommandGuard {
 public:
  CommandGuard(const hardware_interface::ControllerInfo& info, hardware_interface::RobotHW& robot);

  /// The name of a joint whose command is not a finite number; nullptr if there is none.
  const char* offender() const;
  /// Stores the present commands.
  void remember();
  /// Restores the commands stored last. Values that were NaN become those of rest: the measured
  /// position, zero for all others.
  void restore();

 private:
  /// One number of a joint's command.
  struct Command {
    std::string joint;
    std::function<double()> get;
    std::function<void(double)> set;
    std::function<double()> rest;
    double good;
  };
  template <class Interface, class Watch>
  void collect(const hardware_interface::InterfaceResources& claimed,
               hardware_interface::RobotHW& robot, Watch watch);
  template <class Handle, class Get, class Set>
  void add(const Handle& handle, Get get, Set set);
  template <class Handle, class Get, class Set>
  void addPosition(const Handle& handle, Get get, Set set);
  template <class Handle>
  void addPositionAndVelocity(const Handle& handle);

  std::vector<Command> commands_;
};

}  // namespace internal
}  // namespace controller_manager
