// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <chrono>
#include <cstdint>
#include <ratio>

/// @file
/// A span of time in whole milliseconds, the clock of the robot.

namespace franka {

/// Unsigned milliseconds. A value that is cheap to copy; no function throws. Real-time safe.
/// Thread-safe. Differences below zero wrap around as those of uint64_t do; division by zero is
/// undefined.
class Duration {
  using Milliseconds = std::chrono::duration<uint64_t, std::milli>;

 public:
  /// Zero.
  constexpr Duration() noexcept = default;
  /// @param milliseconds length [ms].
  constexpr explicit Duration(uint64_t milliseconds) noexcept : duration_{milliseconds} {}
  /// @param duration length as a std::chrono duration.
  constexpr Duration(std::chrono::duration<uint64_t, std::milli> duration) noexcept
      : duration_{duration} {}
  constexpr Duration(const Duration&) noexcept = default;
  Duration& operator=(const Duration&) noexcept = default;

  /// The same length for std::chrono.
  constexpr operator std::chrono::duration<uint64_t, std::milli>() const noexcept {
    return duration_;
  }
  /// Length in seconds [s].
  constexpr double toSec() const noexcept {
    return std::chrono::duration_cast<std::chrono::duration<double>>(duration_).count();
  }
  /// Length in milliseconds [ms].
  constexpr uint64_t toMSec() const noexcept { return duration_.count(); }

  constexpr Duration operator+(const Duration& rhs) const noexcept {
    return Duration{toMSec() + rhs.toMSec()};
  }
  constexpr Duration operator-(const Duration& rhs) const noexcept {
    return Duration{toMSec() - rhs.toMSec()};
  }
  constexpr Duration operator*(uint64_t rhs) const noexcept { return Duration{toMSec() * rhs}; }
  /// Integer quotient of both durations.
  constexpr uint64_t operator/(const Duration& rhs) const noexcept {
    return toMSec() / rhs.toMSec();
  }
  constexpr Duration operator/(uint64_t rhs) const noexcept { return Duration{toMSec() / rhs}; }
  /// Remainder of the integer division by rhs.
  constexpr Duration operator%(const Duration& rhs) const noexcept {
    return Duration{toMSec() % rhs.toMSec()};
  }
  constexpr Duration operator%(uint64_t rhs) const noexcept { return Duration{toMSec() % rhs}; }

  Duration& operator+=(const Duration& rhs) noexcept { return *this = *this + rhs; }
  Duration& operator-=(const Duration& rhs) noexcept { return *this = *this - rhs; }
  Duration& operator*=(uint64_t rhs) noexcept { return *this = *this * rhs; }
  Duration& operator/=(uint64_t rhs) noexcept { return *this = *this / rhs; }
  Duration& operator%=(const Duration& rhs) noexcept { return *this = *this % rhs; }
  Duration& operator%=(uint64_t rhs) noexcept { return *this = *this % rhs; }

  constexpr bool operator==(const Duration& rhs) const noexcept { return toMSec() == rhs.toMSec(); }
  constexpr bool operator!=(const Duration& rhs) const noexcept { return toMSec() != rhs.toMSec(); }
  constexpr bool operator<(const Duration& rhs) const noexcept { return toMSec() < rhs.toMSec(); }
  constexpr bool operator<=(const Duration& rhs) const noexcept { return toMSec() <= rhs.toMSec(); }
  constexpr bool operator>(const Duration& rhs) const noexcept { return toMSec() > rhs.toMSec(); }
  constexpr bool operator>=(const Duration& rhs) const noexcept { return toMSec() >= rhs.toMSec(); }

 private:
  Milliseconds duration_{0};
};

constexpr Duration operator*(uint64_t lhs, const Duration& rhs) noexcept { return rhs * lhs; }

}  // namespace franka
