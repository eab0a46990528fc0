// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0

/// @file
/// World: checks for errors.

#include <franka_core/numbers.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "physics/world_impl.h"

namespace franka_sim {
namespace {

using physics::StepFault;

std::string quoted(const mjModel& model, int type, int id) {
  const char* name = mj_id2name(&model, type, id);
  return name != nullptr ? "'" + std::string(name) + "'" : "without a name";
}

int jointOf(const mjModel& model, const StepFault& fault) {
  if (fault.where != StepFault::Where::kPosition) {
    return model.dof_jntid[fault.index];
  }
  int joint = 0;
  while (joint + 1 < model.njnt && model.jnt_qposadr[joint + 1] <= fault.index) {
    ++joint;
  }
  return joint;
}

std::string sentence(const mjModel& model, const StepFault& fault, double time) {
  const int joint = jointOf(model, fault);
  const int type = model.jnt_type[joint];
  const bool single = type == mjJNT_HINGE || type == mjJNT_SLIDE;
  const std::string owner = single ? "joint " + quoted(model, mjOBJ_JOINT, joint)
                                   : "body " + quoted(model, mjOBJ_BODY, model.jnt_bodyid[joint]);
  const char* const quantity = fault.where == StepFault::Where::kPosition   ? "position"
                               : fault.where == StepFault::Where::kVelocity ? "velocity"
                                                                            : "acceleration";
  return std::string("The physics diverged: the ") + quantity + " of " + owner + " reached " +
         franka_core::numberText(fault.value) + " in SI units at " +
         franka_core::fixedText(time, 3) + " s. The world stands still until it is reset.";
}

}  // namespace

const std::string& World::Impl::faultText() {
  if (fault && fault->where == StepFault::Where::kEngine) {
    return fault_text;
  }
  if (fault && fault_text.empty()) {
    fault_text = sentence(*model, *fault, static_cast<double>(ticks) * kTick);
  }
  return fault_text;
}

void World::Impl::requireRuns() {
  if (fault) {
    throw std::runtime_error(faultText());
  }
}

void World::Impl::clearFaults() noexcept {
  fault.reset();
  fault_text.clear();
  warned = {};
}

bool World::stopped() const noexcept { return impl_->fault.has_value(); }

std::string World::fault() const { return impl_->faultText(); }

std::vector<std::string> World::takeWarnings() {
  struct Kind {
    mjtWarning number;
    const char* sentence;
  };
  static constexpr Kind kKinds[] = {
      {mjWARN_INERTIA,
       "A body's inertia is close to singular: the physics is inexact. Give bodies that move "
       "masses [kg] and inertias [kg m^2] of real ones."},
      {mjWARN_CONTACTFULL,
       "There are more contacts than the limit (nconmax), and some have no effect. Raise nconmax "
       "in <size> of the world file."},
      {mjWARN_CNSTRFULL,
       "There are more constraints (contacts, limits, friction) than the limit (njmax), and some "
       "have no effect. Raise njmax in <size> of the world file, or use fewer objects: there is "
       "room for about 1000 boxes."},
      {mjWARN_BADCTRL, "An actuator's command is not finite or too large: all actuators are off."},
  };
  std::vector<std::string> news;
  for (const std::string& sentence : std::exchange(impl_->news, {})) {
    if (!sentence.empty()) {
      news.push_back(sentence);
    }
  }
  for (const Kind& kind : kKinds) {
    bool& warned = impl_->warned[kind.number];
    if (!warned && impl_->data->warning[kind.number].number > 0) {
      warned = true;
      news.emplace_back(kind.sentence);
    }
  }
  return news;
}

}  // namespace franka_sim
