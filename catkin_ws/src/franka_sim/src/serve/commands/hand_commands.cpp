// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/robot/hands/gripper_unit.h>

#include <optional>
#include <stdexcept>
#include <string>

#include "serve/commands/command_groups.h"

namespace franka_sim {

namespace {

using namespace fci;  // NOLINT: the words of the table

constexpr double kGraspTolerance = 0.005;  // [m] either way, the default of libfranka's grasp

std::string meters(double width) { return franka_core::fixedText(width, 4) + " m"; }

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

GripperUnit& homedHandOf(WholeRobot& robot) {
  GripperUnit& hand = handOf(robot);
  if (!hand.isHomed()) {
    throw std::runtime_error(
        "NotHomed: The hand has not been homed since the robot was switched on. Home it first.");
  }
  return hand;
}

// Answers when the command has ended. @param failure what has happened if it failed
Reply outcomeOf(const GripperUnit& hand, GripperUnit::Ticket ticket, const std::string& failure) {
  if (ticket == 0) {
    throw std::invalid_argument("The hand refuses this: widths lie between 0 and " +
                                meters(hand.maxWidth()) + ", speeds and forces from 0 on.");
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
        throw std::runtime_error(failure + " The width is " + meters(hand.width()) + ".");
    }
  });
}

}  // namespace

void addHandCommands(fci::CommandTable& table, const OperatorContext& context) {
  WholeRobot& robot = context.robot.whole();
  table.add(line("hand homing"),
            "closes and opens the Franka hand fully. Lines of the hand are answered when they have "
            "ended: with an error if they failed or another command came first",
            kControl, [&] {
              GripperUnit& hand = handOf(robot);
              return outcomeOf(hand, hand.homing(),
                               "The homing has failed: something blocks the fingers.");
            });
  table.add(line("hand stop"), "ends the hand's command and releases its force", kUrgentInput, [&] {
    GripperUnit& hand = handOf(robot);
    return outcomeOf(hand, hand.stop(), "");
  });
  table.add(line("hand move", number("WIDTH", "m"), number("SPEED", "m/s")),
            "moves the fingers to a width", kControl, [&](double width, double speed) {
              GripperUnit& hand = homedHandOf(robot);
              return outcomeOf(hand, hand.move(width, speed), "The fingers have not arrived.");
            });
  table.add(line("hand grasp", number("WIDTH", "m"), number("SPEED", "m/s"), number("FORCE", "N")),
            "grasps an object; succeeds within 5 mm of the width", kControl,
            [&](double width, double speed, double force) {
              GripperUnit& hand = homedHandOf(robot);
              return outcomeOf(hand,
                               hand.grasp(width, kGraspTolerance, kGraspTolerance, speed, force),
                               "Nothing of that width has been grasped.");
            });
}

void addVacuumCommands(fci::CommandTable& table, const OperatorContext& context) {
  VacuumGripperUnit* const unit = context.robot.vacuum();
  if (unit == nullptr) {
    return;
  }
  table.add(line("part", onOff()), "with `--hand vacuum`: whether a part covers the cup",
            kNotOnPage, [unit](bool present) { unit->setPart(present); });
  table.add(line("pump", choice({"green", "yellow", "orange", "red"})),
            "with `--hand vacuum`: health of the pump; a red one does not work", kNotOnPage,
            [unit](std::uint64_t health) { unit->setHealth(static_cast<PumpHealth>(health)); });
}

}  // namespace franka_sim
