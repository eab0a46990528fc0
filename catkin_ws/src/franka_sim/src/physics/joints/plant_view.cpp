// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/joints/plant_view.h"

namespace franka_sim::physics {

void writeHold(const PlantView& view, const JointSlot& slot, bool closed,
               double position) noexcept {
  if (slot.brake < 0) {
    return;
  }
  mjModel& model = *view.model;
  double& constant = model.eq_data[mjNEQDATA * slot.brake];
  mjtByte& active = model.eq_active[slot.brake];
  const double desired = closed ? position - model.qpos0[slot.qpos] : 0.0;
  if (constant == desired && active == static_cast<mjtByte>(closed)) {
    return;
  }
  if (view.preparation_thread != nullptr) {
    view.preparation_thread->finish();
  }
  constant = desired;
  active = static_cast<mjtByte>(closed);
}

}  // namespace franka_sim::physics
