// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/transform.h>
#include <franka_core/typed_transform.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <array>
#include <cmath>
#include <limits>
#include <string>

#include "random_state.h"

namespace franka_core {
namespace {

using Array = std::array<double, 16>;

constexpr int kCases = 2000;

Array toArray(const Eigen::Matrix4d& matrix) {
  Array array{};
  Eigen::Matrix4d::Map(array.data()) = matrix;
  return array;
}

Eigen::Matrix4d rounded(const Eigen::Matrix4d& pose, int digits) {
  const double unit = std::pow(10.0, -digits);
  return pose.unaryExpr([unit](double entry) { return std::round(entry / unit) * unit; });
}

double orthonormalError(const Array& matrix) {
  const Eigen::Matrix3d rotation = Eigen::Matrix4d::Map(matrix.data()).topLeftCorner<3, 3>();
  return (rotation.transpose() * rotation - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
}

TEST(TypedTransform, MakesRoundedRotationsOrthonormal) {
  franka_test::StateSource random(kFerLimits);
  for (int i = 0; i < kCases; i++) {
    const auto pose = random.transform();
    for (const int digits : {4, 5, 6}) {
      const Eigen::Matrix4d typed = rounded(franka_test::pose(pose), digits);
      const TypedTransform result = readTypedTransform(toArray(typed));
      ASSERT_EQ("", result.fault) << typed;
      ASSERT_LE(orthonormalError(result.matrix), 1e-12) << typed;
      ASSERT_TRUE(isRigidTransform(result.matrix)) << typed;
      const Eigen::Matrix4d change = Eigen::Matrix4d::Map(result.matrix.data()) - typed;
      // The nearest rotation is not farther than the exact one, whose entries were rounded.
      ASSERT_LE(change.norm(), 3.0 * 0.5 * std::pow(10.0, -digits) * (1.0 + 1e-3)) << typed;
      ASSERT_EQ(0.0, change.rightCols<1>().norm()) << "the translation is unchanged";
      ASSERT_EQ(change.cwiseAbs().maxCoeff() > kSilentCorrection, !result.warning.empty()) << typed;
    }
  }
}

TEST(TypedTransform, KeepsExactOnesAsTheyAre) {
  franka_test::StateSource random(kFerLimits);
  for (int i = 0; i < kCases; i++) {
    const Array exact = random.transform();
    const TypedTransform result = readTypedTransform(exact);
    ASSERT_EQ(exact, result.matrix);
    ASSERT_EQ("", result.fault + result.warning);
  }
}

TEST(TypedTransform, NamesRowMajorMatrices) {
  franka_test::StateSource random(kFerLimits);
  for (int i = 0; i < kCases; i++) {
    const Eigen::Matrix4d typed = rounded(franka_test::pose(random.transform()), 4).transpose();
    ASSERT_NE(std::string::npos, readTypedTransform(toArray(typed)).fault.find("row-major"))
        << typed;
  }
}

TEST(TypedTransform, RefusesRandomMatrices) {
  franka_test::StateSource random(kFerLimits);
  for (int i = 0; i < kCases; i++) {
    Array matrix = kIdentityTransform;
    for (const std::size_t entry : {0, 1, 2, 4, 5, 6, 8, 9, 10, 12, 13, 14}) {
      matrix[entry] = random.uniform(-0.5, 0.5);
    }
    ASSERT_NE("", readTypedTransform(matrix).fault);
    for (double& entry : matrix) {
      entry = random.uniform(-0.5, 0.5);
    }
    ASSERT_NE("", readTypedTransform(matrix).fault);
  }
}

TEST(TypedTransform, TakesAnglesTypedWithThreeDigits) {
  for (int degrees = -180; degrees <= 180; degrees += 15) {
    const double angle = degrees * M_PI / 180.0;
    for (int axis = 0; axis < 3; axis++) {
      Eigen::Matrix4d exact = Eigen::Matrix4d::Identity();
      exact.topLeftCorner<3, 3>() =
          Eigen::AngleAxisd(angle, Eigen::Vector3d::Unit(axis)).toRotationMatrix();
      const TypedTransform result = readTypedTransform(toArray(rounded(exact, 3)));
      ASSERT_EQ("", result.fault) << degrees << " deg about " << axis;
      const Eigen::Matrix4d change = Eigen::Matrix4d::Map(result.matrix.data()) - exact;
      ASSERT_LE(change.cwiseAbs().maxCoeff(), 5e-4) << degrees << " deg about " << axis;
      ASSERT_LE(orthonormalError(result.matrix), 1e-14) << degrees << " deg about " << axis;
    }
  }
}

TEST(TypedTransform, TakesWhatIsWithinTheToleranceOnly) {
  for (const double sign : {-1.0, 1.0}) {
    for (const std::size_t entry : {0, 5, 10, 4, 8, 9}) {
      Array matrix = kIdentityTransform;
      matrix[entry] += sign * 0.99 * kTypedTransformTolerance;
      EXPECT_EQ("", readTypedTransform(matrix).fault) << entry;
      matrix[entry] = kIdentityTransform[entry] + sign * 1.01 * kTypedTransformTolerance;
      EXPECT_NE("", readTypedTransform(matrix).fault) << entry;
    }
  }
}

TEST(TypedTransform, NamesTheFault) {
  const auto with = [](std::size_t entry, double value) {
    Array matrix = kIdentityTransform;
    matrix[entry] = value;
    return readTypedTransform(matrix).fault;
  };
  EXPECT_NE(std::string::npos, with(5, 1.01).find("column 2 of its rotation has the length 1.01"));
  EXPECT_NE(std::string::npos, with(4, 1.01e-3).find("columns 1 and 2"));
  EXPECT_NE(std::string::npos, with(10, -1.0).find("determinant"));
  EXPECT_NE(std::string::npos, with(3, 1e-17).find("bottom row"));
  EXPECT_NE(std::string::npos, with(15, 2.0).find("bottom row"));
  EXPECT_NE(std::string::npos,
            with(12, std::numeric_limits<double>::quiet_NaN()).find("finite number"));
  EXPECT_NE(std::string::npos, with(11, 0.1).find("row-major"));
}

}  // namespace
}  // namespace franka_core
