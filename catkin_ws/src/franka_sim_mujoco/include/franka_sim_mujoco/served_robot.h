// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/sim_robot.h>
#include <franka_sim_mujoco/robot_hw_sim.h>
#include <franka_sim_mujoco/service_handlers.h>

#include <functional>

namespace franka_sim_mujoco {

struct RobotPlan;

/// A robot of the ROS world that is served over the FCI at an address of its own, as franka_sim
/// does, instead of being driven by controllers in the simulation's process. What the user does to
/// it is commanded by services under `franka_sim` in its namespace (docs/franka_sim.md): the lines
/// of the program's control interface that concern one robot.
///
/// Made by the stepping thread between ticks, which also runs `robot`; destroyed by any thread when
/// the host no longer knows it.
class ServedRobot {
 public:
  /// @param plan of a robot that stands in the world
  /// @throws std::runtime_error, std::invalid_argument with a sentence
  ServedRobot(const RobotPlan& plan, const RobotHandle& robot);

  franka_sim::fci::SimRobot& robot() noexcept { return robot_; }
  /// A motion of a client's runs.
  bool isCommanded() const { return robot_.expectsCommand(); }

 private:
  template <typename Service>
  void offer(const std::string& name,
             std::function<void(typename Service::Request&, typename Service::Response&)> handler);
  void offerSwitch(const std::string& name, void (franka_sim::ControlUnit::*turn)(bool));
  void offerSwitches();
  void offerLink();
  void offerStates();

  BetweenTicks between_ticks_;
  franka_sim::fci::SimRobot robot_;
  ServiceHandlers services_;  ///< last: it ends before what it serves
};

}  // namespace franka_sim_mujoco
