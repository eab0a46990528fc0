// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/sim_robot.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <franka_sim_mujoco/service_handlers.h>

#include <functional>

namespace franka_sim_mujoco {

struct RobotPlan;

/// A robot of the ROS world that is served over the FCI at its own address, as in franka_sim,
/// instead of being commanded by controllers in the simulation's process. Services under
/// `franka_sim` in its namespace replace the operator (docs/franka_sim.md): the commands of the
/// program's control interface for one robot.
///
/// Created by the stepping thread between ticks, which also runs `robot`; destroyed by any thread
/// after the host has removed it.
class ServedRobot {
 public:
  /// @param plan of a robot that is in the world
  /// @throws std::runtime_error, std::invalid_argument with a message for the user
  ServedRobot(const RobotPlan& plan, const RobotHandle& robot);

  franka_sim::fci::SimRobot& robot() noexcept { return robot_; }
  /// Whether a motion of a client runs.
  bool isCommanded() const { return robot_.expectsCommand(); }

 private:
  template <typename Service>
  void offer(const std::string& name,
             std::function<void(typename Service::Request&, typename Service::Response&)> handler);
  template <typename Switch>
  void offerSwitch(const std::string& name);
  void offerSwitches();
  void offerLink();
  void offerStates();

  BetweenTicks between_ticks_;
  franka_sim::fci::SimRobot robot_;
  ServiceHandlers services_;  ///< last: it ends before the objects it uses
};

}  // namespace franka_sim_mujoco
