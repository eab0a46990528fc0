// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/plant.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace franka_sim {

/// Outcome of a gripper command.
enum class GripperOutcome {
  kRunning,
  kSucceeded,  ///< arrived, or holds an object within the epsilons
  kFailed,  ///< refused, or ended at another width than commanded (obstacle, no object or another
            ///< one grasped)
  kInterrupted,  ///< another command or stop() came first
};

/// Numbers commands and stores the outcomes of the last ones. At most one runs at a time: opening a
/// new one interrupts it. Called by one thread. Real-time safe.
class TicketLog {
 public:
  using Ticket = std::uint64_t;
  static constexpr std::size_t kRemembered = 16;

  TicketLog() = default;
  TicketLog(const TicketLog&) = default;
  /// Takes over the outcomes of an earlier state of this log. Commands that were given since count
  /// as interrupted, and their numbers are not given again.
  TicketLog& operator=(const TicketLog& other) noexcept;
  ~TicketLog() = default;

  Ticket open() noexcept;
  /// Ends the running command, if any.
  void close(GripperOutcome outcome) noexcept;
  /// Whether a command runs.
  bool isOpen() const noexcept { return outcome(last_) == GripperOutcome::kRunning; }
  /// Call after the log of another hand was taken over: commands that this hand was given before
  /// count as interrupted; the last one of the other hand gets a number that this log has not
  /// given.
  void renumber() noexcept;
  /// kFailed for 0 and for unknown numbers; kInterrupted for those no longer stored.
  GripperOutcome outcome(Ticket ticket) const noexcept;

 private:
  struct Entry {
    Ticket ticket{0};
    GripperOutcome outcome{GripperOutcome::kRunning};
  };

  Entry& entry(Ticket ticket) noexcept { return entries_[ticket % kRemembered]; }

  Ticket last_{0};    ///< of the command that was given last
  Ticket issued_{0};  ///< the largest number that was given
  std::array<Entry, kRemembered> entries_{};
};

/// Whether a commanded motion has come to rest: enough consecutive samples below a threshold.
/// Samples count after the first motion or, if nothing can move, after 0.2 s (decision 29): at the
/// start everything still rests. Called by one thread. Real-time safe.
class Standstill {
 public:
  explicit Standstill(int samples) noexcept : samples_(samples) {}

  /// A new motion begins.
  void restart() noexcept;
  /// Samples count from now on, with or without motion.
  void countFromNow() noexcept { counting_ = true; }
  /// One tick. @param speed, threshold in the same unit @param period [s] @param commanded whether
  /// a motion can already be the response to the command @returns whether it rests.
  bool update(double speed, double threshold, double period, bool commanded = true) noexcept;

 private:
  int samples_;
  int below_{0};
  double elapsed_{0.0};
  bool counting_{false};
};

/// Proportional, integral, derivative gains of one finger [N/m, N/(m s), N s/m].
struct FingerGains {
  double p{100.0}, i{0.0}, d{1.0};
};

/// Force law of one finger that follows a desired position: PID on the position with the derivative
/// taken of the speeds, plus the drive's own damping about the desired speed.
/// With the manual's gains (100, 0, 1) alone a finger with its drive's inertia oscillates for half
/// a second, at a seventh of critical damping; a real hand does not. Called by one thread.
/// Real-time safe.
class FingerForce {
 public:
  /// [N s/m], chosen here: at or above critical for moving finger masses up to 0.16 kg at p = 100
  /// N/m, and stable at 1 kHz from 0.01 kg on.
  static constexpr double kDriveDamping = 7.0;

  explicit FingerForce(const FingerGains& gains) noexcept : gains_(gains) {}

  /// @param error q_d - q [m] @param rate_error dq_d - dq [m/s] @param period [s] @returns [N]
  double update(double error, double rate_error, double period) noexcept;
  /// Resets the integral.
  void restart() noexcept { integral_ = 0.0; }

  const FingerGains& gains() const noexcept { return gains_; }

 private:
  FingerGains gains_;
  double integral_{0.0};  // the integral term itself [N]
};

/// The desired width of a hand on its way to a target: accelerates and brakes at a constant rate,
/// so that the fingers neither jerk nor overshoot. Widths [m], speeds of the width [m/s]. Called by
/// one thread. Real-time safe.
class WidthRamp {
 public:
  /// Starts at rest at `width`. @param speed not negative; with zero it never arrives.
  void start(double width, double target, double speed) noexcept;
  /// Rests at a width.
  void hold(double width) noexcept { start(width, width, 0.0); }
  /// One tick. @param period [s]
  void step(double period) noexcept;

  double width() const noexcept { return width_; }
  double target() const noexcept { return target_; }
  double velocity() const noexcept { return velocity_; }
  bool arrived() const noexcept { return width_ == target_; }

 private:
  double width_{0.0};
  double target_{0.0};
  double speed_{0.0};
  double velocity_{0.0};
};

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
/// hold keeps pressing even if the object is lost; `isGrasped` shows the loss. Until a command
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
  bool isGrasped()
      const noexcept;  ///< whether an object is held within the epsilons of the last grasp
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
