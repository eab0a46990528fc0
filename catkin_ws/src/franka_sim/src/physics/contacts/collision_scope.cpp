// Copyright (c) 2026 the franka_ros for Debian authors
// SPDX-License-Identifier: Apache-2.0
#include "physics/contacts/collision_scope.h"

#include "physics/contacts/constraint_step.h"

namespace franka_sim::physics {

/// Takes bodies out of the search for collisions.
class CollisionScope::Masks {
 public:
  Masks(const CollisionScope& scope, mjModel* model) noexcept
      : scope_(scope),
        model_(model),
        collision_(model->opt.collision),
        disabled_(model->opt.disableflags) {
    if (scope_.without_robots_ && (scope_.only_robots_move_ || scope_.without_objects_)) {
      model_->opt.disableflags |= mjDSBL_CONTACT;
      return;
    }
    if (scope_.without_objects_) {
      hide(scope_.object_geoms_);
    }
    if (scope_.without_robots_) {
      hide(scope_.robot_geoms_);
      if (scope_.all_pairs_are_of_robots_) {
        model_->opt.collision = mjCOL_DYNAMIC;
      }
    }
  }
  ~Masks() {
    if (scope_.without_objects_) {
      restore(scope_.object_geoms_);
    }
    if (scope_.without_robots_) {
      restore(scope_.robot_geoms_);
    }
    model_->opt.collision = collision_;
    model_->opt.disableflags = disabled_;
  }
  Masks(const Masks&) = delete;
  Masks& operator=(const Masks&) = delete;

 private:
  void hide(const std::vector<int>& geoms) noexcept {
    for (const int geom : geoms) {
      model_->geom_contype[geom] = 0;
      model_->geom_conaffinity[geom] = 0;
    }
  }
  void restore(const std::vector<int>& geoms) noexcept {
    for (const int geom : geoms) {
      model_->geom_contype[geom] = scope_.contypes_[geom];
      model_->geom_conaffinity[geom] = scope_.conaffinities_[geom];
    }
  }

  const CollisionScope& scope_;
  mjModel* model_;
  int collision_, disabled_;
};

void CollisionScope::fit(const mjModel& model, const Ownership& owners) {
  leaveOut(false, false);
  robot_geoms_.clear();
  object_geoms_.clear();
  contypes_.assign(model.geom_contype, model.geom_contype + model.ngeom);
  conaffinities_.assign(model.geom_conaffinity, model.geom_conaffinity + model.ngeom);
  for (int geom = 0; geom < model.ngeom; ++geom) {
    if (owners.robot_of_geom[geom] >= 0) {
      robot_geoms_.push_back(geom);
    } else if (owners.isOfObject(model, geom)) {
      object_geoms_.push_back(geom);
    }
  }
  all_pairs_are_of_robots_ = true;
  for (int pair = 0; pair < model.npair; ++pair) {
    all_pairs_are_of_robots_ = all_pairs_are_of_robots_ && owners.isPairOfRobot(model, pair);
  }
  only_robots_move_ = owners.object_dofs.empty() && model.nmocap == 0;
}

void CollisionScope::firstHalf(mjModel* model, mjData* data) {
  if (without_robots_ || without_objects_) {
    const Masks masks(*this, model);
    physics::firstHalf(model, data);
  } else {
    physics::firstHalf(model, data);
  }
}

}  // namespace franka_sim::physics
