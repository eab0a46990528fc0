// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/hands/gripper_unit.h>

#include <atomic>
#include <memory>
#include <mutex>
#include <vector>

namespace franka_sim_mujoco {

/// A command for the gripper and its result.
struct GripperCommand {
  enum class Kind { kHoming, kMove, kGrasp, kStop };
  enum class Fate { kWaiting, kRunning, kSucceeded, kFailed, kInterrupted, kRefused };

  Kind kind{Kind::kStop};
  double width{0}, epsilon_inner{0}, epsilon_outer{0};  ///< [m]
  double speed{0};                                      ///< [m/s]
  double force{0};                                      ///< [N]
  /// Written by the loop; constant once it is neither waiting nor running.
  std::atomic<Fate> fate{Fate::kWaiting};

  bool isSettled() const noexcept {
    const Fate now = fate.load(std::memory_order_acquire);
    return now != Fate::kWaiting && now != Fate::kRunning;
  }
};

/// Passes commands from action threads to the loop and their outcomes back, without a lock in the
/// loop.
///
/// There is one slot: a command that arrives before the last one was taken out replaces it, and the
/// last one counts as interrupted, as it would have been a tick later. Any thread but the loop may
/// post; the loop calls the other functions.
class GripperMailbox {
 public:
  /// Thread-safe. Not real-time safe.
  void post(const std::shared_ptr<GripperCommand>& command);

  /// Gives the newest command to the unit, before its step. Real-time safe.
  void serve(franka_sim::GripperUnit& unit) noexcept;
  /// Stores the outcome, after the unit's step. Real-time safe.
  void settle(const franka_sim::GripperUnit& unit) noexcept;
  /// Interrupts all pending commands. Real-time safe.
  void interruptAll() noexcept;

 private:
  std::atomic<GripperCommand*> slot_{nullptr};
  GripperCommand* running_{nullptr};           // used by the loop only
  franka_sim::GripperUnit::Ticket ticket_{0};  // used by the loop only
  std::mutex mutex_;
  /// Owns every command until it is settled: the loop has plain pointers only.
  std::vector<std::shared_ptr<GripperCommand>> kept_;
};

}  // namespace franka_sim_mujoco
