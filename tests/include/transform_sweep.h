// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <vector>

/// @file
/// Matrices with rounding errors, for every entrance of a transform (faults 22). For Python:
/// tests/support/transform_sweep.py.

namespace franka_test {

/// A matrix with a rounding error in one entry, and whether every input accepts it.
struct PerturbedMatrix {
  std::array<double, 16> matrix;
  std::size_t entry;
  double error;
  bool accepted;
};

inline std::ostream& operator<<(std::ostream& out, const PerturbedMatrix& perturbed) {
  return out << perturbed.error << " on entry " << perturbed.entry;
}

/// Errors of 1e-17 to 1e-6, of either sign, on each entry. The bottom row must be exact unless
/// rounding hides the error; all other entries have a tolerance.
inline std::vector<PerturbedMatrix> perturbations(const std::array<double, 16>& matrix) {
  std::vector<PerturbedMatrix> sweep;
  for (std::size_t entry = 0; entry < 16; entry++) {
    for (int exponent = -17; exponent <= -6; exponent++) {
      const double error = (exponent % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent);
      PerturbedMatrix perturbed{matrix, entry, error, true};
      perturbed.matrix[entry] += error;
      perturbed.accepted = entry % 4 != 3 || perturbed.matrix[entry] == matrix[entry];
      sweep.push_back(perturbed);
    }
  }
  return sweep;
}

}  // namespace franka_test
