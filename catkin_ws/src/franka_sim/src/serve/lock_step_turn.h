// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <string>

#include "fci/sockets.h"

namespace franka_sim::fci {

/// The right to run motions in lock-step, which as many processes of a machine have at once as it
/// has processors; the others wait for their turn (decision 65).
///
/// Places and the head of the queue are locks of files in a directory to which only their user can
/// write, so that no other user can keep them. The system gives them back when a process ends,
/// however it ends. Without such a directory, or if others keep their places for too long, a
/// process goes on without a turn.
///
/// Called by one thread. Does not block. After construction no function allocates or throws.
class LockStepTurn {
 public:
  using Clock = std::chrono::steady_clock;

  /// Then another process gets the place, if one waits. Chosen here: a hundred times as long as
  /// caches take to be filled; twelve processes for each processor wait for less than kMaxWait.
  static constexpr std::chrono::milliseconds kLength{50};
  /// Processes that do not get a place in this time go on without one for kWithoutTurn. Chosen
  /// here: clients give up after a second without a state. A stopped process keeps its place.
  static constexpr std::chrono::milliseconds kMaxWait{600};
  static constexpr std::chrono::seconds kWithoutTurn{10};
  /// A place is given back if a client does not answer for this time. After kSlowAnswers of them in
  /// a row its process goes on without turns for kSlowClient, because its exchanges take so long
  /// that others need no protection from them. Chosen here: several wake-ups of a sleeping client.
  static constexpr std::chrono::microseconds kQuickAnswer{1000};
  static constexpr int kSlowAnswers = 5;
  static constexpr std::chrono::seconds kSlowClient{1};
  /// How often a waiting process looks whether the queue has moved.
  static constexpr std::chrono::milliseconds kMaxRetry{12};
  static constexpr std::chrono::milliseconds kMinRetry{2};

  /// @param directory of the files; goes on without turns if others than this user may write there
  /// @param name processes of equal names share places @param places 0: goes on without turns
  LockStepTurn(const std::string& directory, const std::string& name, int places);
  /// For the processors on which this thread may run, shared with all processes of the user that
  /// may run on the same ones.
  LockStepTurn();

  /// Whether the process may go on. If not, ask again after retryAfter(), or when descriptor() can
  /// be read.
  bool take(Clock::time_point now) noexcept;
  Clock::duration retryAfter(Clock::time_point now) const noexcept;
  /// Ends the turn; without effect if there is none.
  void give() noexcept;
  /// The same, because a client has not answered within kQuickAnswer.
  void giveForSilence(Clock::time_point now) noexcept;

  bool taken() const noexcept { return static_cast<bool>(place_); }
  /// Can be read when a place has become free; -1 unless this process is the first in the queue.
  int descriptor() const noexcept { return head_.get(); }

 private:
  LockStepTurn(Descriptor directory, const std::string& name, int places);
  bool takePlace(Clock::time_point now) noexcept;
  bool wakeNext() noexcept;
  bool goWithout(Clock::time_point end) noexcept;

  Descriptor directory_;
  std::string name_, queue_;  ///< of the files
  int places_{0};
  Descriptor place_, head_;  ///< locked files
  Clock::time_point since_{};
  Clock::time_point waiting_since_{};  ///< zero: does not wait
  Clock::time_point without_until_{};
  int slow_answers_{0};
  int timeouts_{0};  ///< in a row
};

}  // namespace franka_sim::fci
