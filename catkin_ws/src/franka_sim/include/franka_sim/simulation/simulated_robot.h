// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/whole_robot.h>
#include <franka_sim/simulation/motion_laws.h>
#include <franka_sim/simulation/robot_setup.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

namespace franka_sim {

/// The robot cannot do what was requested: a sentence with its mode and errors.
class RequestRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What is done at 1 kHz to torques that a slow program commands in steps, or to those of a law.
struct TorqueShaping {
  bool limit_rate{false};           ///< they change no faster than the robot allows; laws always
  std::array<double, 7> damping{};  ///< times the joint velocity is subtracted [Nm s/rad]
};

/// A robot of a Simulation, commanded from the same process. Its rules are those of the FCI. A
/// command or a law starts a motion and is sent in every tick until the next one. Called by one
/// thread.
class SimulatedRobot {
 public:
  /// @param hand whether its hand, if its description has one, is driven
  /// @throws as addRobot
  SimulatedRobot(const RobotSetup& setup, bool hand, World& world);

  const RobotSetup& setup() const noexcept { return setup_; }
  WholeRobot& units() noexcept { return robot_; }
  const WholeRobot& units() const noexcept { return robot_; }
  /// The present state; the reference stays valid.
  const franka_core::RobotState& state() const noexcept { return state_; }

  /// Sends this command in each tick from now on. @param motion is started first if none runs
  /// @throws RequestRefused if it cannot be started, if a motion of another kind runs, or if the
  /// running one is ending
  void command(const franka_core::fci::MoveRequest& motion,
               const franka_core::RobotCommand& command);
  /// The same for torques, with the request that clients of this robot send.
  void commandTorques(const std::array<double, 7>& tau, const TorqueShaping& shaping = {});
  /// The law that drives the arm; a torque motion is started if none runs. A law replaces torques
  /// and the other law, and then begins anew. @throws as command
  JointLaw& jointLaw();
  CartesianLaw& cartesianLaw();
  /// Damps the joints beside the law that runs, until its motion ends or torques are commanded.
  void setDamping(const std::array<double, 7>& damping) noexcept { shaping_.damping = damping; }
  /// Ends the motion as a client does at the end of its work; the robot brakes. Nothing without
  /// one.
  void finish() noexcept;
  /// Whether a motion of this process runs.
  bool moving() const noexcept { return !std::holds_alternative<std::monostate>(input_); }

  /// Makes a request of the unit. @param what for the message: "The load"
  /// @throws RequestRefused
  void request(const UnitRequest& request, const std::string& what);
  /// Starts the recovery from errors; it takes time. @throws RequestRefused
  void recover();
  /// How the last motion ended; nothing before the first end.
  std::optional<Status> lastResult() const noexcept { return last_result_; }

  /// The halves of a tick, as those of WholeRobot. Real-time safe.
  void observe() noexcept;
  /// @param command of a client on the network, for ticks without a motion of this process
  void actuate(const franka_core::RobotCommand* command = nullptr) noexcept;
  /// Shows what requests of clients have changed since observe().
  void refresh() noexcept { state_ = robot_.unit().state(); }
  /// Call after a reset of the world or a teleport: idle, without errors, in its configuration.
  void restart();
  /// Whether clients on the network use it too: a restart then keeps what they are to be answered.
  void setServed(bool served) noexcept { served_ = served; }

 private:
  SimulatedRobot(const RobotSetup& setup, bool hand, const RobotInWorld& in_world);
  template <typename Law>
  Law& law();
  franka_core::fci::MoveRequest torqueMotion() const noexcept;
  void start(const franka_core::fci::MoveRequest& motion);
  const franka_core::RobotCommand* nextCommand() noexcept;
  [[noreturn]] void refuse(const std::string& what) const;

  RobotSetup setup_;
  WholeRobot robot_;
  franka_core::RobotState state_;         ///< of the unit, at an address that stays
  franka_core::fci::MoveRequest motion_;  ///< the running one
  std::variant<std::monostate, franka_core::RobotCommand, JointLaw, CartesianLaw> input_;
  franka_core::RobotCommand sent_;
  TorqueShaping shaping_;  ///< of the running motion
  bool finishing_{false};
  bool recovering_{false};
  bool served_{false};
  std::optional<Status> last_result_;
};

}  // namespace franka_sim
