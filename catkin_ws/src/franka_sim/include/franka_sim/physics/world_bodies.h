// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <string>
#include <vector>

/// @file
/// Functions that read and change the bodies of a World, links included, by their names. The thread
/// that uses the world calls them, between ticks. All throw std::runtime_error with a sentence for
/// an unknown name; those that change something also while the world has stopped (World::stopped),
/// and for numbers beyond the limits of input_limits.h. Not real-time safe.

namespace franka_sim {

/// Velocity of a body: linear of its origin [m/s] and angular [rad/s], world axes.
struct Twist {
  std::array<double, 3> linear{}, angular{};  ///< [m/s] and [rad/s]
};

/// Pose and velocity of a body.
struct BodyState {
  Pose pose;    ///< in the world frame
  Twist twist;  ///< along world axes
};

Pose bodyPose(const World& world, const std::string& body);  ///< in the world frame
/// Pose and velocity, along world axes.
BodyState bodyState(const World& world, const std::string& body);
/// The same for many bodies in one call, which is faster.
std::vector<BodyState> bodyStates(const World& world, const std::vector<std::string>& names);
/// Poses for drawing, in the order of WorldShapes::bodies (physics/world_shapes.h).
std::vector<Pose> framePoses(const World& world);
/// @throws std::runtime_error if a body that is not free, or such a pose, cannot be set
void checkBodyPose(const World& world, const std::string& body, const Pose& pose);
/// Free bodies only; velocity becomes 0.
void setBodyPose(World& world, const std::string& body, const Pose& pose);
void setBodyTwist(World& world, const std::string& body, const Twist& twist);  ///< free bodies only
/// Both of the last two; nothing changes when it throws.
void setBodyState(World& world, const std::string& body, const BodyState& state);

/// Mass and inertia of a body with all that is fixed to it.
struct BodyInertia {
  double mass{0};                  ///< [kg]
  std::array<double, 3> center{};  ///< of mass, in the body's frame [m]
  /// xx, xy, xz, yy, yz, zz about the center of mass, along the body's axes [kg m^2]
  std::array<double, 6> inertia{};
  bool gravity{true};  ///< false: gravity does not pull this link
};

/// @throws std::runtime_error with a sentence for an unknown body, and for one that is fixed to
/// another and belongs to that one's inertia
BodyInertia bodyInertia(const World& world, const std::string& body);

}  // namespace franka_sim
