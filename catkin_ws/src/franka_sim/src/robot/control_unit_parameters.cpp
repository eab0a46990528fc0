// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/finite.h>
#include <franka_core/limits.h>
#include <franka_core/numbers.h>
#include <franka_core/transform.h>
#include <franka_sim/robot/control_unit_parameters.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

#include "robot/transforms.h"

namespace franka_sim {

namespace {

using franka_core::kMaxPayloadDistance;
using franka_core::kMaxPayloadInertia;
using franka_core::kMaxPayloadMass;

template <std::size_t N>
bool allFiniteNotNegative(const std::array<double, N>& values) noexcept {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return std::isfinite(v) && v >= 0.0; });
}

// Sylvester's criterion for semidefinite matrices: no principal minor is negative. Relative
// tolerances, so that matrices printed with six digits pass.
bool isInertia(const std::array<double, 9>& inertia) noexcept {
  const Eigen::Map<const Eigen::Matrix3d> I(inertia.data());
  const double scale = I.cwiseAbs().maxCoeff();
  const double tolerance = 1e-6 * scale;
  if ((I - I.transpose()).cwiseAbs().maxCoeff() > tolerance ||
      I.diagonal().minCoeff() < -tolerance) {
    return false;
  }
  for (int i = 0; i < 3; i++) {
    const int j = (i + 1) % 3;
    if (I(i, i) * I(j, j) - I(i, j) * I(j, i) < -tolerance * scale) {
      return false;
    }
  }
  return I.determinant() >= -tolerance * scale * scale;
}

constexpr double kMaxGravity = 100.0;  // [m/s^2], as the world's (physics/input_limits.h)

// Not std::hypot of three: it may return 0 for a number that is not finite.
double distance(double x, double y, double z) noexcept { return std::sqrt(x * x + y * y + z * z); }

double distanceOf(const franka_core::Payload& payload) noexcept {
  return distance(payload.com[0], payload.com[1], payload.com[2]);
}

double largestOf(const std::array<double, 9>& inertia) noexcept {
  return Eigen::Map<const Eigen::Matrix3d>(inertia.data()).cwiseAbs().maxCoeff();
}

void require(bool condition, const std::string& name, const std::string& what) {
  if (!condition) {
    throw std::invalid_argument("The control unit cannot start: parameter " + name + " " + what +
                                ".");
  }
}

void requirePayload(const franka_core::Payload& payload, const std::string& suffix) {
  if (!isPayload(payload)) {
    throw std::invalid_argument("The control unit cannot start: parameter m_" + suffix + ", F_x_C" +
                                suffix + " or I_" + suffix + " is not that of a body. " +
                                payloadFault(payload));
  }
}

void requireTransform(const Transform& transform, const std::string& name) {
  require(isFrame(transform), name, "is not a frame on the arm: " + frameFault(transform));
}

}  // namespace

bool isPayload(const franka_core::Payload& payload) noexcept {
  return payload.mass >= 0.0 && payload.mass <= kMaxPayloadMass &&
         distanceOf(payload) <= kMaxPayloadDistance && franka_core::allFinite(payload.inertia) &&
         largestOf(payload.inertia) <= kMaxPayloadInertia && isInertia(payload.inertia);
}

std::string payloadFault(const franka_core::Payload& payload) {
  if (!std::isfinite(payload.mass) || !franka_core::allFinite(payload.com) ||
      !franka_core::allFinite(payload.inertia)) {
    return "Mass [kg], center [m] and inertia [kg m^2] must be finite numbers.";
  }
  if (payload.mass < 0.0 || payload.mass > kMaxPayloadMass) {
    return "The mass is " + franka_core::numberText(payload.mass) +
           " kg; it must lie between 0 and " + franka_core::numberText(kMaxPayloadMass) + " kg.";
  }
  if (distanceOf(payload) > kMaxPayloadDistance) {
    return "The center of mass is " + franka_core::numberText(distanceOf(payload)) +
           " m from the flange; it must be within " + franka_core::numberText(kMaxPayloadDistance) +
           " m. Give it in meters, in the flange's frame.";
  }
  if (largestOf(payload.inertia) > kMaxPayloadInertia) {
    return "The inertia has an entry of " + franka_core::numberText(largestOf(payload.inertia)) +
           " kg m^2; none may be beyond " + franka_core::numberText(kMaxPayloadInertia) +
           " kg m^2.";
  }
  return isInertia(payload.inertia) ? ""
                                    : "The inertia must be a symmetric matrix [kg m^2] without "
                                      "negative principal moments.";
}

bool isFrame(const std::array<double, 16>& transform) noexcept {
  return franka_core::isRigidTransform(transform) &&
         distance(transform[12], transform[13], transform[14]) <= kMaxFrameDistance;
}

std::string frameFault(const std::array<double, 16>& transform) {
  if (!franka_core::isRigidTransform(transform)) {
    return franka_core::transformFault(transform);
  }
  const double away = distance(transform[12], transform[13], transform[14]);
  return away > kMaxFrameDistance
             ? "it is " + franka_core::numberText(away) + " m away and must be within " +
                   franka_core::numberText(kMaxFrameDistance) + " m"
             : "";
}

bool areThresholds(const CollisionThresholds& thresholds) noexcept {
  return allFiniteNotNegative(thresholds.lower_torque) &&
         allFiniteNotNegative(thresholds.upper_torque) &&
         allFiniteNotNegative(thresholds.lower_force) &&
         allFiniteNotNegative(thresholds.upper_force);
}

bool isJointStiffness(const std::array<double, 7>& K) noexcept {
  return std::all_of(K.begin(), K.end(), [](double k) { return k >= 0.0 && k <= 14250.0; });
}

bool isCartesianStiffness(const std::array<double, 6>& K) noexcept {
  return std::all_of(K.begin(), K.begin() + 3, [](double k) { return k >= 10.0 && k <= 3000.0; }) &&
         std::all_of(K.begin() + 3, K.end(), [](double k) { return k >= 1.0 && k <= 300.0; });
}

void checkParameters(const ControlUnitParameters& parameters) {
  const std::string not_negative = "must hold seven finite numbers that are not negative";
  require(allFiniteNotNegative(parameters.max_torque), "max_torque", not_negative);
  require(allFiniteNotNegative(parameters.rotor_inertia), "rotor_inertia", not_negative);
  require(allFiniteNotNegative(parameters.joint_stiffness), "joint_stiffness", not_negative);
  require(isCartesianStiffness(parameters.cartesian_stiffness), "cartesian_stiffness",
          "must hold three numbers from 10 to 3000 N/m and three from 1 to 300 Nm/rad");
  require(parameters.protocol_version >= 3 && parameters.protocol_version <= 10, "protocol_version",
          "is " + std::to_string(parameters.protocol_version) + " but must be 3 to 10");
  require(std::all_of(parameters.gravity.begin(), parameters.gravity.end(),
                      [](double g) { return std::abs(g) <= kMaxGravity; }),
          "gravity_vector", "must hold three numbers of at most 100 m/s^2");
  requireTransform(parameters.F_T_NE, "F_T_NE");
  requireTransform(parameters.NE_T_EE, "NE_T_EE");
  requireTransform(parameters.EE_T_K, "EE_T_K");
  requirePayload(parameters.end_effector, "ee");
  requirePayload(parameters.load, "load");
  const std::string thresholds = "must hold finite numbers that are not negative";
  require(areThresholds(parameters.nominal), "collision_config (nominal thresholds)", thresholds);
  require(areThresholds(parameters.acceleration), "collision_config (acceleration thresholds)",
          thresholds);
}

}  // namespace franka_sim
