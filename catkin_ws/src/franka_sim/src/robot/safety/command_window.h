// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <bitset>
#include <cstddef>

namespace franka_sim {

/// Which of the last 100 ticks of a motion had a command: control_command_success_rate
/// (protocol 5.3). Called by one thread. Real-time safe.
class CommandWindow {
 public:
  static constexpr std::size_t kSlots = 100;

  void record(bool received) noexcept;
  /// Fraction received of the ticks seen so far, at most the last 100; zero before the first.
  double rate() const noexcept;
  void clear() noexcept;

 private:
  std::bitset<kSlots> received_;
  std::size_t next_{0};
  std::size_t seen_{0};
};

}  // namespace franka_sim
