// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <Eigen/Dense>
#include <array>
#include <random>

/// Poses (4x4, column-major) with random rotations that are not quite orthogonal: each of the nine
/// entries deviates by up to a bound. Repeatable.
class OffRotations {
 public:
  explicit OffRotations(double bound) : off_(-bound, bound) {}

  std::array<double, 16> pose() {
    std::uniform_real_distribution<double> number(-1.0, 1.0);
    const Eigen::Quaterniond turn(number(generator_), number(generator_), number(generator_),
                                  number(generator_));
    return off(turn.normalized().toRotationMatrix());
  }
  std::array<double, 16> off(const Eigen::Matrix3d& rotation) {
    std::array<double, 16> pose{};
    Eigen::Map<Eigen::Matrix4d> matrix(pose.data());
    matrix.setIdentity();
    matrix.topLeftCorner<3, 3>() =
        rotation.unaryExpr([this](double value) { return value + off_(generator_); });
    return pose;
  }

 private:
  std::mt19937 generator_{18};
  std::uniform_real_distribution<double> off_;
};

/// The nearest rotation by another formula than the tested code: R (R^T R)^(-1/2).
inline Eigen::Matrix3d polarFactor(const std::array<double, 16>& pose) {
  const Eigen::Matrix3d R = Eigen::Matrix4d::Map(pose.data()).topLeftCorner<3, 3>();
  return R *
         Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(R.transpose() * R).operatorInverseSqrt();
}

inline double distance(const Eigen::Matrix3d& rotation, const std::array<double, 16>& pose) {
  return (rotation - Eigen::Matrix4d::Map(pose.data()).topLeftCorner<3, 3>()).cwiseAbs().maxCoeff();
}
