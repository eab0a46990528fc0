// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <string>

/// @file
/// The common rule of all inputs for 4x4 column-major matrices that people type: a tool's frames in
/// parameters, services, the client and Python (protocol 3.5).

namespace franka_core {

/// How far a typed rotation may be from an exact one: the length of a column from 1, and the
/// product of two columns from 0. Chosen here: rounding to three decimals changes a length by up to
/// 8.7e-4; 0.707 for cos(45 deg) changes it by 1.5e-4.
constexpr double kTypedTransformTolerance = 1e-3;

/// A correction of an entry beyond this is reported. Chosen here: above the rounding of float32
/// states (6e-8), far below an angle that matters (1e-6 rad are 1 um at a distance of 1 m).
constexpr double kSilentCorrection = 1e-6;

/// A typed matrix as a transform, or why it is not one.
struct TypedTransform {
  std::array<double, 16> matrix;  ///< with the rotation nearest to the typed one
  std::string fault;    ///< the end of a sentence that names the matrix; empty if it is a transform
  std::string warning;  ///< likewise, of a correction beyond kSilentCorrection; empty without one
};

/// Makes a matrix a transform: its rotation R becomes the nearest one, the orthonormal R' that
/// minimizes |R - R'|, if the columns are orthonormal within kTypedTransformTolerance, without
/// reflection. A matrix that is orthonormal within 1e-12 is returned unchanged. Not real-time safe.
/// Thread-safe.
TypedTransform readTypedTransform(const std::array<double, 16>& matrix);

}  // namespace franka_core
