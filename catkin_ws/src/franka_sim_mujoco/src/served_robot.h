// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/serve/command_table.h>
#include <franka_sim/serve/host.h>
#include <franka_sim/serve/line_server.h>
#include <franka_sim/serve/scene_text.h>
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim_mujoco/robot_hw_sim.h>

#include <functional>
#include <memory>

#include "service_handlers.h"

namespace franka_sim_mujoco {

struct RobotPlan;

/// The part of the simulation that the control interface of a served robot uses; outlives the
/// robot.
struct OperatorAccess {
  franka_sim::fci::Host& host;
  franka_sim::SceneText& scene;
  std::function<void()> reset;  ///< @throws std::exception with a sentence
  std::function<void()> quit;
};

/// A robot of the ROS world that is served over the FCI at its own address, as in franka_sim,
/// instead of being commanded by controllers in the simulation's process. Its control interface and
/// services under `franka_sim` in its namespace replace the operator (docs/franka_sim.md).
///
/// Created and destroyed by any thread; in between the stepping thread runs `robot`, and adds it to
/// the host and removes it.
class ServedRobot {
 public:
  /// @param plan of a robot that is in the world between ticks
  /// @throws std::runtime_error, std::invalid_argument with a message for the user
  ServedRobot(const RobotPlan& plan, const RobotHandle& robot, const OperatorAccess& access);

  franka_sim::fci::SimRobot& robot() noexcept { return robot_; }
  /// Lets the host run the robot and its control interface.
  void addTo(franka_sim::fci::Host& host);
  /// Ends both; lines that wait get no answer.
  void removeFrom(franka_sim::fci::Host& host) noexcept;
  /// Whether a motion of a client runs.
  bool isCommanded() const { return robot_.expectsCommand(); }

 private:
  template <typename Service>
  void offer(const std::string& name,
             std::function<void(typename Service::Request&, typename Service::Response&)> handler);
  void offerSwitch(const std::string& name, const std::string& line_on,
                   const std::string& line_off);
  void execute(const std::string& line) const;
  void openControlInterface(const RobotPlan& plan);
  void offerSwitches();
  void offerLink();
  void offerStates();

  BetweenTicks between_ticks_;
  franka_sim::fci::SimRobot robot_;
  franka_sim::fci::CommandTable commands_;              ///< of the operator
  std::unique_ptr<franka_sim::fci::LineServer> lines_;  ///< null without a control interface
  ServiceHandlers services_;  ///< last: it ends before the objects it uses
};

}  // namespace franka_sim_mujoco
