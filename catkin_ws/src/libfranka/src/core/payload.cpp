// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "spatial.h"

namespace franka_core {

namespace {

// A part's inertia about the common center of mass, three by three column-major.
void addAbout(const Payload& part, const std::array<double, 3>& com,
              std::array<double, 9>& inertia) noexcept {
  const spatial::Symmetric shift = spatial::pointInertia(
      part.mass, spatial::toVector(part.com.data()) - spatial::toVector(com.data()));
  const std::array<double, 9> moved{shift.xx, shift.xy, shift.xz, shift.xy, shift.yy,
                                    shift.yz, shift.xz, shift.yz, shift.zz};
  for (std::size_t i = 0; i < 9; i++) {
    inertia[i] += part.inertia[i] + moved[i];
  }
}

}  // namespace

Payload combine(const Payload& end_effector, const Payload& load) noexcept {
  Payload total;
  total.mass = end_effector.mass + load.mass;
  // This form is also true for NaN.
  if (!(total.mass > 0.0)) {
    return Payload{};
  }
  // A single part is returned unchanged, without rounding.
  if (end_effector.mass == 0.0 || load.mass == 0.0) {
    return load.mass == 0.0 ? end_effector : load;
  }
  for (std::size_t i = 0; i < 3; i++) {
    total.com[i] = (end_effector.mass * end_effector.com[i] + load.mass * load.com[i]) / total.mass;
  }
  for (const Payload* part : {&end_effector, &load}) {
    addAbout(*part, total.com, total.inertia);
  }
  return total;
}

}  // namespace franka_core
