// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/gripper_server.h>
#include <franka_sim/fci/host.h>
#include <franka_sim/fci/robot_server.h>
#include <franka_sim/fci/unit_request_handler.h>
#include <franka_sim/fci/vacuum_server.h>
#include <franka_sim/robot/whole_robot.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace franka_sim::fci {

/// One robot on the network: its units with their servers.
/// Called by one thread.
class SimRobot final : public HostedRobot {
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

  /// @param arm outlives the robot, as the hand's plant does. @param command_delay [ticks]
  /// @throws std::runtime_error if a port cannot be opened, std::invalid_argument if a parameter is
  /// invalid.
  SimRobot(const ControlUnitParameters& unit, ArmPlant& arm, RobotServerParameters server,
           const std::optional<Hand>& hand, const std::optional<Vacuum>& vacuum = {},
           unsigned command_delay = 0);

  ControlUnit& unit() noexcept { return robot_.unit(); }
  CommandLink& link() noexcept { return robot_.link(); }
  const RobotServer& server() const noexcept { return server_; }
  std::uint16_t gripperPort() const noexcept { return hand_ ? hand_->port() : 0; }
  std::uint16_t vacuumPort() const noexcept { return vacuum_ ? vacuum_->port() : 0; }
  /// Null if the robot has none.
  VacuumGripperUnit* vacuum() noexcept { return robot_.vacuum(); }

  /// Sets the function that reports a self-collision or a contact reflex, once each time the error
  /// appears. Its argument is the text after the robot's name and a colon. It is called within
  /// `observe`.
  void onCollision(std::function<void(const std::string&)> tell) { tell_ = std::move(tell); }

  /// Sets the function that reports why connections were ended (ClientSlot::onRefusal). Its
  /// argument is the text after the robot's name and a colon. It is called within `serve`.
  void onRefusal(const ClientSlot::Tell& tell);

  /// As those of WholeRobot.
  std::uint64_t hash() const noexcept { return robot_.hash(); }
  void restart() noexcept { robot_.restart(); }
  void halt() noexcept { robot_.halt(); }

  void observe() override;
  void actuate() override;
  void serve(bool stops_only) override;
  void publish(std::uint64_t ticks, bool same_moment) override;
  void repeat() override;
  bool hasNews() const override { return server_.hasNews(); }
  bool receiveCommand() override { return server_.receiveCommand(); }
  bool expectsCommand() const override { return server_.expectsCommands(); }
  bool asynchronous() const override { return server_.asynchronous(); }
  bool motionHasBegun() const override { return server_.motionHasBegun(); }
  bool settling() const override;
  bool handBusy() const override;
  /// Whether a client is connected to the arm or to the hand.
  bool hasClients() const;
  void addDescriptors(std::vector<pollfd>& fds) const override;
  void addCommandDescriptor(std::vector<pollfd>& fds) const override {
    server_.addCommandDescriptor(fds);
  }

 private:
  void publishTools(std::uint64_t ticks);

  WholeRobot robot_;
  UnitRequestHandler handler_;
  RobotServer server_;
  std::unique_ptr<GripperServer> hand_;
  std::unique_ptr<VacuumServer> vacuum_;
  std::function<void(const std::string&)> tell_;
};

}  // namespace franka_sim::fci
