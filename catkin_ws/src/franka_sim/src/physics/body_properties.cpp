// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include <franka_core/numbers.h>
#include <franka_sim/physics/body_properties.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <vector>

#include "physics/world_impl.h"

namespace franka_sim {

BodyInertia bodyInertia(World& world, const std::string& body) {
  const Frame frame = implOf(world).frame(body);
  const mjModel& model = *implOf(world).model;
  if (!frame.pose.isApprox(Eigen::Isometry3d::Identity(), 1e-12)) {
    throw std::runtime_error("Body '" + body + "' is fixed to '" +
                             mj_id2name(&model, mjOBJ_BODY, frame.body) +
                             "', whose inertia contains its own.");
  }
  const double* q = model.body_iquat + 4 * frame.body;
  const Eigen::Matrix3d axes = Eigen::Quaterniond(q[0], q[1], q[2], q[3]).toRotationMatrix();
  const Eigen::Map<const Eigen::Vector3d> principal(model.body_inertia + 3 * frame.body);
  const Eigen::Matrix3d inertia = axes * principal.asDiagonal() * axes.transpose();
  const double* center = model.body_ipos + 3 * frame.body;
  return {
      model.body_mass[frame.body],
      {center[0], center[1], center[2]},
      {inertia(0, 0), inertia(0, 1), inertia(0, 2), inertia(1, 1), inertia(1, 2), inertia(2, 2)}};
}

void endPushes(World& world, const std::string& body) {
  World::Impl& impl = implOf(world);
  impl.frame(body);  // throws for an unknown one
  impl.pushes.erase(std::remove_if(impl.pushes.begin(), impl.pushes.end(),
                                   [&](const Push& push) { return push.body_name == body; }),
                    impl.pushes.end());
  mju_zero(impl.data->xfrc_applied, 6 * impl.model->nbody);  // a tick sets those that remain
  impl.disturb();
}

}  // namespace franka_sim

namespace franka_sim::sizes {

void check(const std::array<double, 3>& values, double largest, const char* unit,
           const std::string& what) {
  for (const double value : values) {
    check(value, largest, unit, what);
  }
}

void check(double value, double largest, const char* unit, const std::string& what) {
  if (!std::isfinite(value)) {
    throw std::runtime_error(what + " is not finite; give numbers in " + unit + ".");
  }
  if (std::abs(value) > largest) {
    throw std::runtime_error(what + " is " + franka_core::numberText(value) + " " + unit +
                             "; at most " + franka_core::numberText(largest) + " " + unit +
                             " are simulated.");
  }
}

}  // namespace franka_sim::sizes
