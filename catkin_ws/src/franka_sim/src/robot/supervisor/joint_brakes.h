// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

namespace franka_sim {

/// The joints' brakes, which close on an arm that has come to rest (a stop of category 1,
/// IEC 60204-1). Called by one thread. Real-time safe.
class JointBrakes {
 public:
  bool closed() const noexcept { return closed_; }
  void open() noexcept { closed_ = false; }
  /// Begins to close them: at once if the arm rests.
  void close(bool rests) noexcept;
  /// One tick of an arm that is to come to rest. @returns whether it has been resting for a while
  bool hasComeToRest(bool rests) noexcept;
  /// One tick of brakes that wait for the arm, which no longer brakes by its motors.
  void step(bool rests) noexcept;
  /// Begins to count again. @param closed whether the brakes are closed
  void restart(bool closed) noexcept;

 private:
  bool closed_{false};
  int ticks_{0};          // since the end of braking
  int resting_ticks_{0};  // in a row
};

}  // namespace franka_sim
