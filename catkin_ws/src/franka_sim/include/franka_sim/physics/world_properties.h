// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_sim/physics/world.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <string>

namespace franka_sim {

/// Mass and inertia of a body with all that is fixed to it.
struct BodyInertia {
  double mass{0};                  ///< [kg]
  std::array<double, 3> center{};  ///< of mass, in the body's frame [m]
  /// xx, xy, xz, yy, yz, zz about the center of mass, along the body's axes [kg m^2]
  std::array<double, 6> inertia{};
};

/// @throws std::runtime_error with a sentence for an unknown body, and for one that is fixed to
/// another and belongs to that one's inertia. Not real-time safe.
BodyInertia bodyInertia(World& world, const std::string& body);

/// Ends all pushes of a body (World::push). @throws std::runtime_error for an unknown one.
/// Not real-time safe.
void endPushes(World& world, const std::string& body);

}  // namespace franka_sim

/// @file
/// Limits of numbers in a world for a robot arm (chosen here, far above what an arm of 1 m that
/// lifts 3 kg meets). A number beyond them is a typing error or in another unit, and would make the
/// physics diverge.

namespace franka_sim::sizes {

constexpr double kMaxPosition = 1e3;  ///< from the world's origin [m]; of a joint [m] or [rad]
constexpr double kMaxVelocity = 1e3;  ///< [m/s] or [rad/s]
constexpr double kMaxForce = 1e4;     ///< [N] or [Nm]
constexpr std::uint64_t kMaxPushTicks = 1000000;  ///< duration of a push [ticks]
/// Duration of a push that lasts until it is ended (World::reset, endPushes) [ticks].
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

namespace franka_sim {

/// A light of the world file or of an object, as it is drawn. Lights of SDF links are called
/// model::link::light.
struct WorldLight {
  bool on{true};                                 ///< drawn; false for one that was removed
  bool shadows{true};                            ///< whether it casts them
  std::array<double, 3> diffuse{}, specular{};   ///< red, green, blue: 0 to 1
  std::array<double, 3> attenuation{{1, 0, 0}};  ///< constant, linear [1/m], quadratic [1/m^2]
  std::array<double, 3> position{};              ///< in the world, or in the light's link [m]
  std::array<double, 3> direction{{0, 0, -1}};   ///< likewise, of any length but 0
};

/// @name Lights by their names. Not real-time safe.
/// @throws std::runtime_error with a sentence for an unknown or removed one
/// @{
WorldLight light(World& world, const std::string& name);
/// Lasts until its object is removed; a reset does not change it. @throws std::runtime_error also
/// for negative colors or attenuations and positions beyond sizes::kMaxPosition
void setLight(World& world, const std::string& name, const WorldLight& light);
/// @}

}  // namespace franka_sim
