// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <array>
#include <cstddef>

namespace franka_sim {

/// The entry farthest beyond its threshold by ratio. Real-time safe.
template <std::size_t N>
Collision worstOf(const std::array<double, N>& values, const std::array<double, N>& upper) noexcept;

/// A cylinder with a half sphere on either end, fixed to a link.
struct Capsule {
  int link;                        ///< 0 to 7; kHandLink for the hand
  std::array<double, 3> from, to;  ///< centers of the half spheres, in the link's frame [m]
  double radius;                   ///< [m]
};

constexpr std::size_t kCapsuleCount = 12;

/// The coarse volumes of arm and hand: those of the links `_sc` of the robot's description, without
/// safety distance. A test compares both.
extern const std::array<Capsule, kCapsuleCount> kCapsules;

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
