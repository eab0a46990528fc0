// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit_parameters.h>
#include <franka_sim/robot/whole_robot.h>
#include <franka_sim/simulation/robot_setup.h>

#include <array>
#include <optional>
#include <stdexcept>
#include <string>
#include <variant>

namespace franka_sim {

/// How a target moves: from rest to rest (smoothStep), or at constant speed, for targets that
/// follow each other.
enum class TargetMotion { kSmooth, kLinear };

/// A torque controller at 1 kHz below a slow program, which gives it targets: a spring and damper
/// at every joint (JointImpedance), whose target moves. Its torques pass the robot's limits and
/// reflexes. Called by one thread. Real-time safe.
class JointLaw {
 public:
  /// Begins at the state's desired position.
  explicit JointLaw(const franka_core::RobotState& state) noexcept;

  /// @param q [rad] @param duration of the way to it [s]
  void setTarget(const std::array<double, 7>& q, double duration,
                 TargetMotion motion = TargetMotion::kSmooth) noexcept;
  void setStiffness(const std::array<double, 7>& K) noexcept { stiffness_ = K; }  ///< [Nm/rad]
  /// The torque of one tick, without gravity [Nm]. @param dynamics of the state, frame EE
  std::array<double, 7> torque(const franka_core::RobotState& state,
                               const ControlUnitParameters& unit,
                               const franka_core::ArmDynamics& dynamics) noexcept;

 private:
  std::array<double, 7> stiffness_;
  std::array<double, 7> from_, to_;
  std::array<double, 7> desired_;
  double time_{0.0}, duration_{0.0};
  TargetMotion motion_{TargetMotion::kSmooth};
};

/// A spring and damper at the stiffness frame (cartesianImpedance), whose target moves.
class CartesianLaw {
 public:
  /// Begins at the state's desired pose.
  explicit CartesianLaw(const franka_core::RobotState& state) noexcept;

  /// @param O_T_EE 4x4 column-major @param duration of the way to it [s]
  void setTarget(const std::array<double, 16>& O_T_EE, double duration,
                 TargetMotion motion = TargetMotion::kSmooth) noexcept;
  void setStiffness(const std::array<double, 6>& K) noexcept { stiffness_ = K; }  ///< [N/m, Nm/rad]
  void setNullspaceStiffness(double K) noexcept { nullspace_stiffness_ = K; }     ///< [Nm/rad]
  /// The torque of one tick, without gravity [Nm]. @param dynamics of the state, frame EE
  std::array<double, 7> torque(const franka_core::RobotState& state,
                               const ControlUnitParameters& unit,
                               const franka_core::ArmDynamics& dynamics) noexcept;

 private:
  void advance() noexcept;

  std::array<double, 6> stiffness_;
  double nullspace_stiffness_;
  std::array<double, 16> from_, to_, desired_;
  std::array<double, 7> q_;  ///< of the null space [rad]
  double time_{0.0}, duration_{0.0};
  TargetMotion motion_{TargetMotion::kSmooth};
};

/// The robot cannot do what was requested: a sentence with its mode and errors.
class RequestRefused : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Processing at 1 kHz of the torques that come from a slow program or from a law.
struct TorqueShaping {
  bool limit_rate{false};           ///< they change no faster than the robot allows; laws always
  std::array<double, 7> damping{};  ///< times the joint velocity is subtracted [Nm s/rad]
};

/// A robot of a Simulation, commanded from the same process. Its rules are those of the FCI. A
/// command or a law starts a motion and is sent in every tick until the next one. Called by one
/// thread.
class SimulatedRobot {
 public:
  /// @param hand false: the robot that comes along has none, and that of a description of one's own
  /// is not driven
  /// @throws as addRobot
  SimulatedRobot(const RobotSetup& setup, bool hand, World& world);

  /// The setup of the constructor.
  const RobotSetup& setup() const noexcept { return setup_; }
  /// @name Its control unit, hand and safety controller
  /// @{
  WholeRobot& units() noexcept { return robot_; }
  const WholeRobot& units() const noexcept { return robot_; }
  /// @}
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
  /// and the other law, and then starts again. @throws as command
  JointLaw& jointLaw();
  /// The same for the Cartesian law.
  CartesianLaw& cartesianLaw();
  /// Damps the joints in addition to the law that runs, until its motion ends or torques are
  /// commanded.
  void setDamping(const std::array<double, 7>& damping) noexcept { shaping_.damping = damping; }
  /// Ends the motion as a client does at the end of its work; the robot brakes. Nothing without
  /// one.
  void finish() noexcept;
  /// Whether a motion of this process runs.
  bool moving() const noexcept { return !std::holds_alternative<std::monostate>(input_); }

  /// Makes a request of the unit; user stop, guiding and brakes by the safety controller.
  /// @param what for the message: "The load"
  /// @throws RequestRefused with a sentence
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
  /// @name Its condition, for snapshots
  /// @{
  /// A robot in the same condition, which keeps it and is not stepped.
  SimulatedRobot(const SimulatedRobot&) = default;
  ~SimulatedRobot() = default;
  /// Whether the other one's condition can be restored here: same robot, hand and realism.
  bool hasSameSetup(const SimulatedRobot& other) const;
  /// Takes over the condition of a robot like this one: motion, commands, hand, settings, errors.
  /// One that clients on the network use restarts instead, because their motions are theirs.
  /// @param earlier whether it was this robot
  void restore(const SimulatedRobot& then, bool earlier);
  /// @}
  /// Whether clients on the network use it too: a restart then keeps their pending answers.
  void setServed(bool served) noexcept { served_ = served; }

 private:
  SimulatedRobot(const RobotSetup& setup, bool hand, const RobotInWorld& in_world);
  SimulatedRobot& operator=(const SimulatedRobot&) = default;
  template <typename Law>
  Law& law();
  franka_core::fci::MoveRequest torqueMotion() const noexcept;
  void start(const franka_core::fci::MoveRequest& motion);
  const franka_core::RobotCommand* nextCommand() noexcept;
  void endOwnMotion() noexcept;
  [[noreturn]] void refuse(const std::string& what, bool recovery = false) const;

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
