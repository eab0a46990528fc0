// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

/// @file
/// The common rule of client and robot for 4x4 column-major matrices as transforms.

namespace franka_core {

/// How far the length of a rotation's row or column may be from 1, and the cosine of the angle
/// between two columns from 0 (protocol 3.5).
constexpr double kTransformTolerance = 1e-5;

/// Whether a matrix passes the client's check of commanded poses: bottom row exactly 0 0 0 1, every
/// row and column of the rotation of length 1 within kTransformTolerance. Translation and right
/// angles are not checked here but by the robot (isRigidTransform).
/// Real-time safe. Thread-safe.
bool isHomogeneousTransformation(const std::array<double, 16>& matrix) noexcept;

/// Whether the robot accepts a matrix as a pose or a frame: a finite homogeneous transformation
/// whose columns are orthogonal within kTransformTolerance, without reflection.
/// Real-time safe. Thread-safe.
bool isRigidTransform(const std::array<double, 16>& matrix) noexcept;

/// Why a matrix is not a rigid transform, as the end of a sentence that names the matrix: "its
/// bottom row is 1e-17 0 0 1 and must be exactly 0 0 0 1"; empty if it is one. Not real-time safe.
/// A translation in the bottom row is reported as a row-major matrix.
std::string transformFault(const std::array<double, 16>& matrix);

/// Likewise, for a tolerance of its own: of the length of columns, and of the product of two.
std::string roughTransformFault(const std::array<double, 16>& matrix, double tolerance);

}  // namespace franka_core
