// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <ostream>
#include <vector>

namespace franka_sim::test {

/// A matrix with numerical dust on one entry, and whether every entrance takes it.
struct DustyMatrix {
  std::array<double, 16> matrix;
  std::size_t entry;
  double dust;
  bool accepted;
};

inline std::ostream& operator<<(std::ostream& out, const DustyMatrix& dusty) {
  return out << dusty.dust << " on entry " << dusty.entry;
}

/// 1e-17 to 1e-6, of either sign, on each entry. The bottom row must be exact, where the dust is
/// not lost in it; all else has room for it.
inline std::vector<DustyMatrix> dustOn(const std::array<double, 16>& matrix) {
  std::vector<DustyMatrix> sweep;
  for (std::size_t entry = 0; entry < 16; entry++) {
    for (int exponent = -17; exponent <= -6; exponent++) {
      const double dust = (exponent % 2 == 0 ? 1.0 : -1.0) * std::pow(10.0, exponent);
      DustyMatrix dusty{matrix, entry, dust, true};
      dusty.matrix[entry] += dust;
      dusty.accepted = entry % 4 != 3 || dusty.matrix[entry] == matrix[entry];
      sweep.push_back(dusty);
    }
  }
  return sweep;
}

}  // namespace franka_sim::test
