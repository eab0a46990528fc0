// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_sim_mujoco/robot/parameter_checks.h>
#include <franka_sim_mujoco/robot/transforms.h>

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace franka_sim_mujoco {

namespace {

template <std::size_t N>
bool allFinite(const std::array<double, N>& values) noexcept {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

template <std::size_t N>
bool allFiniteNotNegative(const std::array<double, N>& values) noexcept {
  return std::all_of(values.begin(), values.end(),
                     [](double v) { return std::isfinite(v) && v >= 0.0; });
}

// Sylvester for semidefinite matrices: no principal minor is negative. The tolerances are relative,
// so that matrices printed with six digits pass.
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

void require(bool condition, const std::string& name, const std::string& what) {
  if (!condition) {
    throw std::invalid_argument("The control unit cannot start: parameter " + name + " " + what +
                                ".");
  }
}

void requirePayload(const franka_core::Payload& payload, const std::string& suffix) {
  require(isPayload(payload), "m_" + suffix + ", F_x_C" + suffix + " or I_" + suffix,
          "is not that of a body (numbers must be finite, the mass not negative, the inertia "
          "symmetric and without negative principal moments)");
}

void requireTransform(const Transform& transform, const std::string& name) {
  require(isTransform(transform), name,
          "is not a rigid transform (4x4 column-major: an orthonormal rotation, a translation and "
          "the bottom row 0 0 0 1)");
}

}  // namespace

bool isPayload(const franka_core::Payload& payload) noexcept {
  return std::isfinite(payload.mass) && payload.mass >= 0.0 && allFinite(payload.com) &&
         allFinite(payload.inertia) && isInertia(payload.inertia);
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
  require(allFiniteNotNegative(parameters.coulomb_friction), "coulomb_friction", not_negative);
  require(allFiniteNotNegative(parameters.viscous_friction), "viscous_friction", not_negative);
  require(allFiniteNotNegative(parameters.joint_stiffness), "joint_stiffness", not_negative);
  require(isCartesianStiffness(parameters.cartesian_stiffness), "cartesian_stiffness",
          "must hold three numbers from 10 to 3000 N/m and three from 1 to 300 Nm/rad");
  require(parameters.protocol_version >= 3 && parameters.protocol_version <= 10, "protocol_version",
          "is " + std::to_string(parameters.protocol_version) + " but must be 3 to 10");
  require(parameters.substeps >= 1, "substeps",
          "is " + std::to_string(parameters.substeps) + " but must be 1 or more");
  require(allFinite(parameters.gravity), "gravity_vector", "must hold three finite numbers");
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

}  // namespace franka_sim_mujoco
