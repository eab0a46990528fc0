// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/robot_state.h>
#include <franka_sim/robot/realism.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <random>

namespace franka_sim {

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

}  // namespace franka_sim
