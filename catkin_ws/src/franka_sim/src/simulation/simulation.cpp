// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/simulation/files.h>
#include <franka_sim/simulation/simulation.h>

#include <algorithm>
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

struct SimulationSnapshot::Content {
  Snapshot world;
  std::uint64_t generation;  ///< of the world
  std::vector<SimulatedRobot> robots;
};

SimulationSnapshot Simulation::snapshot() const {
  SimulationSnapshot snapshot;
  snapshot.content_ =
      std::make_shared<const SimulationSnapshot::Content>(SimulationSnapshot::Content{
          world_.snapshot(), world_.generation(), {robots_.begin(), robots_.end()}});
  return snapshot;
}

void Simulation::restore(const SimulationSnapshot& snapshot) {
  const SimulationSnapshot::Content* content = snapshot.content_.get();
  const bool alike = content != nullptr && content->robots.size() == robots_.size() &&
                     std::equal(robots_.begin(), robots_.end(), content->robots.begin(),
                                [](const SimulatedRobot& robot, const SimulatedRobot& then) {
                                  return robot.hasSameSetup(then);
                                });
  if (!alike) {
    throw std::runtime_error(
        "The snapshot cannot be restored: it is of a simulation with other robots or another "
        "realism. Take another one.");
  }
  world_.restore(content->world);
  auto then = content->robots.begin();
  for (SimulatedRobot& robot : robots_) {
    robot.restore(*then++, content->generation == world_.generation());
  }
}

void Simulation::checkPositions(const SimulatedRobot& robot, const std::array<double, 7>& q) {
  for (std::size_t i = 0; i < q.size(); i++) {
    const MotionLimits& limits = robot.units().unit().limits();
    const franka_core::JointRange range = limits.reach(i);
    if (!(q[i] >= range.lowest && q[i] <= range.highest)) {
      throw std::invalid_argument("Joint " + std::to_string(i + 1) + " of '" +
                                  robot.setup().arm_id + "' can be " + limits.reachText(i, q[i]) +
                                  ".");
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
