// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/fci/host.h>

#include <cstdint>

namespace franka_sim_mujoco {

/// The slowest pace [simulated seconds a wall second]: a tick lasts a tenth of a second, so that
/// requests are still served promptly.
constexpr double kSlowestPace = 0.01;

/// How the host keeps a real time factor; 0 means without heeding the clock. Clients of robots in
/// motion are waited for in any case (docs/franka_sim.md).
/// @throws std::runtime_error with a sentence when it is not finite, negative, or slower than
/// kSlowestPace but not 0
franka_sim::fci::Pace paceOf(double real_time_factor);

/// Most messages of /clock a wall second [Hz] at a real time factor: a tick each up to real time;
/// fewer beyond, where they would keep the processors from all but waking nodes up.
double clockRateOf(double real_time_factor) noexcept;

/// Makes a thread that never has to wait sleep for a moment now and then. The kernel leaves threads
/// beside one that always runs, of the same process above all, waiting for seconds on a machine
/// with other work. Belongs to that thread; a thread that waits by itself is left alone.
class ShortSleeps {
 public:
  /// To be called often. Sleeps 1 ms where the thread has hardly slept for 20 ms: chosen here, a
  /// twentieth of the pace at most.
  void sleepIfDue() noexcept;

 private:
  std::int64_t looked_ns_{0};
  std::int64_t sleeps_{-1};  ///< of the thread, when it was looked
};

/// The monotonic clock [ns].
std::int64_t monotonicNanoseconds() noexcept;

/// What the calling thread has computed so far [ns]: for benchmarks, which other programs shall not
/// disturb.
std::int64_t threadNanoseconds() noexcept;

}  // namespace franka_sim_mujoco
