// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fnv_hash.h>
#include <franka_core/robot_state.h>
#include <franka_sim/robot/command_link.h>
#include <franka_sim/robot/control_unit.h>
#include <franka_sim/robot/fixed_pointer.h>
#include <franka_sim/robot/hands/gripper_unit.h>
#include <franka_sim/robot/hands/vacuum_gripper_unit.h>
#include <franka_sim/robot/motion/operator_motion.h>
#include <franka_sim/robot/plant.h>
#include <franka_sim/robot/safety/safety_controller.h>

#include <cstdint>
#include <optional>

namespace franka_sim {

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

}  // namespace franka_sim
