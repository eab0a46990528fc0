// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/safety/link_pair.h>

#include <array>
#include <cstddef>

#include "robot/safety/capsules.h"

namespace franka_sim {

/// The shortest distance between two line segments [m].
double segmentDistance(const std::array<double, 3>& a0, const std::array<double, 3>& a1,
                       const std::array<double, 3>& b0, const std::array<double, 3>& b1) noexcept;

/// Whether the arm comes too close to itself (decision 17). It checks pairs of links at least two
/// apart, except 1 and 3, whose volumes always overlap. Called by one thread. Real-time safe.
class SelfCollision {
 public:
  explicit SelfCollision(bool has_hand) noexcept : has_hand_(has_hand) {}

  /// The closest pair at q [rad].
  LinkPair closest(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;

  /// Call when a motion begins: pairs that already overlap may separate, but not approach.
  void begin(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;
  /// @returns whether a pair overlaps, and more than at begin(); `overlappingPair` then names it.
  bool violated(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;
  const LinkPair& overlappingPair() const noexcept { return overlapping_pair_; }

 private:
  static constexpr std::size_t kPairs = kCapsuleCount * (kCapsuleCount - 1) / 2;

  void fitReaches(const franka_core::ArmModel& model) noexcept;
  void measure(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;
  /// Keeps from which pose on, and for which way, no pair can overlap.
  void keepFreeWay(const std::array<double, 7>& q) noexcept;
  bool isWithinFreeWay(const std::array<double, 7>& q) const noexcept;

  bool has_hand_;
  /// The way of any point of a volume when a joint turns by 1 rad, at most [m].
  std::array<double, 7> reaches_{};
  std::array<double, 7> free_q_{};
  double free_way_{0.0};  ///< [m]
  std::array<double, kPairs> distance_{}, allowed_{};
  LinkPair overlapping_pair_;
};

}  // namespace franka_sim
