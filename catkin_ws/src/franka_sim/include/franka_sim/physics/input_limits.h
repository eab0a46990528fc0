// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

/// Limits of numbers in a world for a robot arm (chosen here, far above what an arm of 1 m that
/// lifts 3 kg meets). A number beyond them is a typing error or in another unit, and would make the
/// physics diverge.
namespace franka_sim::sizes {

constexpr double kMaxPosition = 1e3;  ///< from the world's origin [m]; of a joint [m] or [rad]
constexpr double kMaxVelocity = 1e3;  ///< [m/s] or [rad/s]
constexpr double kMaxForce = 1e4;     ///< [N] or [Nm]
constexpr std::uint64_t kMaxPushTicks = 1000000;  ///< duration of a push [ticks]
/// Duration of a push that lasts until it is ended (World::reset, endPushes,
/// endJointPushes) [ticks].
constexpr std::uint64_t kEndlessPush = std::numeric_limits<std::uint64_t>::max();
constexpr std::size_t kMaxPushes = 1000;  ///< at a time
constexpr double kMaxGravity = 1e2;       ///< [m/s^2]

/// @param what the start of the sentence, for example "The force"
/// @throws std::runtime_error with a sentence that names the first number which is not finite or
/// beyond `largest`, the limit and the unit.
void check(const std::array<double, 3>& values, double largest, const char* unit,
           const std::string& what);
void check(double value, double largest, const char* unit, const std::string& what);

}  // namespace franka_sim::sizes
