// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/fci/texts.h>
#include <franka_core/numbers.h>
#include <franka_core/robot_error.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/protocol_range.h>
#include <franka_sim/robot/safety/collision.h>
#include <franka_sim/robot/safety/link_pair.h>
#include <franka_sim/serve/sim_robot.h>

#include <array>
#include <stdexcept>
#include <utility>

#include "fci/hand_server.h"
#include "fci/robot_server.h"
#include "fci/served_models.h"

namespace franka_sim::fci {

using franka_core::RobotError;

namespace {

std::optional<WholeRobot::Hand> unitOf(const std::optional<SimRobot::Hand>& hand) {
  return hand ? std::optional<WholeRobot::Hand>({hand->plant, hand->parameters}) : std::nullopt;
}

std::optional<VacuumGripperParameters> unitOf(const std::optional<SimRobot::Vacuum>& vacuum) {
  return vacuum ? std::optional(vacuum->parameters) : std::nullopt;
}

template <typename Tool>
std::optional<std::uint16_t> portOf(const std::optional<Tool>& tool) {
  return tool ? std::optional(tool->port) : std::nullopt;
}

}  // namespace

struct SimRobot::Servers {
  Servers(WholeRobot& units, const RobotServerParameters& parameters)
      : handler(units.unit()), arm(parameters, handler) {}

  UnitRequestHandler handler;
  RobotServer arm;
  std::optional<GripperServer> hand;
  std::optional<VacuumServer> vacuum;
};

SimRobot::SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
                   const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum,
                   unsigned command_delay)
    : SimRobot(std::make_unique<WholeRobot>(unit, arm, unitOf(hand), unitOf(vacuum), command_delay),
               std::move(server), {portOf(hand), portOf(vacuum)}) {}

SimRobot::SimRobot(std::unique_ptr<WholeRobot> units, RobotServerParameters server,
                   const ToolPorts& tools)
    : SimRobot(*units, std::move(server), tools) {
  owned_ = std::move(units);
}

SimRobot::SimRobot(WholeRobot& units, RobotServerParameters server, const ToolPorts& tools)
    : units_(units), servers_(std::make_unique<Servers>(units, server)) {
  if (tools.hand) {
    servers_->hand.emplace(server.address, *tools.hand, *units_.hand());
  }
  if (tools.vacuum) {
    servers_->vacuum.emplace(server.address, *tools.vacuum, *units_.vacuum());
  }
}

SimRobot::~SimRobot() = default;

const RobotServer& SimRobot::server() const noexcept { return servers_->arm; }

std::uint16_t SimRobot::clientVersion() const noexcept { return servers_->arm.version(); }

std::uint16_t SimRobot::gripperPort() const noexcept {
  return servers_->hand ? servers_->hand->port() : 0;
}

std::optional<std::uint16_t> SimRobot::takenToolPort() const noexcept {
  if (!units_.safety().handServed()) {
    return std::nullopt;
  }
  if (servers_->hand && !servers_->hand->isOpen()) {
    return servers_->hand->port();
  }
  if (servers_->vacuum && !servers_->vacuum->isOpen()) {
    return servers_->vacuum->port();
  }
  return std::nullopt;
}

bool SimRobot::hasPendingState() const { return servers_->arm.hasPendingState(); }

bool SimRobot::receiveCommand() { return servers_->arm.receiveCommand(); }

void SimRobot::reportSilence(Silence silence) {
  if (!report_silence_) {
    return;
  }
  const std::string what =
      silence == Silence::kLong
          ? "time stands still until the client of the motion sends its next command, which has "
            "not come for 1 s."
          : "the client of the motion has sent no command within the patience. Time goes on, and "
            "the motion ends unless a command comes.";
  const std::string why =
      handBusy() ? "A command of the hand waits for the time as well: if the control callback has "
                   "sent it, it blocks the callback. Send it from another thread."
                 : "Probably something blocks the client's control callback (a command of the hand "
                   "or of the arm, a service, input, a lock), or a debugger has stopped it.";
  report_silence_(what + " " + why);
}

bool SimRobot::expectsCommand() const { return servers_->arm.expectsCommands(); }

bool SimRobot::clientIsLocal() const { return servers_->arm.clientIsLocal(); }

std::optional<bool> SimRobot::clientHasReadStates() const {
  return servers_->arm.clientHasReadStates();
}

bool SimRobot::asynchronous() const { return servers_->arm.asynchronous(); }

bool SimRobot::motionHasBegun() const { return servers_->arm.motionHasBegun(); }

void SimRobot::addCommandDescriptor(std::vector<pollfd>& fds) const {
  servers_->arm.addCommandDescriptor(fds);
}

void SimRobot::observe() {
  constexpr std::array<RobotError, 3> kCollisions{RobotError::kSelfCollisionAvoidanceViolation,
                                                  RobotError::kJointReflex,
                                                  RobotError::kCartesianReflex};
  const ControlUnit& unit = units_.unit();
  std::array<bool, kCollisions.size()> before{};
  for (std::size_t i = 0; i < before.size(); i++) {
    before[i] = unit.state().errors[indexOf(kCollisions[i])];
  }
  units_.observe();
  for (std::size_t i = 0; report_ && i < before.size(); i++) {
    if (!before[i] && unit.state().errors[indexOf(kCollisions[i])]) {
      report_(collisionOf(unit, kCollisions[i]) + " (" +
              franka_core::kErrorNames[indexOf(kCollisions[i])] + ").");
    }
  }
}

