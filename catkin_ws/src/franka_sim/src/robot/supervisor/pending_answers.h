// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/robot/unit_request.h>

#include <optional>

namespace franka_sim {

/// The answers of a control unit that are due later than their requests: the results of a motion, a
/// stop or a recovery. Each answer is taken once. Called by one thread. Real-time safe.
class PendingAnswers {
 public:
  std::optional<Status> take(PendingAnswer which) noexcept;

  void motionBegins() noexcept { motion_.reset(); }
  void stopBegins() noexcept;
  void recoveryBegins() noexcept { recovery_.reset(); }

  /// The motion has ended; the answer is due now.
  void motionEnds(Status status) noexcept { motion_ = status; }
  /// The motion has ended; the answer is due when the arm rests.
  void motionEndsAtRest(Status status) noexcept { motion_at_rest_ = status; }
  void recoveryEnds(Status status) noexcept { recovery_ = status; }
  /// An event came before the arm rested: the answer to a motion that waits for rest is due now. A
  /// motion that had succeeded gets this status; any other motion keeps its own.
  void interruptMotion(Status status) noexcept;
  /// The same for a stop, which gets this status.
  void interruptStop(Status status) noexcept;
  /// The arm rests: the answers that wait for rest are due.
  void atRest() noexcept;

  bool waitForRest() const noexcept { return motion_at_rest_.has_value() || stopping_; }

 private:
  std::optional<Status> motion_, stop_, recovery_;  // due now
  std::optional<Status> motion_at_rest_;
  bool stopping_{false};  // the answer to a stop waits for rest
};

}  // namespace franka_sim
