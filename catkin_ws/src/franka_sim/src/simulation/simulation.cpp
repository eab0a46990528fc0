// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/simulation/files.h>
#include <franka_sim/simulation/simulation.h>

#include <stdexcept>

namespace franka_sim {

Simulation::Simulation(const std::string& world, const std::vector<Robot>& robots)
    : world_(worldFile(world), resolveUri) {
  for (const Robot& robot : robots) {
    robots_.emplace_back(robot.setup, robot.hand, world_);
  }
  for (SimulatedRobot& robot : robots_) {
    robot.observe();
  }
}

void Simulation::step(std::uint64_t ticks) {
  for (std::uint64_t tick = 0; tick < ticks; tick++) {
    if (world_.stopped()) {
      throw std::runtime_error(world_.fault());
    }
    for (SimulatedRobot& robot : robots_) {
      robot.actuate();
    }
    advance();
  }
}

void Simulation::advance() noexcept {
  world_.step();
  for (SimulatedRobot& robot : robots_) {
    robot.observe();
  }
}

void Simulation::reset() {
  world_.reset();
  restartRobots();
}

void Simulation::restore(const Snapshot& snapshot) {
  world_.restore(snapshot);
  restartRobots();
}

void Simulation::checkPositions(const SimulatedRobot& robot, const std::array<double, 7>& q) {
  for (std::size_t i = 0; i < q.size(); i++) {
    const franka_core::JointRange range = robot.units().unit().limits().reach(i);
    if (!(q[i] >= range.lowest && q[i] <= range.highest)) {
      throw std::invalid_argument(
          "Joint " + std::to_string(i + 1) + " of '" + robot.setup().arm_id + "' can be between " +
          std::to_string(range.lowest) + " and " + std::to_string(range.highest) + " rad, not at " +
          std::to_string(q[i]) + ".");
    }
  }
}

void Simulation::place(SimulatedRobot& robot, const std::array<double, 7>& q) {
  checkPositions(robot, q);
  for (std::size_t i = 0; i < q.size(); i++) {
    world_.setJointPosition(robot.setup().arm_id + "_joint" + std::to_string(i + 1), q[i]);
  }
  robot.restart();
  robot.observe();
}

SimulatedRobot& Simulation::robot(const std::string& name) {
  std::string names;
  for (SimulatedRobot& robot : robots_) {
    if (robot.setup().arm_id == name) {
      return robot;
    }
    names += (names.empty() ? "" : ", ") + robot.setup().arm_id;
  }
  throw std::out_of_range("There is no robot '" + name + "'; there are: " + names + ".");
}

void Simulation::restartRobots() {
  for (SimulatedRobot& robot : robots_) {
    robot.restart();
    robot.observe();
  }
}

}  // namespace franka_sim
