// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/limits.h>
#include <franka_sim/robot/plant.h>

#include <cmath>
#include <vector>

namespace franka_sim::test {

enum class Derivative { kVelocity, kAcceleration, kJerk };

/// The jerk of each tick of a motion from rest to rest along one coordinate. Integrated by backward
/// Euler it reaches a share of one limit and stays well below the others. Acceleration and
/// deceleration are symmetric: half of the path is reached in half of the time.
using Profile = std::vector<double>;

namespace profile_detail {

inline void append(Profile& profile, int ticks, double jerk) {
  profile.insert(profile.end(), static_cast<std::size_t>(ticks), jerk);
}

// Acceleration ramps, then the same downwards.
inline Profile trapezoids(int ramp, int hold, int cruise, double acceleration) {
  Profile profile;
  const double jerk = acceleration / (ramp * kTick);
  for (const double sign : {1.0, -1.0}) {
    append(profile, ramp, sign * jerk);
    append(profile, hold, 0.0);
    append(profile, ramp, -sign * jerk);
    append(profile, sign > 0.0 ? cruise : 0, 0.0);
  }
  return profile;
}

// Alternates at full jerk, so that acceleration and velocity stay small.
inline Profile shaking(double jerk) {
  Profile profile;
  for (const double sign : {1.0, -1.0}) {
    for (int i = 0; i < 10; i++) {
      append(profile, 1, sign * jerk);
      append(profile, 1, -sign * jerk);
    }
  }
  return profile;
}

}  // namespace profile_detail

/// @param share of the limit to reach
/// @param effort share of the acceleration limit used to reach a velocity
inline Profile reach(Derivative what, const franka_core::DerivativeLimits& limits, double share,
                     double effort = 0.8) {
  constexpr int kRamp = 10;  // ticks: a fifth of the jerk limit
  constexpr int kHold = 10;
  if (what == Derivative::kJerk) {
    return profile_detail::shaking(share * limits.jerk);
  }
  if (what == Derivative::kAcceleration) {
    return profile_detail::trapezoids(kRamp, kHold, 0, share * limits.acceleration);
  }
  // Ticks at full acceleration; two ramps count as one.
  const int full =
      static_cast<int>(std::ceil(limits.velocity / (effort * limits.acceleration * kTick)));
  const int ramp = std::min(4 * kRamp, full / 2);
  return profile_detail::trapezoids(ramp, full - ramp, kHold,
                                    share * limits.velocity / (full * kTick));
}

/// A cruise that ends abruptly, to approach a limit that shrinks with the position.
inline Profile cruise(double velocity) {
  return profile_detail::trapezoids(2, 8, 60, velocity / (10 * kTick));
}
constexpr std::size_t kCruiseEnd = 72;  ///< ticks until that profile slows down

/// From the start to the end.
inline double lengthOf(const Profile& profile) {
  double distance = 0.0, velocity = 0.0, acceleration = 0.0;
  for (const double jerk : profile) {
    acceleration += jerk * kTick;
    velocity += acceleration * kTick;
    distance += velocity * kTick;
  }
  return distance;
}

}  // namespace franka_sim::test
