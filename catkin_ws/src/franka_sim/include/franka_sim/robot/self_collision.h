// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>

#include <array>
#include <cstddef>

namespace franka_sim {

/// A cylinder with a half sphere on either end, fixed to a link.
struct Capsule {
  int link;                        ///< 0 to 7; kHandLink for the hand
  std::array<double, 3> from, to;  ///< centres of the half spheres, in the link's frame [m]
  double radius;                   ///< [m]
};

constexpr int kHandLink = 8;  ///< its frame: the flange turned by -45 degrees about z
constexpr std::size_t kCapsuleCount = 12;

/// The coarse volumes of arm and hand: those of the links `_sc` of the robot's description, without
/// safety distance. A test compares both.
extern const std::array<Capsule, kCapsuleCount> kCapsules;

/// The shortest distance between two line segments [m].
double segmentDistance(const std::array<double, 3>& a0, const std::array<double, 3>& a1,
                       const std::array<double, 3>& b0, const std::array<double, 3>& b1) noexcept;

/// Whether the arm comes too close to itself (decision 17). It checks pairs of links at least two
/// apart, except 1 and 3, whose volumes always overlap. Real-time safe; one thread.
class SelfCollision {
 public:
  struct Pair {
    int first{0}, second{0};  ///< links
    double distance{0.0};     ///< between their surfaces, negative inside each other [m]
  };

  explicit SelfCollision(bool has_hand) noexcept : has_hand_(has_hand) {}

  /// The closest pair at q [rad].
  Pair closest(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;

  /// Call when a motion begins: pairs that already overlap may separate, but not approach.
  void begin(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;
  /// @returns whether a pair overlaps, and more than at begin(); `culprit` then names it.
  bool violated(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;
  const Pair& culprit() const noexcept { return culprit_; }

 private:
  static constexpr std::size_t kPairs = kCapsuleCount * (kCapsuleCount - 1) / 2;

  void measure(const franka_core::ArmModel& model, const std::array<double, 7>& q) noexcept;

  bool has_hand_;
  std::array<double, kPairs> distance_{}, allowed_{};
  Pair culprit_;
};

}  // namespace franka_sim
