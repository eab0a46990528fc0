// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/motion_limits.h>
#include <franka_sim/physics/world.h>
#include <franka_sim/physics/world_joints.h>
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim/simulation/robot_setup.h>
#include <franka_sim/simulation/simulation.h>
#include <unistd.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "fci/robot_server.h"

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
    const franka_core::MotionLimits& limits = robot.units().unit().limits();
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
    setJointPosition(world_, robot.setup().arm_id + "_joint" + std::to_string(i + 1), q[i]);
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

namespace {

/// Without a step for this long, the program does other work (chosen here; clients give a robot up
/// after a second).
constexpr std::chrono::milliseconds kIdle{50};

}  // namespace

/// The network side of a robot that also this process may move.
class SimulationServer::Front final : public fci::SimRobot {
 public:
  Front(SimulatedRobot& robot, const std::string& address)
      : SimRobot(robot.units(),
                 fci::makeServerParameters(address, protocolsOf(robot.setup().robot),
                                           robot.units().unit().configuration().model),
                 toolsOf(robot)),
        robot_(robot),
        address_(address) {
    robot_.setServed(true);
  }
  ~Front() override { robot_.setServed(false); }

  SimulatedRobot& robot() const noexcept { return robot_; }
  const std::string& address() const noexcept { return address_; }

  /// The simulation observes after each step.
  void observe() override {}
  void actuate() override { robot_.actuate(robot_.moving() ? nullptr : takeCommand()); }

 private:
  static ToolPorts toolsOf(SimulatedRobot& robot) {
    ToolPorts tools;
    if (robot.units().hand() != nullptr) {
      tools.hand = franka_core::fci::kGripperPort;
    }
    return tools;
  }

  SimulatedRobot& robot_;
  std::string address_;
};

SimulationServer::SimulationServer(Simulation& simulation, const fci::Pace& pace, Hooks hooks)
    : simulation_(simulation),
      hooks_(std::move(hooks)),
      host_([this] { advance(); }, pace),
      process_(getpid()) {
  if (hooks_.keep_waiting) {
    host_.whileWaiting([this] {
      interrupted_ = !hooks_.keep_waiting();
      return !interrupted_;
    });
  }
}

SimulationServer::~SimulationServer() = default;

const SimulationServer::Front* SimulationServer::front(const SimulatedRobot& robot) const {
  for (const Front& front : fronts_) {
    if (&front.robot() == &robot) {
      return &front;
    }
  }
  return nullptr;
}

void SimulationServer::serve(SimulatedRobot& robot, const std::string& address) {
  checkProcess();
  if (const Front* served = front(robot)) {
    throw std::runtime_error("The robot '" + robot.setup().arm_id + "' is served at " +
                             served->address() + " already.");
  }
  fronts_.emplace_back(robot, address);
  host_.add(fronts_.back());
  if (hooks_.report) {
    const auto report = [this, name = robot.setup().arm_id + " at " + address](
                            const std::string& what) { hooks_.report(name + ": " + what); };
    fronts_.back().onCollision(report);
    fronts_.back().onRefusal(report);
    fronts_.back().onSilence(report);
  }
}

void SimulationServer::step(std::uint64_t ticks) {
  checkProcess();
  if (Clock::now() - stepped_at_ > kIdle) {
    host_.restartClock();
  }
  interrupted_ = false;
  for (std::uint64_t tick = 0; tick < ticks && !interrupted_; tick++) {
    if (simulation_.world().stopped()) {
      for (Front& front : fronts_) {
        front.robot().units().halt();
      }
      throw std::runtime_error(simulation_.world().fault());
    }
    host_.tick();
  }
  stepped_at_ = Clock::now();
}

void SimulationServer::attend() {
  if (process_ != getpid() || Clock::now() - stepped_at_ <= kIdle) {
    return;
  }
  host_.standStill();
  for (Front& front : fronts_) {
    front.robot().refresh();
  }
}

void SimulationServer::advance() {
  for (SimulatedRobot& robot : simulation_.robots()) {
    if (front(robot) == nullptr) {
      robot.actuate();
    }
  }
  simulation_.advance();
}

void SimulationServer::checkProcess() const {
  if (process_ != getpid()) {
    throw std::runtime_error(
        "This simulation was served before the process was forked; its clients are those of the "
        "other process. Make another simulation here.");
  }
}

}  // namespace franka_sim