const franka_core::RobotCommand* SimRobot::takeCommand() noexcept {
  if (!servers_->arm.motionHasBegun()) {
    units_.link().clear();
  }
  return servers_->arm.takeCommand();
}

void SimRobot::actuate() { units_.actuate(takeCommand()); }

void SimRobot::serve(bool stops_only) {
  servers_->arm.serve(stops_only);
  const bool tools = units_.safety().handServed();
  if (servers_->hand) {
    servers_->hand->setOpen(tools);
    servers_->hand->serve(stops_only);
  }
  if (servers_->vacuum) {
    servers_->vacuum->setOpen(tools);
    servers_->vacuum->serve(stops_only);
  }
}

void SimRobot::publish(std::uint64_t ticks, bool same_tick, bool keep_end) {
  servers_->arm.publish(ticks, same_tick, keep_end);
  publishTools(ticks);
}

void SimRobot::publishTools(std::uint64_t ticks) {
  if (servers_->hand) {
    servers_->hand->publish(ticks);
  }
  if (servers_->vacuum) {
    servers_->vacuum->publish(ticks);
  }
}

bool SimRobot::repeat() {
  const bool starts =
      !servers_->arm.motionHasBegun() && servers_->arm.clientHasReadStates().value_or(false);
  const bool repeats = starts || servers_->arm.asynchronous() || servers_->arm.receiveCommand();
  if (repeats) {
    servers_->arm.repeat();
  }
  publishTools(0);
  return repeats;
}

void SimRobot::onRefusal(const std::function<void(const std::string&)>& report) {
  servers_->arm.onRefusal(report);
  if (servers_->hand) {
    servers_->hand->onRefusal(report);
  }
  if (servers_->vacuum) {
    servers_->vacuum->onRefusal(report);
  }
}

bool SimRobot::hasClients() const {
  return servers_->arm.hasClient() || (servers_->hand && servers_->hand->hasClient()) ||
         (servers_->vacuum && servers_->vacuum->hasClient());
}

bool SimRobot::idle() const {
  return servers_->arm.idle() && (!servers_->hand || servers_->hand->idle()) &&
         (!servers_->vacuum || servers_->vacuum->idle());
}

bool SimRobot::settling() const {
  const franka_core::RobotState& state = units_.unit().state();
  if (state.robot_mode == franka_core::RobotMode::kGuiding) {
    return false;  // nothing brakes an arm in Guiding: it may never come to rest
  }
  const bool abandoned =
      state.robot_mode == franka_core::RobotMode::kMove && !servers_->arm.expectsCommands();
  const UnitStatus status = units_.unit().status();
  return status.settling || abandoned || !status.resting || units_.safety().busy();
}

bool SimRobot::handBusy() const {
  return (servers_->hand && servers_->hand->busy()) ||
         (servers_->vacuum && servers_->vacuum->busy());
}

void SimRobot::addDescriptors(std::vector<pollfd>& fds) const {
  servers_->arm.addDescriptors(fds);
  if (servers_->hand) {
    servers_->hand->addDescriptors(fds);
  }
  if (servers_->vacuum) {
    servers_->vacuum->addDescriptors(fds);
  }
}

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

RobotServerParameters makeServerParameters(const std::string& address,
                                           const ProtocolRange& protocols,
                                           const franka_core::ArmModel& arm) {
  RobotServerParameters server;
  server.address = address;
  server.oldest_version = protocols.oldest;
  server.newest_version = protocols.newest;
  server.model_library = servedLibrary(arm);
  server.urdfs = {{8, servedUrdf(arm, 8)}, {10, servedUrdf(arm, 10)}};  // (decision 8)
  return server;
}

SimRobot::Hand makeHand(HandPlant& fingers, const GripperLatency& latency) {
  return {&fingers, handParameters(latency)};
}

SimRobot makeSimRobot(const std::string& address, const ProtocolRange& protocols,
                      ControlUnitParameters unit, ArmPlant& arm,
                      const std::optional<SimRobot::Hand>& hand,
                      const std::optional<SimRobot::Vacuum>& vacuum, unsigned command_delay) {
  unit.rules = InterfaceRules::kFci;
  unit.protocol_version = protocols.newest;
  return SimRobot(unit, arm, makeServerParameters(address, protocols, unit.model), hand, vacuum,
                  command_delay);
}

std::string linksOf(const LinkPair& pair) {
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
             : "it hit an obstacle, " + detail;
}

std::string describe(SimRobot& robot) {
  const franka_core::RobotState& state = robot.unit().state();
  const unsigned protocol = robot.clientVersion();
  return std::string(franka_core::fci::modeName(state.robot_mode)) + ", " +
         (protocol == 0 ? "no client" : "client of protocol " + std::to_string(protocol)) +
         ", errors" + errorNames(robot.unit()) + ", q" + toText(state.q);
}

}  // namespace franka_sim::fci
