// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/fci/protocol.h>
#include <franka_core/robot_error.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/protocol_range.h>
#include <franka_sim/robot/safety/link_pair.h>
#include <franka_sim/robot/whole_robot.h>
#include <franka_sim/serve/host.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace franka_sim::fci {

class RobotServer;
struct RobotServerParameters;

/// One robot on the network: its units, or those of a robot that also this process moves, with
/// their servers. Called by one thread.
class SimRobot : public HostedRobot {
 public:
  struct Hand {
    HandPlant* plant;
    GripperParameters parameters;
    std::uint16_t port{franka_core::fci::kGripperPort};  ///< 0: the system chooses
  };
  struct Vacuum {
    VacuumGripperParameters parameters;
    std::uint16_t port{franka_core::fci::kVacuumGripperPort};  ///< 0: the system chooses
  };
  /// Ports of the tools that are served; 0: the system chooses.
  struct ToolPorts {
    std::optional<std::uint16_t> hand;
    std::optional<std::uint16_t> vacuum;
  };

  /// A robot with units of its own.
  /// @param arm outlives the robot, as the hand's plant does. @param command_delay [ticks]
  /// @throws std::runtime_error if a port cannot be opened, std::invalid_argument if a parameter is
  /// invalid.
  SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
           const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum = {},
           unsigned command_delay = 0);
  /// @param units outlive this; they have the tools whose ports are given
  /// @throws std::runtime_error if a port cannot be opened
  SimRobot(WholeRobot& units, RobotServerParameters server, const ToolPorts& tools);
  ~SimRobot() override;
  SimRobot(const SimRobot&) = delete;
  SimRobot& operator=(const SimRobot&) = delete;

  WholeRobot& whole() noexcept { return units_; }
  ControlUnit& unit() noexcept { return units_.unit(); }
  CommandLink& link() noexcept { return units_.link(); }
  /// Null if the robot has none.
  VacuumGripperUnit* vacuum() noexcept { return units_.vacuum(); }

  /// As those of WholeRobot.
  std::uint64_t hash() const noexcept { return units_.hash(); }
  void restart() noexcept { units_.restart(); }
  void halt() noexcept { units_.halt(); }

  const RobotServer& server() const noexcept;
  /// Protocol of the connected client; 0 without one.
  std::uint16_t clientVersion() const noexcept;
  std::uint16_t gripperPort() const noexcept;
  /// The port of the tool if it is to be served, but another program has taken that port; since the
  /// last serve().
  std::optional<std::uint16_t> takenToolPort() const noexcept;

  /// Sets the function that reports a self-collision or a contact reflex, once each time the error
  /// appears. Its argument is the text after the robot's name and a colon. It is called within
  /// `observe`.
  void onCollision(std::function<void(const std::string&)> report) { report_ = std::move(report); }

  /// Sets the function that reports why connections were ended, of each kind at most once in ten
  /// seconds. Its argument is the text after the robot's name and a colon. It is called within
  /// `serve`.
  void onRefusal(const std::function<void(const std::string&)>& report);

  /// Sets the function that reports that time stands still because the client of a motion is
  /// silent, and that it is given up (HostedRobot::reportSilence). Its argument is the text after
  /// the robot's name and a colon.
  void onSilence(std::function<void(const std::string&)> report) {
    report_silence_ = std::move(report);
  }

  void observe() override;
  void actuate() override;
  void serve(bool stops_only) override;
  bool idle() const override;
  void publish(std::uint64_t ticks, bool same_tick, bool keep_end) override;
  bool repeat() override;
  bool hasPendingState() const override;
  bool receiveCommand() override;
  void reportSilence(Silence silence) override;
  bool expectsCommand() const override;
  bool clientIsLocal() const override;
  std::optional<bool> clientHasReadStates() const override;
  bool asynchronous() const override;
  bool motionHasBegun() const override;
  bool settling() const override;
  bool settlesInKnownTime() const override { return units_.safety().busy(); }
  bool handBusy() const override;
  /// Whether a client is connected to the arm or to the hand.
  bool hasClients() const;
  void addDescriptors(std::vector<pollfd>& fds) const override;
  void addCommandDescriptor(std::vector<pollfd>& fds) const override;

 protected:
  /// The client's answer to the last state; null if there is none. Between motions it drops the
  /// commands in the link, which belong to another motion.
  const franka_core::RobotCommand* takeCommand() noexcept;

 private:
  struct Servers;

  SimRobot(std::unique_ptr<WholeRobot> units, RobotServerParameters server, const ToolPorts& tools);

  void publishTools(std::uint64_t ticks);

  std::unique_ptr<WholeRobot> owned_;  ///< null if the units are another one's
  WholeRobot& units_;
  std::unique_ptr<Servers> servers_;
  std::function<void(const std::string&)> report_, report_silence_;
};

}  // namespace franka_sim::fci

/// @file
/// Sets up the network servers of a Panda or an FR3, for every program that runs a world.

namespace franka_sim::fci {

/// Servers at an address of this machine, with the models of the arm that clients request.
RobotServerParameters makeServerParameters(const std::string& address,
                                           const ProtocolRange& protocols,
                                           const franka_core::ArmModel& arm);

/// A hand to serve, with the gains of its fingers. @param fingers outlive the robot
SimRobot::Hand makeHand(HandPlant& fingers, const GripperLatency& latency);

/// A robot that behaves as behind its own interface, of its newest protocol.
/// @param unit the robot's own configuration, as the user enters it in Desk
/// @param arm outlives the robot @param command_delay of every command [ticks]
/// @throws as SimRobot
SimRobot makeSimRobot(const std::string& address, const ProtocolRange& protocols,
                      ControlUnitParameters unit, ArmPlant& arm,
                      const std::optional<SimRobot::Hand>& hand,
                      const std::optional<SimRobot::Vacuum>& vacuum = {},
                      unsigned command_delay = 0);

/// The two links that came too close, named as in the description without the arm's name: "link2
/// and hand".
std::string linksOf(const LinkPair& pair);

/// Sets the load as the user does in Desk.
/// @throws std::runtime_error with a sentence when the robot refuses it
void setLoad(SimRobot& robot, const franka_core::Payload& load);

/// Message about a collision that raised this error (self-collision, joint or Cartesian reflex):
/// "it hit an obstacle, joint 4: external torque 23.4 Nm, upper threshold 20 Nm".
std::string collisionOf(const ControlUnit& unit, franka_core::RobotError error);

/// The links or the axis of a collision that raised this error (an index of RobotState::errors);
/// empty for other errors.
std::string detailOf(const ControlUnit& unit, std::size_t error);

/// Mode, client, errors (of collisions: the links or the axis) and joints in one line for the user.
std::string describe(SimRobot& robot);

}  // namespace franka_sim::fci
