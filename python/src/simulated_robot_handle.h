// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka/robot_state.h>
#include <franka_core/to_franka.h>
#include <pybind11/pybind11.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <utility>

#include "shared_simulation.h"

namespace pyfranka {

/// A robot of a simulation, which it keeps alive.
class SimulatedRobotHandle {
 public:
  SimulatedRobotHandle(std::shared_ptr<Shared> shared, franka_sim::SimulatedRobot& robot)
      : shared_(std::move(shared)), robot_(&robot) {}

  /// Changes with each step. @throws std::runtime_error once the simulation is closed, as all
  /// others
  const franka_core::RobotState& liveState() const { return simulated().state(); }
  const franka_sim::SimulatedRobot& simulated() const {
    shared_->requireOpen();
    return *robot_;
  }

  template <typename Function>
  auto use(Function function) {
    return shared_->use([&](franka_sim::Simulation&) { return function(*robot_); });
  }
  /// @throws std::runtime_error if the robot has no hand
  template <typename Function>
  auto useHand(Function function) {
    return use([&](franka_sim::SimulatedRobot& robot) {
      franka_sim::GripperUnit* hand = robot.units().hand();
      if (hand == nullptr) {
        throw std::runtime_error("The robot '" + robot.setup().arm_id + "' has no hand.");
      }
      return function(*hand);
    });
  }
  franka::RobotState state() {
    return use([](const franka_sim::SimulatedRobot& robot) {
      franka::RobotState state;
      franka_core::toFranka(robot.state(), state);
      return state;
    });
  }
  void place(const std::array<double, 7>& q) {
    shared_->use([&](franka_sim::Simulation& simulation) { simulation.place(*robot_, q); });
  }
  void request(const franka_sim::UnitRequest& what, const char* name) {
    use([&](franka_sim::SimulatedRobot& robot) { robot.request(what, name); });
  }

 private:
  std::shared_ptr<Shared> shared_;
  franka_sim::SimulatedRobot* robot_;
};

}  // namespace pyfranka
