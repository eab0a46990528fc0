// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fnv_hash.h>
#include <franka_sim/fci/command_link.h>
#include <franka_sim/fci/gripper_server.h>
#include <franka_sim/fci/host.h>
#include <franka_sim/fci/robot_server.h>
#include <franka_sim/fci/unit_request_handler.h>
#include <franka_sim/fci/vacuum_server.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/gripper_unit.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/vacuum_gripper_unit.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>

namespace franka_sim::fci {

/// One robot on the network: control unit, hand and vacuum gripper with their plants and servers.
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

  ControlUnit& unit() noexcept { return unit_; }
  CommandLink& link() noexcept { return link_; }
  const RobotServer& server() const noexcept { return server_; }
  std::uint16_t gripperPort() const noexcept { return hand_ ? hand_->server.port() : 0; }
  std::uint16_t vacuumPort() const noexcept { return vacuum_ ? vacuum_->server.port() : 0; }
  /// Null if the robot has none.
  VacuumGripperUnit* vacuum() noexcept { return vacuum_ ? &vacuum_->unit : nullptr; }

  /// Sets the function that reports a self-collision or a contact reflex, once each time the error
  /// appears. Its argument is the text after the robot's name and a colon. It is called within
  /// `observe`.
  void onCollision(std::function<void(const std::string&)> tell) { tell_ = std::move(tell); }

  /// Sets the function that reports why connections were ended (ClientSlot::onRefusal). Its
  /// argument is the text after the robot's name and a colon. It is called within `serve`.
  void onRefusal(const ClientSlot::Tell& tell);

  /// Hash of all states from the first answered one on, without their ids: equal hashes mean equal
  /// runs (decision 21).
  std::uint64_t hash() const noexcept { return hash_.value(); }
  /// Call after a reset of the world: restores the condition after the start; the hash restarts.
  /// Then call `observe` once: in the next tick, or once more within a tick.
  void restart() noexcept;
  /// The world has stopped for good: running motions and requests are aborted, and closed brakes
  /// show that no motion is possible until `restart`, which opens them.
  void halt() noexcept;

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
  struct ServedHand {
    ServedHand(const std::string& address, const Hand& hand)
        : plant(*hand.plant), unit(hand.parameters), server(address, hand.port, unit) {}
    HandPlant& plant;
    GripperUnit unit;
    GripperServer server;
  };
  struct ServedVacuum {
    ServedVacuum(const std::string& address, const Vacuum& vacuum)
        : unit(vacuum.parameters), server(address, vacuum.port, unit) {}
    VacuumGripperUnit unit;
    VacuumServer server;
  };

  void publishTools(std::uint64_t ticks);
  void updateHash() noexcept;

  ControlUnit unit_;
  ArmPlant& arm_;
  UnitRequestHandler handler_;
  RobotServer server_;
  CommandLink link_;
  std::unique_ptr<ServedHand> hand_;
  std::unique_ptr<ServedVacuum> vacuum_;
  std::function<void(const std::string&)> tell_;
  bool halted_{false};
  bool hashing_{false};
  franka_core::FnvHash hash_;
};

}  // namespace franka_sim::fci
