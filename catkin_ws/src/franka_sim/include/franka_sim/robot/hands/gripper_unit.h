// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/hands/finger_force.h>
#include <franka_sim/robot/hands/standstill.h>
#include <franka_sim/robot/hands/ticket_log.h>
#include <franka_sim/robot/hands/width_ramp.h>
#include <franka_sim/robot/plant.h>

#include <array>

namespace franka_sim {

/// Delays of a hand's commands, in addition to the motion of the fingers.
struct GripperLatency {
  double start{0};     ///< from a command to the first motion [s]
  double shortest{0};  ///< from a command to its outcome, at least [s]
};

struct GripperParameters {
  std::array<FingerGains, 2> gains;
  double max_width{0.08};           ///< [m]
  double move_tolerance{0.005};     ///< a move has arrived within this of its width [m]
  double resting_threshold{0.001};  ///< at or below this width speed the fingers stand still [m/s]
  int consecutive_samples{3};       ///< ticks of standstill that count as standing still
  double homing_speed{0.02};        ///< [m/s] (decision 29)
  double max_speed{0.1};            ///< faster commands run at this speed [m/s], data sheet
  double max_force{140.0};          ///< stronger grasps use this force [N], data sheet
  /// Heating of the motor, chosen here: Franka publishes no figures.
  double room_temperature{30.0};   ///< of a hand at rest [deg C]
  double temperature_rise{25.0};   ///< final rise under max_force [K]
  double temperature_time{600.0};  ///< time constant [s]
  GripperLatency latency;          ///< of homing, move and grasp; stop acts at once
};

/// Parameters of a Franka hand behind its own interface.
GripperParameters handParameters(const GripperLatency& latency);

enum class GripperState { kIdle, kHolding, kMoving, kGrasping };

/// The hand's controller: state machine and force law behind both interfaces (FCI and ROS), stepped
/// once a millisecond by the thread that steps the world. Commands come from that thread too,
/// between steps. Deterministic. Real-time safe. Exception: the constructor. Widths are totals of
/// both fingers [m], speeds of the width [m/s], forces the hand's total [N]: each finger presses
/// with half (decision 29).
///
/// Idle keeps the fingers where the last command left them, by the position gains alone. A grasp
/// approaches at its speed until the fingers stand still, then presses (the force rises within 0.05
/// s and centers a loose object) and checks the width once they stand still under full force. A
/// hold keeps pressing even if the object is lost; `isGrasped` then returns false. Until a command
/// begins, which takes the latency, a hand holds what it held before.
class GripperUnit {
 public:
  /// @throws std::invalid_argument with a sentence that names the invalid parameter.
  explicit GripperUnit(const GripperParameters& parameters);

  /// Identifies a command; its outcome is available until sixteen more have been given.
  using Ticket = TicketLog::Ticket;

  /// Closes fully, then opens fully. Fails if an obstacle blocks it.
  Ticket homing() noexcept;
  /// @returns 0 when refused: not homed, not finite, negative speed, width outside [0, max_width].
  Ticket move(double width, double speed) noexcept;
  /// Drives towards `width` and beyond until an object resists; then holds with `force`. Succeeds
  /// when width - epsilon_inner < measured width < width + epsilon_outer. Opens (to hold an object
  /// from inside) when width - epsilon_inner lies above the present width, else closes. @returns 0
  /// when refused: as for move, or force not finite or negative, or epsilons not finite.
  Ticket grasp(double width, double epsilon_inner, double epsilon_outer, double speed,
               double force) noexcept;
  /// Interrupts the running command and releases the force; the fingers stay where they are.
  /// Succeeds at once.
  Ticket stop() noexcept;

  GripperOutcome outcome(Ticket ticket) const noexcept { return tickets_.outcome(ticket); }
  GripperState state() const noexcept { return state_; }
  /// As last measured [m].
  double width() const noexcept { return measured_.q[0] + measured_.q[1]; }
  double maxWidth() const noexcept { return parameters_.max_width; }  ///< [m]
  /// Whether an object is held within the epsilons of the last grasp.
  bool isGrasped() const noexcept;
  /// Whether a command runs, or waits for its latency.
  bool isBusy() const noexcept { return tickets_.isOpen(); }
  /// Whether the widths are known: from the start on, and after invalidateHoming() again once a
  /// homing has succeeded. Otherwise moves and grasps are refused.
  bool isHomed() const noexcept { return homed_; }
  void invalidateHoming() noexcept { homed_ = false; }

  /// Motor temperature [deg C]: a first-order lag of the squared force, like the heat loss in a
  /// motor's windings.
  double temperature() const noexcept { return temperature_; }

  /// Takes over a measurement if it is finite. Real-time safe.
  void observe(const HandMeasurement& measurement) noexcept;

  /// One tick. @param period [s] @returns force on each finger, positive opens [N]; zero for a
  /// measurement that is not finite.
  std::array<double, 2> step(const HandMeasurement& measurement, double period) noexcept;

  /// Call after the state of another hand was assigned: earlier tickets of this one then count as
  /// interrupted.
  void renumberTickets() noexcept { tickets_.renumber(); }

  /// Call after a reset of the world: idle at the present width; interrupts the running command.
  void restart() noexcept;

 private:
  enum class Homing { kNone, kCloses, kOpens };

  struct Grasp {
    double low{0.0}, high{0.0};  // widths of success, exclusive [m]
    double force{0.0};           // on each finger [N]
    double damping{0.0};         // against motion under that force [N s/m]
    bool opens{false};
  };

  struct Command {
    enum class Kind { kNone, kHoming, kMove, kGrasp };
    Kind kind{Kind::kNone};
    double width{0.0}, speed{0.0};
    Grasp grasp;
  };

  Ticket accept(const Command& command) noexcept;
  void execute(Command command) noexcept;
  void drive(double target, double speed) noexcept;
  void begin() noexcept;
  void idle(GripperOutcome outcome) noexcept;
  void advanceMove(bool resting) noexcept;
  void advanceGrasp(bool resting, double period) noexcept;
  bool resting(double period) noexcept;
  bool withinGrasp() const noexcept;
  std::array<double, 2> follow(double period) noexcept;
  std::array<double, 2> press() const noexcept;
  void warm(const std::array<double, 2>& force, double period) noexcept;

  GripperParameters parameters_;
  GripperState state_{GripperState::kIdle};
  bool begun_{false};             // the ramp has started from the measured width
  Homing homing_{Homing::kNone};  // of the running move
  bool homed_{true};
  bool pressing_{false};  // the grasp has met resistance
  double pressed_{0.0};   // duration of pressing [s]
  double target_{0.0};    // of the command [m]
  double speed_{0.0};     // of the command [m/s]
  double temperature_;    // [deg C]
  HandMeasurement measured_;
  Command next_;       // accepted, but not begun
  double since_{0.0};  // its or the running command's acceptance [s]
  Grasp grasp_;
  TicketLog tickets_;
  WidthRamp ramp_;
  Standstill standstill_;
  std::array<FingerForce, 2> fingers_;
};

}  // namespace franka_sim
