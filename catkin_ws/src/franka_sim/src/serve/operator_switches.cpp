// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "serve/operator_switches.h"

#include <cstdint>
#include <optional>
#include <stdexcept>
#include <string>

#include "fci/robot_server.h"

namespace franka_sim {

namespace {

[[noreturn]] void refuseTakenPort(const std::string& what, std::uint16_t port) {
  throw std::runtime_error(what + " stays off, because its port " + std::to_string(port) +
                           " cannot be opened: another program has taken it. End that program.");
}

// Ports open or close before the answer is sent.
void servePorts(fci::SimRobot& robot) {
  robot.serve(true);
  SafetyController& safety = robot.whole().safety();
  if (robot.unit().status().fci_active && !robot.server().isOpen()) {
    safety.deactivateFci();
    refuseTakenPort("The FCI", robot.server().port());
  }
  if (const std::optional<std::uint16_t> port = robot.takenToolPort()) {
    safety.setEndEffectorPower(false);
    refuseTakenPort("The end effector's power", *port);
  }
}

}  // namespace

void requireAllowed(Refusal refusal) {
  if (refusal != Refusal::kNone) {
    throw std::runtime_error(std::string(nameOf(refusal)) + ": " +
                             std::string(sentenceOf(refusal)));
  }
}

void setUserStop(WholeRobot& robot, bool pressed) { robot.safety().pressUserStop(pressed); }

void setGuiding(WholeRobot& robot, bool active) { requireAllowed(robot.safety().guide(active)); }

void setBrakes(WholeRobot& robot, bool closed) {
  if (closed) {
    robot.safety().lock();
  } else {
    requireAllowed(robot.safety().unlock());
  }
}

void setFci(fci::SimRobot& robot, bool active) {
  SafetyController& safety = robot.whole().safety();
  if (active) {
    requireAllowed(safety.activateFci());
  } else {
    safety.deactivateFci();
  }
  servePorts(robot);
}

void setPower(fci::SimRobot& robot, bool on) {
  robot.whole().setPower(on);
  robot.observe();  // a new control unit has no measurement yet
  servePorts(robot);
}

void setEndEffectorPower(fci::SimRobot& robot, bool on) {
  robot.whole().safety().setEndEffectorPower(on);
  servePorts(robot);
}

}  // namespace franka_sim
