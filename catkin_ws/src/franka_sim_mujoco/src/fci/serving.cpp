// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/error_names.h>
#include <franka_core/fci/texts.h>
#include <franka_sim_mujoco/fci/served_models.h>
#include <franka_sim_mujoco/fci/serving.h>
#include <franka_sim_mujoco/robot/parameter_checks.h>

#include <cstdio>
#include <stdexcept>

namespace franka_sim_mujoco::fci {

namespace {

// Force laws of the fingers: gains of the manual (franka_ros.md 9.5).
constexpr FingerGains kFingerGains{100.0, 0.0, 1.0};

std::string toText(const std::array<double, 7>& values) {
  std::string text;
  for (const double value : values) {
    char number[32];
    std::snprintf(number, sizeof(number), " %.9g", value);
    text += number;
  }
  return text;
}

std::string errorNames(const ControlUnit& unit) {
  const std::array<bool, franka_core::kErrorCount>& errors = unit.state().errors;
  std::string text;
  for (std::size_t i = 0; i < errors.size(); i++) {
    text += errors[i] ? std::string(" ") + franka_core::kErrorNames[i] : "";
    if (errors[i] && i == indexOf(ErrorFlag::kSelfCollision)) {
      text += " (" + linksOf(unit.selfCollisionPair()) + ")";
    }
  }
  return text.empty() ? " none" : text;
}

}  // namespace

ProtocolRange protocolsOf(const std::string& robot) noexcept {
  return robot == "fr3" ? ProtocolRange{6, 10} : ProtocolRange{3, 5};
}

RobotServerParameters servedAt(const std::string& address, const ProtocolRange& protocols,
                               const franka_core::ArmModel& arm) {
  RobotServerParameters server;
  server.address = address;
  server.oldest_version = protocols.oldest;
  server.newest_version = protocols.newest;
  server.model_library = servedLibrary(arm);
  server.urdfs = {{8, servedUrdf(arm, 8)}, {10, servedUrdf(arm, 10)}};  // decision 8
  return server;
}

SimRobot::Hand servedHand(HandPlant& fingers) {
  SimRobot::Hand hand{&fingers, {}};
  hand.parameters.gains = {kFingerGains, kFingerGains};
  return hand;
}

std::string linksOf(const SelfCollision::Pair& pair) {
  const auto name = [](int link) {
    return link == kHandLink ? std::string("hand") : "link" + std::to_string(link);
  };
  return name(pair.first) + " and " + name(pair.second);
}

void setLoad(SimRobot& robot, const franka_core::Payload& load) {
  switch (robot.unit().setLoad(load)) {
    case RequestStatus::kSuccess:
      return;
    case RequestStatus::kInvalidArgument:
      throw std::runtime_error("The load was refused. " + payloadFault(load));
    case RequestStatus::kNotPossible:
      throw std::runtime_error("The load was refused: a motion runs. End it, then set the load.");
  }
}

std::string describe(SimRobot& robot) {
  const franka_core::RobotState& state = robot.unit().state();
  return std::string(franka_core::fci::modeName(state.robot_mode)) + ", client of protocol " +
         std::to_string(robot.server().version()) + ", errors" + errorNames(robot.unit()) + ", q" +
         toText(state.q);
}

}  // namespace franka_sim_mujoco::fci
