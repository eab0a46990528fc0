// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fnv_hash.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/hands/gripper_unit.h>
#include <franka_sim/robot/hands/vacuum_gripper_unit.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/realism.h>
#include <franka_sim/robot/safety/safety_controller.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <random>

namespace franka_sim {

/// Joint motions that the operator starts by Desk: from rest to rest, by smoothStep, within the
/// limits of the joints, by the unit's joint impedance controller. Where the velocity limit of an
/// FR3's joint falls faster than smoothStep slows down, the way's time passes more slowly.
/// Called by one thread. Real-time safe.
class OperatorMotion {
 public:
  /// @param unit outlives the motion.
  explicit OperatorMotion(ControlUnit& unit) noexcept : unit_(&unit) {}

  /// The pose in which an arm is packed [rad]. Chosen here, as Franka does not publish its own:
  /// folded above the shoulder, within the limits of a Panda and of an FR3.
  static constexpr std::array<double, 7> kPackPose{0.0, -0.56, 0.0, -2.95, 0.0, 2.4, M_PI_4};

  /// @param q target [rad], which the joints can reach @param speed share of the joints' velocity
  /// limits, above 0, at most 1
  /// @returns the answer to the unit's Move request; kInvalidArgumentRejected for an invalid target
  Status start(const std::array<double, 7>& q, double speed) noexcept;
  /// Brakes. The motion has then not arrived.
  void stop() noexcept;
  /// The command of this tick; nullptr if no motion runs.
  const franka_core::RobotCommand* command() noexcept;

  bool active() const noexcept { return active_; }
  /// Whether the last motion has reached its target.
  bool arrived() const noexcept { return arrived_; }

  /// The first joint (0 to 6) that cannot go from where the arm is to q [rad]; none if all can.
  std::optional<std::size_t> jointOutOfReach(const std::array<double, 7>& q) const noexcept;

 private:
  double shortestDuration(double speed) const noexcept;
  double velocityLimit(std::size_t joint, double q) const noexcept;
  double farthestShare() const noexcept;
  double nextTime() const noexcept;

  FixedPointer<ControlUnit> unit_;
  std::array<double, 7> from_{}, to_{};
  double time_{0.0}, duration_{0.0};  // [s]
  bool active_{false}, arrived_{false};
  franka_core::RobotCommand command_;
};

/// A simulated link for commands, worse than loopback: it loses some commands and delays all by
/// whole ticks. The same seed loses the same commands. Called by one thread.
class CommandLink {
 public:
  static constexpr unsigned kMaxDelay = kMaxCommandDelay;  ///< [ticks] (decision 20)

  /// @param probability of loss of each command, 0 to 1.
  /// @throws std::invalid_argument with a sentence for any other.
  void setLoss(double probability, std::uint64_t seed);
  /// Loses the next `commands` commands.
  void loseNext(unsigned commands) noexcept { lose_next_ = commands; }
  /// @param ticks 0 to 20. @throws std::invalid_argument with a sentence for any other.
  void setDelay(double ticks);

  /// Drops all commands that are in transit.
  void clear() noexcept;
  /// Drops all commands in transit and repeats the same losses from the start.
  void restart() noexcept;

  /// One tick: takes the incoming command, or null, and returns the outgoing one, or null. The
  /// result is valid until the next call. Real-time safe.
  const franka_core::RobotCommand* pass(const franka_core::RobotCommand* command) noexcept;

 private:
  struct Slot {
    bool full{false};
    franka_core::RobotCommand command;
  };

  bool loses() noexcept;

  double loss_{0.0};
  std::uint64_t seed_{0};
  unsigned lose_next_{0};
  unsigned delay_{0};
  std::mt19937_64 engine_;
  std::array<Slot, kMaxDelay + 1> slots_{};
  std::size_t now_{0};
};

/// The units of one robot on their plants, in ticks of 1 ms: control unit, hand and vacuum gripper,
/// the link that commands come through, the safety controller and the operator's motion. Called by
/// one thread. Real-time safe. Exceptions: the constructors, `renew` and `setPower`.
class WholeRobot {
 public:
  struct Hand {
    HandPlant* plant;
    GripperParameters parameters;
  };

  /// @param arm outlives the robot, as the hand's plant does. @param command_delay [ticks]
  /// @throws std::invalid_argument if a parameter is invalid.
  WholeRobot(const ControlUnitParameters& unit, ArmPlant& arm, const std::optional<Hand>& hand,
             const std::optional<VacuumGripperParameters>& vacuum = {}, unsigned command_delay = 0);
  /// A robot in the same condition on the same plants: keeps the condition, and is not stepped.
  WholeRobot(const WholeRobot& other);
  /// Takes over the condition of a robot with the same units; the plants stay. References to the
  /// unit's state stay valid.
  WholeRobot& operator=(const WholeRobot& other) = default;
  ~WholeRobot() = default;

  ControlUnit& unit() noexcept { return unit_; }
  const ControlUnit& unit() const noexcept { return unit_; }
  CommandLink& link() noexcept { return link_; }
  SafetyController& safety() noexcept { return safety_; }
  const SafetyController& safety() const noexcept { return safety_; }
  OperatorMotion& operatorMotion() noexcept { return operator_motion_; }
  const OperatorMotion& operatorMotion() const noexcept { return operator_motion_; }
  /// Null if the robot has none.
  GripperUnit* hand() noexcept { return hand_ ? &*hand_ : nullptr; }
  const GripperUnit* hand() const noexcept { return hand_ ? &*hand_ : nullptr; }
  VacuumGripperUnit* vacuum() noexcept { return vacuum_ ? &*vacuum_ : nullptr; }

  /// First half of a tick: measures.
  void observe() noexcept;
  /// Second half: sets the torques and forces of the coming tick. @param command that answers the
  /// observed state; nullptr: none arrived
  void actuate(const franka_core::RobotCommand* command) noexcept;

  /// Hash of all states from the first answered one on, without their ids: equal hashes mean equal
  /// runs (decision 21).
  std::uint64_t hash() const noexcept { return hash_.value(); }
  /// Call after a reset of the world: restores the condition after the start; the hash restarts.
  /// Then call `observe` once: in the next tick, or once more within a tick.
  void restart() noexcept;
  /// The condition after power-up, see SafetyController::start; with Desk's rules the hand must be
  /// homed before it moves.
  void start(SafetyRules rules) noexcept;
  /// Switches the robot off or on. Switched on, it starts with a new control unit, as `renew`
  /// does; then call `observe` once.
  void setPower(bool on);
  /// As `restart`, with a new control unit of the present configuration: without errors, idle,
  /// brakes open, at time 0, without virtual walls and filters. References to its state become
  /// invalid. Not real-time safe.
  void renew();
  /// The world has stopped for good: running motions and requests are aborted, and closed brakes
  /// show that no motion is possible until `restart`, which opens them.
  void halt() noexcept;

 private:
  void updateHash() noexcept;

  ControlUnit unit_;
  FixedPointer<ArmPlant> arm_;
  SafetyController safety_;
  OperatorMotion operator_motion_;
  CommandLink link_;
  FixedPointer<HandPlant> hand_plant_;
  std::optional<GripperUnit> hand_;
  std::optional<VacuumGripperUnit> vacuum_;
  bool halted_{false};
  bool hashing_{false};
  franka_core::FnvHash hash_;
};

/// Parameters of a Franka hand behind its own interface.
GripperParameters handParameters(const GripperLatency& latency);

}  // namespace franka_sim
