// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/simulation/hand_commands.h>

#include <optional>
#include <stdexcept>
#include <string>

namespace franka_sim {
namespace {

using fci::LineServer;
using fci::Reply;
using fci::toNumber;
using Words = LineServer::Words;

constexpr double kGraspTolerance = 0.005;  // [m] either way, the default of libfranka's grasp

std::string metres(double width) { return franka_core::fixedText(width, 4) + " m"; }

GripperUnit& handOf(WholeRobot& robot) {
  if (robot.hand() == nullptr) {
    throw std::runtime_error("NoHand: This robot has no Franka hand.");
  }
  const SafetyState& state = robot.safety().state();
  if (!state.power || !state.end_effector_power) {
    throw std::runtime_error("NotReady: The hand is switched off.");
  }
  return *robot.hand();
}

void requireHomed(const GripperUnit& hand) {
  if (!hand.isHomed()) {
    throw std::runtime_error(
        "NotHomed: The hand has not been homed since the robot was switched on. Home it first.");
  }
}

// Answers when the command has ended. @param failure what has happened if it failed
Reply outcomeOf(const GripperUnit& hand, GripperUnit::Ticket ticket, const std::string& failure) {
  if (ticket == 0) {
    throw std::invalid_argument("The hand refuses this: widths lie between 0 and " +
                                metres(hand.maxWidth()) + ", speeds and forces from 0 on.");
  }
  return Reply([&hand, ticket, failure]() -> std::optional<std::string> {
    switch (hand.outcome(ticket)) {
      case GripperOutcome::kRunning:
        return {};
      case GripperOutcome::kSucceeded:
        return "";
      case GripperOutcome::kInterrupted:
        throw std::runtime_error("Another command or a reset has ended this one.");
      default:
        throw std::runtime_error(failure + " The width is " + metres(hand.width()) + ".");
    }
  });
}

Reply execute(GripperUnit& hand, const Words& words) {
  const std::string& command = words.at(0);
  if (command == "homing") {
    return outcomeOf(hand, hand.homing(), "The homing has failed: something blocks the fingers.");
  }
  if (command == "stop") {
    return outcomeOf(hand, hand.stop(), "");
  }
  if (command == "move") {
    const double width = toNumber(words.at(1));
    const double speed = toNumber(words.at(2));
    requireHomed(hand);
    return outcomeOf(hand, hand.move(width, speed), "The fingers have not arrived.");
  }
  if (command == "grasp") {
    const double width = toNumber(words.at(1));
    const double speed = toNumber(words.at(2));
    const double force = toNumber(words.at(3));
    requireHomed(hand);
    return outcomeOf(hand, hand.grasp(width, kGraspTolerance, kGraspTolerance, speed, force),
                     "Nothing of that width has been grasped.");
  }
  throw std::invalid_argument("'" + command + "' must be one of homing, stop, move and grasp.");
}

}  // namespace

void addHandCommands(LineServer& lines, WholeRobot& robot) {
  lines.add("hand homing|stop|move WIDTH SPEED|grasp WIDTH SPEED FORCE",
            [&robot](const Words& words) { return execute(handOf(robot), words); });
}

}  // namespace franka_sim
