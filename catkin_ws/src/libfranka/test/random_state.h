// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <franka_core/arm_model.h>
#include <franka_core/limits.h>
#include <gtest/gtest.h>
#include <source_file.h>

#include <Eigen/Geometry>
#include <array>
#include <random>
#include <string>

namespace franka_test {

constexpr int kStates = 1000;

inline std::string readData(const std::string& name) {
  return readSource("libfranka/test/data/" + name);
}

/// A state with all inputs of the arm's model.
struct State {
  std::array<double, 7> q, dq, ddq;
  std::array<double, 16> F_T_EE, EE_T_K;
  franka_core::Payload payload;
  std::array<double, 3> gravity_earth;
};

/// Repeatable random states.
class StateSource {
 public:
  explicit StateSource(const franka_core::ArmLimits& limits) : limits_(limits) {}

  State next() {
    State state;
    for (std::size_t i = 0; i < 7; i++) {
      state.q[i] = uniform(limits_.q_min[i], limits_.q_max[i]);
      state.dq[i] = uniform(-limits_.dq[i], limits_.dq[i]);
      state.ddq[i] = uniform(-limits_.ddq[i], limits_.ddq[i]);
    }
    state.F_T_EE = transform();
    state.EE_T_K = transform();
    state.payload.mass = uniform(0.0, 3.0);
    state.payload.com = {uniform(-0.1, 0.1), uniform(-0.1, 0.1), uniform(-0.1, 0.1)};
    const Eigen::Matrix3d r = rotation();
    const Eigen::Vector3d moments(uniform(0.001, 0.02), uniform(0.001, 0.02), uniform(0.001, 0.02));
    Eigen::Map<Eigen::Matrix3d>(state.payload.inertia.data()) =
        r * moments.asDiagonal() * r.transpose();
    Eigen::Map<Eigen::Vector3d>(state.gravity_earth.data()) =
        rotation() * Eigen::Vector3d(0.0, 0.0, -9.81);
    return state;
  }

  double uniform(double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(engine_);
  }

  Eigen::Matrix3d rotation() {
    std::normal_distribution<double> normal;
    return Eigen::Quaterniond(normal(engine_), normal(engine_), normal(engine_), normal(engine_))
        .normalized()
        .toRotationMatrix();
  }

  std::array<double, 16> transform() {
    Eigen::Matrix4d t = Eigen::Matrix4d::Identity();
    t.topLeftCorner<3, 3>() = rotation();
    t.topRightCorner<3, 1>() << uniform(-0.2, 0.2), uniform(-0.2, 0.2), uniform(-0.2, 0.2);
    std::array<double, 16> result;
    Eigen::Map<Eigen::Matrix4d>(result.data()) = t;
    return result;
  }

 private:
  franka_core::ArmLimits limits_;
  std::mt19937_64 engine_{20261121};
};

/// An arm under test.
struct Arm {
  const char* name;
  const char* file;
  const char* arm_id;
  const franka_core::ArmLimits* limits;
};

constexpr Arm kPanda{"panda", "panda_hand.urdf", "panda", &franka_core::kFerLimits};
constexpr Arm kFr3{"fr3", "fr3_hand.urdf", "fr3", &franka_core::kFr3Limits};

inline std::string armName(const ::testing::TestParamInfo<Arm>& info) { return info.param.name; }

using Matrix7 = Eigen::Matrix<double, 7, 7>;
using Vector7 = Eigen::Matrix<double, 7, 1>;
using Jacobian = Eigen::Matrix<double, 6, 7>;

inline Eigen::Map<const Vector7> vector(const std::array<double, 7>& v) {
  return Eigen::Map<const Vector7>(v.data());
}
inline Eigen::Map<const Matrix7> matrix(const std::array<double, 49>& m) {
  return Eigen::Map<const Matrix7>(m.data());
}
inline Eigen::Map<const Jacobian> jacobian(const std::array<double, 42>& m) {
  return Eigen::Map<const Jacobian>(m.data());
}
inline Eigen::Map<const Eigen::Matrix4d> pose(const std::array<double, 16>& m) {
  return Eigen::Map<const Eigen::Matrix4d>(m.data());
}

}  // namespace franka_test
