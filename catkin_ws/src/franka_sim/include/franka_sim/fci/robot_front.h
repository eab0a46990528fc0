// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/gripper_server.h>
#include <franka_sim/fci/host.h>
#include <franka_sim/fci/robot_server.h>
#include <franka_sim/fci/unit_request_handler.h>
#include <franka_sim/fci/vacuum_server.h>
#include <franka_sim/robot/whole_robot.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace franka_sim::fci {

/// The network side of one robot: the servers of its units. Called by one thread.
class RobotFront : public HostedRobot {
 public:
  /// Ports of the tools that are served; 0: the system chooses.
  struct ToolPorts {
    std::optional<std::uint16_t> hand;
    std::optional<std::uint16_t> vacuum;
  };

  /// @param robot outlives this; it has the tools whose ports are given
  /// @throws std::runtime_error if a port cannot be opened
  RobotFront(WholeRobot& robot, RobotServerParameters server, const ToolPorts& tools);

  const RobotServer& server() const noexcept { return server_; }
  std::uint16_t gripperPort() const noexcept { return hand_ ? hand_->port() : 0; }
  std::uint16_t vacuumPort() const noexcept { return vacuum_ ? vacuum_->port() : 0; }

  /// Sets the function that reports a self-collision or a contact reflex, once each time the error
  /// appears. Its argument is the text after the robot's name and a colon. It is called within
  /// `observe`.
  void onCollision(std::function<void(const std::string&)> report) { report_ = std::move(report); }

  /// Sets the function that reports why connections were ended (ClientSlot::onRefusal). Its
  /// argument is the text after the robot's name and a colon. It is called within `serve`.
  void onRefusal(const ClientSlot::Report& report);

  void observe() override;
  void actuate() override;
  void serve(bool stops_only) override;
  bool idle() const override;
  void publish(std::uint64_t ticks, bool same_moment, bool keep_end) override;
  void repeat() override;
  bool hasNews() const override { return server_.hasNews(); }
  bool receiveCommand() override { return server_.receiveCommand(); }
  bool expectsCommand() const override { return server_.expectsCommands(); }
  bool asynchronous() const override { return server_.asynchronous(); }
  bool motionHasBegun() const override { return server_.motionHasBegun(); }
  bool settling() const override;
  bool settlesInKnownTime() const override { return robot_.safety().busy(); }
  bool handBusy() const override;
  /// Whether a client is connected to the arm or to the hand.
  bool hasClients() const;
  void addDescriptors(std::vector<pollfd>& fds) const override;
  void addCommandDescriptor(std::vector<pollfd>& fds) const override {
    server_.addCommandDescriptor(fds);
  }

 protected:
  /// The client's answer to the last state; null if there is none. Between motions it drops the
  /// commands in the link, which belong to another motion.
  const franka_core::RobotCommand* takeCommand() noexcept;

 private:
  void publishTools(std::uint64_t ticks);

  WholeRobot& robot_;
  UnitRequestHandler handler_;
  RobotServer server_;
  std::unique_ptr<GripperServer> hand_;
  std::unique_ptr<VacuumServer> vacuum_;
  std::function<void(const std::string&)> report_;
};

}  // namespace franka_sim::fci
