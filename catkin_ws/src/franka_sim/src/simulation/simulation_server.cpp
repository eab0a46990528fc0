// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim/serve/sim_robot.h>
#include <franka_sim/simulation/simulation_server.h>
#include <unistd.h>

#include <stdexcept>
#include <utility>

namespace franka_sim {

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
