// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/hands/ticket_log.h>

#include <cstdint>

namespace franka_sim {

/// Health of the pump, from best to worst; a red one does not pump.
enum class PumpHealth : std::uint8_t { kGreen, kYellow, kOrange, kRed };

/// Dynamics of the pump. Chosen here, because Franka publishes no figures: typical of small
/// electric pumps with a suction cup.
struct VacuumGripperParameters {
  double sealed_vacuum{800.0};   ///< final vacuum with a part on the cup [mbar]
  double open_vacuum{40.0};      ///< final vacuum without [mbar]
  double pump_time{0.12};        ///< time constant towards these [s]
  double leak_time{0.5};         ///< time constant of the leak when the pump is off [s]
  double blow_time{0.03};        ///< time constant of blowing off, and of air entering [s]
  double part_vacuum{100.0};     ///< above this a part counts as held [mbar]
  double hysteresis{30.0};       ///< the vacuum may fall by so much below its set point [mbar]
  double detached_vacuum{10.0};  ///< at or below this a part counts as released [mbar]
  double idle_power{20.0};       ///< of the pump while it holds a vacuum [%]
};

/// The vacuum gripper's controller and its pump, stepped once a millisecond. Commands come between
/// steps, by the same thread. Deterministic. Real-time safe. Exception: the constructor.
///
/// The vacuum follows first-order laws, solved exactly for each tick. `setPart` defines whether a
/// part covers the cup. A vacuum that is reached is held until drop off, stop or a timeout: a lost
/// part shows in the state. `stop` and an unsuccessful command switch the pump off.
class VacuumGripperUnit {
 public:
  /// @throws std::invalid_argument with a sentence that names the invalid parameter.
  explicit VacuumGripperUnit(const VacuumGripperParameters& parameters = {});

  /// Identifies a command, as in GripperUnit.
  using Ticket = TicketLog::Ticket;

  /// Pumps until `vacuum` [mbar] is reached, then holds it. Fails after `timeout` [ms].
  /// @returns 0 when refused: vacuum not positive or above what the pump reaches, a negative
  /// timeout, or a red pump.
  Ticket vacuum(double vacuum, std::int64_t timeout) noexcept;
  /// Blows the part off. Fails after `timeout` [ms]. @returns 0 when refused: a negative timeout.
  Ticket dropOff(std::int64_t timeout) noexcept;
  /// Interrupts the running command and switches the pump off; the vacuum leaks away. Succeeds at
  /// once.
  Ticket stop() noexcept;

  GripperOutcome outcome(Ticket ticket) const noexcept { return tickets_.outcome(ticket); }
  bool isBusy() const noexcept { return tickets_.isOpen(); }  ///< whether a command runs

  /// Puts a part on the cup, or removes it.
  void setPart(bool covers) noexcept { part_ = covers; }
  void setHealth(PumpHealth health) noexcept;

  /// One tick. @param period [s], not negative
  void step(double period) noexcept;

  double vacuum() const noexcept { return level_; }  ///< [mbar]
  double power() const noexcept;                     ///< of the pump [%]
  bool inControlRange() const noexcept;              ///< the requested vacuum is held
  bool partPresent() const noexcept { return level_ >= parameters_.part_vacuum; }
  bool partDetached() const noexcept { return detached_; }  ///< by the last command, a drop off
  PumpHealth health() const noexcept { return health_; }

  /// Call after a reset of the world: off, without vacuum; interrupts the running command. The part
  /// on the cup and the pump's health stay.
  void restart() noexcept;

 private:
  enum class State { kOff, kPumping, kHolding, kBlowing };

  void begin(State state, std::int64_t timeout) noexcept;
  void end(State state, GripperOutcome outcome) noexcept;
  void flow(double period) noexcept;
  void approach(double level, double time, double period) noexcept;

  VacuumGripperParameters parameters_;
  State state_{State::kOff};
  PumpHealth health_{PumpHealth::kGreen};
  bool part_{false};
  bool detached_{false};
  double level_{0.0};      // [mbar]
  double set_point_{0.0};  // [mbar]
  double elapsed_{0.0};    // since the command began [s]
  double timeout_{0.0};    // [s]
  TicketLog tickets_;
};

}  // namespace franka_sim
