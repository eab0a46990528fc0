// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/numbers.h>
#include <franka_core/robot_error.h>
#include <franka_sim/fci/served_models.h>
#include <franka_sim/fci/serving.h>
#include <franka_sim/robot/parameter_checks.h>

#include <stdexcept>

namespace franka_sim::fci {

using franka_core::RobotError;

namespace {

std::string toText(const std::array<double, 7>& values) {
  std::string text;
  for (const double value : values) {
    text += " " + franka_core::numberText(value, 9);
  }
  return text;
}

std::string errorNames(const ControlUnit& unit) {
  const std::array<bool, franka_core::kErrorCount>& errors = unit.state().errors;
  std::string text;
  for (std::size_t i = 0; i < errors.size(); i++) {
    text += errors[i] ? std::string(" ") + franka_core::kErrorNames[i] : "";
    const std::string detail = errors[i] ? detailOf(unit, i) : "";
    text += detail.empty() ? "" : " (" + detail + ")";
  }
  return text.empty() ? " none" : text;
}

}  // namespace

std::string detailOf(const ControlUnit& unit, std::size_t error) {
  const UnitStatus status = unit.status();
  if (error == indexOf(RobotError::kSelfCollisionAvoidanceViolation)) {
    return linksOf(status.self_collision);
  }
  if (error == indexOf(RobotError::kJointReflex) && status.joint_collision.happened) {
    return describeJointCollision(status.joint_collision);
  }
  if (error == indexOf(RobotError::kCartesianReflex) && status.cartesian_collision.happened) {
    return describeCartesianCollision(status.cartesian_collision, unit.configuration().rules);
  }
  return "";
}

RobotServerParameters servedAt(const std::string& address, const ProtocolRange& protocols,
                               const franka_core::ArmModel& arm) {
  RobotServerParameters server;
  server.address = address;
  server.oldest_version = protocols.oldest;
  server.newest_version = protocols.newest;
  server.model_library = servedLibrary(arm);
  server.urdfs = {{8, servedUrdf(arm, 8)}, {10, servedUrdf(arm, 10)}};  // (decision 8)
  return server;
}

SimRobot::Hand servedHand(HandPlant& fingers, const GripperLatency& latency) {
  return {&fingers, handParameters(latency)};
}

SimRobot servedRobot(const std::string& address, const ProtocolRange& protocols,
                     ControlUnitParameters unit, ArmPlant& arm,
                     const std::optional<SimRobot::Hand>& hand,
                     const std::optional<SimRobot::Vacuum>& vacuum, unsigned command_delay) {
  unit.rules = InterfaceRules::kFci;
  unit.protocol_version = protocols.newest;
  return SimRobot(unit, arm, servedAt(address, protocols, unit.model), hand, vacuum, command_delay);
}

std::string linksOf(const SelfCollision::Pair& pair) {
  const auto name = [](int link) {
    return link == kHandLink ? std::string("hand") : "link" + std::to_string(link);
  };
  return name(pair.first) + " and " + name(pair.second);
}

void setLoad(SimRobot& robot, const franka_core::Payload& load) {
  const std::optional<Status> status = robot.unit().request(loadRequest(load));
  if (status == Status::kInvalidArgumentRejected) {
    throw std::runtime_error("The load was refused. " + payloadFault(load));
  }
  if (status != Status::kSuccess) {
    throw std::runtime_error("The load was refused: a motion runs. End it, then set the load.");
  }
}

std::string collisionOf(const ControlUnit& unit, RobotError error) {
  const std::string detail = detailOf(unit, indexOf(error));
  return error == RobotError::kSelfCollisionAvoidanceViolation
             ? "its " + detail + " came too close to each other"
             : "it met something, " + detail;
}

std::string describe(SimRobot& robot) {
  const franka_core::RobotState& state = robot.unit().state();
  return std::string(franka_core::fci::modeName(state.robot_mode)) + ", client of protocol " +
         std::to_string(robot.server().version()) + ", errors" + errorNames(robot.unit()) + ", q" +
         toText(state.q);
}

}  // namespace franka_sim::fci
