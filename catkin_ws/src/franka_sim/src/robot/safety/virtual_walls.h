// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/fci/commands.h>

#include <array>
#include <cstddef>
#include <cstdint>

namespace franka_sim {

/// The cuboids that the end effector must not enter, as GetCartesianLimit reports them
/// (protocol 3.2). Called by one thread. Real-time safe.
class VirtualWalls {
 public:
  static constexpr std::size_t kCount = 8;  ///< numbers 0 to 7 (chosen here: none published)

  /// @returns whether the number exists and the wall is valid: edges finite and not negative, a
  /// rigid frame.
  bool set(std::int32_t id, const franka_core::fci::CartesianLimit& wall) noexcept;
  /// nullptr if there is no such number.
  const franka_core::fci::CartesianLimit* get(std::int32_t id) const noexcept;

  /// Call when a motion begins: an end effector that is inside a wall may move out.
  /// @param O_T_EE 4x4 column-major
  void begin(const std::array<double, 16>& O_T_EE) noexcept;
  /// Whether the origin of EE is inside an active wall, deeper than allowed.
  bool violated(const std::array<double, 16>& O_T_EE) noexcept;

 private:
  static double depth(const franka_core::fci::CartesianLimit& wall,
                      const std::array<double, 16>& O_T_EE) noexcept;

  std::array<franka_core::fci::CartesianLimit, kCount> walls_{};
  std::array<double, kCount> allowed_{};  // depth [m]
};

}  // namespace franka_sim
