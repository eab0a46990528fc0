// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/world_properties.h>
#include <franka_sim/serve/operator_commands.h>
#include <franka_sim/serve/sim_robot.h>

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <stdexcept>
#include <string>

#include "robot/safety/safety_monitor.h"

namespace franka_sim {

namespace {

using fci::LineServer;
using fci::toNumber;
using fci::toSwitch;
using Words = LineServer::Words;

constexpr std::uint64_t kFall = 1000;  // [ticks] in lock-step, until a released object rests

std::uint64_t toTicks(const std::string& word) {
  const auto ticks = franka_core::wholeNumber(toNumber(word), 1, sizes::kMaxPushTicks);
  if (!ticks) {
    throw std::invalid_argument("'" + word +
                                "' is not a number of milliseconds from 1 to 1000000.");
  }
  return static_cast<std::uint64_t>(*ticks);
}

std::array<double, 3> toVector(const Words& words, std::size_t first) {
  return {toNumber(words.at(first)), toNumber(words.at(first + 1)), toNumber(words.at(first + 2))};
}

void require(std::optional<Status> status, const std::string& sentence) {
  if (status != Status::kSuccess) {
    throw std::invalid_argument(sentence);
  }
}

void addLink(LineServer& lines, fci::SimRobot& robot) {
  lines.add("loss PROBABILITY [SEED]", [&](const Words& words) {
    robot.link().setLoss(toNumber(words.at(0)), words.size() > 1 ? fci::toSeed(words[1]) : 0);
    return "";
  });
  lines.add("lose COMMANDS", [&](const Words& words) {
    robot.link().loseNext(static_cast<unsigned>(toTicks(words.at(0))));
    return "";
  });
  lines.add("delay TICKS", [&](const Words& words) {
    robot.link().setDelay(toNumber(words.at(0)));
    return "";
  });
}

void addWorld(LineServer& lines, fci::Host& host, World& world) {
  lines.add("push BODY FX FY FZ [TX TY TZ] MILLISECONDS", [&](const Words& words) {
    const bool with_torque = words.size() > 5;
    const std::uint64_t ticks = toTicks(words.at(with_torque ? 7 : 4));
    const auto torque = with_torque ? toVector(words, 4) : std::array<double, 3>{};
    pushBody(world, words.at(0), toVector(words, 1), torque, ticks);
    host.runFree(ticks);
    return "";
  });
  lines.add("place BODY X Y Z [QW QX QY QZ]", [&](const Words& words) {
    Pose pose;
    pose.position = toVector(words, 1);
    if (words.size() > 4) {
      pose.orientation = {toNumber(words.at(4)), toNumber(words.at(5)), toNumber(words.at(6)),
                          toNumber(words.at(7))};
    }
    setBodyPose(world, words.at(0), pose);
    host.runFree(kFall);
    return "";
  });
  lines.add("where BODY", [&](const Words& words) {
    const Pose pose = bodyPose(world, words.at(0));
    return franka_core::numberText(pose.position[0], 9) + " " +
           franka_core::numberText(pose.position[1], 9) + " " +
           franka_core::numberText(pose.position[2], 9);
  });
}

// Another client's `reset` must not stop the time for which this line waits.
fci::Reply advanceTicks(fci::Host& host, std::uint64_t ticks) {
  const std::uint64_t end = host.ticks() + ticks;
  host.advance(ticks);
  return fci::Reply::when([&host, end] {
    const bool passed = host.ticks() >= end;
    host.advance(passed ? 0 : end - host.ticks());
    return passed;
  });
}

// Lines about time. In lock-step the world otherwise moves only when something happens in it.
void addTime(LineServer& lines, fci::Host& host, const World& world) {
  lines.add("time", [&world](const Words&) { return franka_core::fixedText(world.time(), 3); });
  lines.add(
      "step MILLISECONDS",
      [&host, &world](const Words& words) {
        const std::uint64_t ticks = toTicks(words.at(0));
        if (world.stopped()) {
          throw std::invalid_argument(world.fault());
        }
        return advanceTicks(host, ticks);
      },
      [&host] { return host.settled() || host.inMotion(); });
  lines.add(
      "wait",
      [&host](const Words&) {
        if (!host.atRest()) {
          throw std::invalid_argument(
              "The world has not come to rest within 10 s of its time: something keeps an arm "
              "moving.");
        }
        return "";
      },
      [&host] { return host.atRest() || host.failsToSettle(); });
}

PumpHealth toHealth(const std::string& word) {
  constexpr std::array<const char*, 4> kNames{"green", "yellow", "orange", "red"};
  for (std::size_t i = 0; i < kNames.size(); i++) {
    if (word == kNames[i]) {
      return static_cast<PumpHealth>(i);
    }
  }
  throw std::invalid_argument("'" + word + "' must be one of green, yellow, orange and red.");
}

void addVacuum(LineServer& lines, VacuumGripperUnit& unit) {
  lines.add("part on|off", [&unit](const Words& words) {
    unit.setPart(toSwitch(words.at(0)));
    return "";
  });
  lines.add("pump green|yellow|orange|red", [&unit](const Words& words) {
    unit.setHealth(toHealth(words.at(0)));
    return "";
  });
}

franka_core::fci::CartesianLimit toWall(const Words& words) {
  franka_core::fci::CartesianLimit wall;
  wall.object_frame = franka_core::kIdentityTransform;
  wall.active = words.at(1) != "off";
  if (!wall.active) {
    return wall;
  }
  Eigen::Map<Eigen::Matrix4d> frame(wall.object_frame.data());
  frame.topRightCorner<3, 1>() = Eigen::Vector3d(toVector(words, 1).data());
  wall.object_world_size = toVector(words, 4);
  sizes::check(toVector(words, 1), sizes::kMaxPosition, "m", "The wall's position");
  sizes::check(wall.object_world_size, sizes::kMaxPosition, "m", "An edge of the wall");
  if (words.size() > 7) {
    const Eigen::Quaterniond turn(toNumber(words.at(7)), toNumber(words.at(8)),
                                  toNumber(words.at(9)), toNumber(words.at(10)));
    if (turn.norm() == 0.0) {
      throw std::invalid_argument("Four zeros are not an orientation; 1 0 0 0 is the identity.");
    }
    frame.topLeftCorner<3, 3>() = turn.normalized().toRotationMatrix();
  }
  return wall;
}

void addWalls(LineServer& lines, fci::SimRobot& robot) {
  lines.add("wall NUMBER off|X Y Z DX DY DZ [QW QX QY QZ]", [&robot](const Words& words) {
    constexpr std::int64_t kLast = VirtualWalls::kCount - 1;
    const auto number = franka_core::wholeNumber(toNumber(words.at(0)), 0, kLast);
    if (!number) {
      throw std::invalid_argument("'" + words.at(0) + "' is not a number of a wall: 0 to 7.");
    }
    require(robot.unit().request(SetVirtualWall{static_cast<std::int32_t>(*number), toWall(words)}),
            "The wall was refused: it has a negative edge, or the robot moves.");
    return "";
  });
}

void addRobot(LineServer& lines, fci::SimRobot& robot, const fci::Host& host, const World& world) {
  lines.add("load MASS X Y Z [INERTIA]", [&robot](const Words& words) {
    franka_core::Payload load{toNumber(words.at(0)), toVector(words, 1), {}};
    if (words.size() > 4) {
      for (std::size_t i = 0; i < load.inertia.size(); i++) {
        load.inertia[i] = toNumber(words.at(4 + i));
      }
    }
    fci::setLoad(robot, load);
    return "";
  });
  lines.add("state", [&robot, &world](const Words&) {
    return fci::describe(robot) + (world.stopped() ? "; " + world.fault() : "");
  });
  lines.add(
      "hash",
      [&robot](const Words&) {
        char text[24];
        std::snprintf(text, sizeof(text), "%016llx", static_cast<unsigned long long>(robot.hash()));
        return std::string(text);
      },
      [&host] { return host.settled(); });
}

}  // namespace

void addOperatorCommands(fci::LineServer& lines, const OperatorContext& context) {
  addSafetyCommands(lines, context);
  addLink(lines, context.robot);
  addWorld(lines, context.host, context.world);
  addTime(lines, context.host, context.world);
  addRobot(lines, context.robot, context.host, context.world);
  addWalls(lines, context.robot);
  if (VacuumGripperUnit* vacuum = context.robot.vacuum()) {
    addVacuum(lines, *vacuum);
  }
  addHandCommands(lines, context.robot.whole());
  lines.add("reset", [reset = context.reset](const Words&) {
    reset();
    return "";
  });
  lines.add("quit", [quit = context.quit](const Words&) {
    quit();
    return "";
  });
}

void resetWorld(World& world, const std::vector<fci::SimRobot*>& robots, fci::Host& host) {
  for (const fci::SimRobot* robot : robots) {
    if (robot->expectsCommand()) {
      throw std::invalid_argument("A motion runs; the world is reset between motions only.");
    }
  }
  world.reset();
  for (fci::SimRobot* robot : robots) {
    robot->restart();
    robot->observe();  // the measurement of this tick is not valid any more
  }
  host.restartAfterReset();
}

namespace {

using fci::Reply;

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
